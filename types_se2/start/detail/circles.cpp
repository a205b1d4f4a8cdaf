#include <waymark/types_se2/start/detail/circles.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace waymark {
namespace {

using Place = Eigen::Vector2d;

/// Circles that cross at a smaller angle (its sine) say little across the line of their centres.
constexpr double kCrossing = 0.3;
/// So many pairs propose places.
constexpr std::size_t kPairs = 60;
/// Two places whose misfits differ by less than this factor explain the circles alike.
constexpr double kAlike = 1.5;

/// Where two circles cross, or come closest, and the sine of the angle at which they do.
struct Crossing {
  std::array<Place, 2> places;
  double sine = 0;
};

std::optional<Crossing> crossing(const Circle& a, const Circle& b) {
  const Place apart = b.centre - a.centre;
  const double distance = apart.norm();
  if (!(distance > 1e-6 * (a.radius + b.radius))) return std::nullopt;
  const double along = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
  const double across = std::sqrt(std::max(0.0, (a.radius - along) * (a.radius + along)));
  const Place way = apart / distance;
  const Place side(-way[1], way[0]);
  const Place foot = a.centre + along * way;
  const double sine = across * distance / std::max(a.radius * b.radius, 1e-300);
  return Crossing{{foot + across * side, foot - across * side}, sine};
}

/// Returns the distance from a place within which most circles are: all of three, and a little more than half of
/// many, because two circles always meet (least median of squares, Rousseeuw 1984).
double misfit(std::span<const Circle> circles, const Place& place) {
  std::vector<double> sizes;
  sizes.reserve(circles.size());
  for (const Circle& circle : circles)
    sizes.push_back(std::abs((place - circle.centre).norm() - circle.radius));
  const auto most =
      sizes.begin() + static_cast<std::ptrdiff_t>(std::min((sizes.size() + 1) / 2, sizes.size() - 1));
  std::nth_element(sizes.begin(), most, sizes.end());
  return *most;
}

/// Returns the places where pairs of circles cross; those that cross at a wide angle, if there are any.
std::vector<Place> proposals(std::span<const Circle> circles) {
  std::vector<Place> wide;
  std::vector<Place> narrow;
  const std::size_t n = circles.size();
  for (std::size_t gap = n / 2; gap > 0 && wide.size() < 2 * kPairs; gap = gap / 2) {
    const std::size_t stride = std::max<std::size_t>(1, n / kPairs);
    for (std::size_t i = 0; i + gap < n; i += stride) {
      const auto found = crossing(circles[i], circles[i + gap]);
      if (!found) continue;
      std::vector<Place>& list = found->sine > kCrossing ? wide : narrow;
      list.insert(list.end(), found->places.begin(), found->places.end());
    }
  }
  return wide.empty() ? narrow : wide;
}

/// Takes Gauss-Newton steps towards the circles that agree with a place.
Place refined(std::span<const Circle> circles, Place place) {
  constexpr int kSteps = 5;
  constexpr double kAgrees = 4;  // times the misfit
  for (int step = 0; step < kSteps; ++step) {
    const double limit = kAgrees * misfit(circles, place);
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Place gradient = Place::Zero();
    for (const Circle& circle : circles) {
      const Place way = place - circle.centre;
      const double distance = way.norm();
      const double error = distance - circle.radius;
      if (!(std::abs(error) <= limit) || !(distance > 0)) continue;
      information += way * way.transpose() / (distance * distance);
      gradient += error * way / distance;
    }
    const double determinant = information.determinant();
    if (!(determinant > 1e-6 * information.trace() * information.trace())) return place;
    Eigen::Matrix2d adjugate;
    adjugate << information(1, 1), -information(0, 1), -information(1, 0), information(0, 0);
    place -= adjugate * gradient / determinant;
  }
  return place;
}

}  // namespace

std::optional<Eigen::Vector2d> place_on_circles(std::span<const Circle> circles,
                                                const Eigen::Vector2d& near) {
  const std::vector<Place> places = proposals(circles);
  if (places.empty()) return std::nullopt;
  std::vector<double> misfits;
  for (const Place& place : places) misfits.push_back(misfit(circles, place));
  const double least = *std::min_element(misfits.begin(), misfits.end());
  double extent = 0;
  for (const Circle& circle : circles) extent = std::max(extent, circle.radius);
  const double alike = kAlike * least + 1e-9 * extent;
  std::optional<Place> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (misfits[i] > alike) continue;
    if (!best || (places[i] - near).norm() < (*best - near).norm()) best = places[i];
  }
  const Place fine = refined(circles, *best);
  return misfit(circles, fine) <= misfit(circles, *best) ? fine : *best;
}

}  // namespace waymark

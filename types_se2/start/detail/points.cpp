#include <waymark/types_se2/start/detail/points.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/start/detail/circles.hpp>

namespace waymark {
namespace {

using Places = std::vector<Eigen::Vector2d>;

/// Rays that cross at a smaller angle (its sine) say little about the distance; used only where none cross better.
constexpr double kParallax = 0.2;
/// Rays that cross at a smaller angle say nothing.
constexpr double kParallel = 1e-3;
/// A ray looks for one that crosses it among so many of the following ones.
constexpr std::size_t kReach = 500;

/// A sighting in the axes of the frame.
struct Ray {
  Eigen::Vector2d origin;
  Eigen::Vector2d way;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a[0] * b[1] - a[1] * b[0];
}

Ray in_frame(const double* pose, const Sight& sight) {
  return {Eigen::Vector2d(pose[0], pose[1]) + rotate(pose[2], sight.sensor), rotate(pose[2], sight.way)};
}

/// Returns where two rays of unit ways meet, if it is before both of them.
std::optional<Eigen::Vector2d> crossing(const Ray& a, const Ray& b) {
  const double sine = cross(a.way, b.way);
  if (!(std::abs(sine) > kParallel)) return std::nullopt;
  const Eigen::Vector2d apart = b.origin - a.origin;
  const double along_a = cross(apart, b.way) / sine;
  const double along_b = cross(apart, a.way) / sine;
  if (along_a < 0 || along_b < 0) return std::nullopt;
  return a.origin + along_a * a.way;
}

/// Returns the number of the next ray that crosses well, or of the one among the next that crosses best.
std::size_t partner_of(std::span<const Ray> rays, std::size_t i) {
  std::size_t best = i;
  double widest = 0;
  for (std::size_t j = i + 1; j < std::min(rays.size(), i + kReach) && widest < kParallax; ++j) {
    const double sine = std::abs(cross(rays[i].way, rays[j].way));
    if (sine <= widest) continue;
    widest = sine;
    best = j;
  }
  return best;
}

/// Pairs rays that follow each other, because the poses between them have drifted the least.
Places crossings(std::span<const Ray> rays) {
  Places wide;
  Places narrow;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t j = partner_of(rays, i);
    const auto place = crossing(rays[i], rays[j]);
    if (!place) continue;
    (std::abs(cross(rays[i].way, rays[j].way)) < kParallax ? narrow : wide).push_back(*place);
  }
  return wide.empty() ? narrow : wide;
}

Eigen::Vector2d median(const Places& places) {
  Eigen::Vector2d result;
  std::vector<double> numbers(places.size());
  for (int axis = 0; axis < 2; ++axis) {
    std::transform(places.begin(), places.end(), numbers.begin(),
                   [&](const auto& place) { return place[axis]; });
    result[axis] = upper_median(numbers);
  }
  return result;
}

}  // namespace

std::vector<SeenPoint> seen_points(const Graph& graph, std::vector<Sighting> sightings,
                                   const std::vector<double>& values) {
  const auto value = [&](VertexIndex v) {
    return values.data() + graph.offsets()[static_cast<std::size_t>(v)];
  };
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.to < b.to; });
  std::vector<SeenPoint> points;
  Places places;
  std::vector<Ray> rays;
  std::vector<Circle> circles;
  for (std::size_t k = 0; k < sightings.size(); ++k) {
    const VertexIndex point = sightings[k].to;
    const Ray ray = in_frame(value(sightings[k].from), sightings[k].sight);
    if (sightings[k].sight.has_place())
      places.emplace_back(ray.origin + ray.way);
    else if (sightings[k].sight.has_range)
      circles.push_back({ray.origin, ray.way.norm()});
    else
      rays.push_back({ray.origin, ray.way.normalized()});
    if (k + 1 < sightings.size() && sightings[k + 1].to == point) continue;
    if (places.empty()) places = crossings(rays);
    if (places.empty()) {
      const Eigen::Vector2d present(value(point)[0], value(point)[1]);
      if (const auto place = place_on_circles(circles, present)) places.push_back(*place);
    }
    if (!places.empty()) points.push_back({point, median(places)});
    places.clear();
    rays.clear();
    circles.clear();
  }
  return points;
}

void place_points(const Graph& graph, std::vector<Sighting> sightings, const std::vector<char>& placed,
                  std::vector<double>& values) {
  const auto is_placed = [&](VertexIndex v) { return placed[static_cast<std::size_t>(v)] != 0; };
  std::erase_if(sightings, [&](const Sighting& seen) {
    return !is_placed(seen.from) || is_placed(seen.to) || graph.fixed(seen.to);
  });
  for (const SeenPoint& seen : seen_points(graph, std::move(sightings), values))
    std::copy_n(seen.place.data(), 2, values.data() + graph.offsets()[static_cast<std::size_t>(seen.point)]);
}

}  // namespace waymark

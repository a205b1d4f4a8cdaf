#include <waymark/types_se2/start/detail/rigid_alignment.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace waymark {
namespace {

/// So many pairs of points propose motions, about.
constexpr std::size_t kProposals = 200;
/// Points nearer to each other than this share of the whole extent say nothing about the turn.
constexpr double kApart = 1e-6;
/// A motion keeps distances: two pairs whose points are not equally far apart, but for this share or these
/// metres of noise, are not both right. Without that, any two pairs would fit.
constexpr double kSameDistance = 0.1;
constexpr double kNoise_m = 0.5;

double distance(const Pose2<double>& motion, const PointPair& pair) {
  return (moved(motion, pair.from) - pair.to).norm();
}

double misfit(std::span<const PointPair> pairs, const Pose2<double>& motion) {
  double sum = 0;
  for (const PointPair& pair : pairs) sum += distance(motion, pair);
  return sum;
}

double extent(std::span<const PointPair> pairs) {
  double largest = 0;
  for (const PointPair& pair : pairs) largest = std::max(largest, (pair.from - pairs[0].from).norm());
  return largest;
}

/// Returns the motion of least squares (Procrustes in the plane): centroid to centroid, turned by the mean turn.
Pose2<double> aligned(std::span<const PointPair> pairs, std::span<const double> weights) {
  double sum = 0;
  PointPair centre;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    sum += weights[i];
    centre.from += weights[i] * pairs[i].from;
    centre.to += weights[i] * pairs[i].to;
  }
  centre.from /= sum;
  centre.to /= sum;
  double sine = 0;
  double cosine = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector2d a = pairs[i].from - centre.from;
    const Eigen::Vector2d b = pairs[i].to - centre.to;
    sine += weights[i] * (a[0] * b[1] - a[1] * b[0]);
    cosine += weights[i] * a.dot(b);
  }
  const double turn = std::atan2(sine, cosine);
  return {Eigen::Vector2d(centre.to - rotate(turn, centre.from)), turn};
}

std::optional<Pose2<double>> best_proposal(std::span<const PointPair> pairs) {
  const double least = kApart * extent(pairs);
  const std::size_t n = pairs.size();
  std::optional<Pose2<double>> best;
  double best_misfit = std::numeric_limits<double>::infinity();
  const auto propose = [&](const PointPair& a, const PointPair& b) {
    const double from = (b.from - a.from).norm();
    const double to = (b.to - a.to).norm();
    if (!(from > least) || !(to > 0) ||
        std::abs(from - to) > std::max(kNoise_m, kSameDistance * std::max(from, to)))
      return;
    const Pose2<double> motion = aligned(std::array{a, b}, std::array{1.0, 1.0});
    const double sum = misfit(pairs, motion);
    if (!(sum < best_misfit)) return;
    best = motion;
    best_misfit = sum;
  };
  const std::size_t stride = std::max<std::size_t>(1, n / kProposals);
  const std::size_t gaps = std::clamp<std::size_t>(kProposals / n, 1, n - 1);
  for (std::size_t k = 0; k < gaps; ++k) {
    const std::size_t gap = 1 + k * (n - 1) / gaps;
    for (std::size_t i = 0; i < n; i += stride) propose(pairs[i], pairs[(i + gap) % n]);
  }
  return best;
}

/// Takes steps towards the least sum of distances, by weights that are the inverse of them.
Pose2<double> refined(std::span<const PointPair> pairs, Pose2<double> motion) {
  constexpr int kSteps = 10;
  std::vector<double> weights(pairs.size());
  for (int step = 0; step < kSteps; ++step) {
    const double mean = misfit(pairs, motion) / static_cast<double>(pairs.size());
    if (!(mean > 0)) return motion;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      weights[i] = mean / (0.1 * mean + distance(motion, pairs[i]));
    motion = aligned(pairs, weights);
  }
  return motion;
}

}  // namespace

std::optional<Pose2<double>> rigid_alignment(std::span<const PointPair> pairs) {
  if (pairs.size() < 2) return std::nullopt;
  const auto best = best_proposal(pairs);
  if (!best) return std::nullopt;
  const Pose2<double> fine = refined(pairs, *best);
  return misfit(pairs, fine) <= misfit(pairs, *best) ? fine : best;
}

}  // namespace waymark

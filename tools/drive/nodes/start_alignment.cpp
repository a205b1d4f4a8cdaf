#include <waymark/tools/drive/nodes/start_alignment.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive::start_detail {
namespace {

constexpr double kMinStandstill = 5;    // s, for a bias
constexpr std::size_t kMinAnchors = 3;  // of a window
constexpr double kMaxMisfit = 0.3;      // median residual over spread
constexpr double kResidualFloor = 1;    // m: limits the weight of a window
constexpr double kReweightFloor = 0.5;  // m: shorter distances count alike
constexpr int kReweightings = 20;

Eigen::Vector2d weighted_mean(std::span<const Eigen::Vector2d> points, std::span<const double> weights) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += weights[i] * points[i];
    total += weights[i];
  }
  return sum / total;
}

/// Computes one weighted least-squares alignment (closed form). Writes the distances after it to
/// `distances`.
double align_once(std::span<const Eigen::Vector2d> from, std::span<const Eigen::Vector2d> to,
                  std::span<const double> weights, std::vector<double>& distances) {
  const Eigen::Vector2d from_mean = weighted_mean(from, weights);
  const Eigen::Vector2d to_mean = weighted_mean(to, weights);
  double dot = 0;
  double cross = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d p = from[i] - from_mean;
    const Eigen::Vector2d q = to[i] - to_mean;
    dot += weights[i] * p.dot(q);
    cross += weights[i] * (p[0] * q[1] - p[1] * q[0]);
  }
  const double rotation = std::atan2(cross, dot);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d moved = to_mean + rotate(rotation, Eigen::Vector2d(from[i] - from_mean));
    distances[i] = (to[i] - moved).norm();
  }
  return rotation;
}

double spread_of(std::span<const Eigen::Vector2d> points) {
  const std::vector<double> ones(points.size(), 1.0);
  const Eigen::Vector2d mean = weighted_mean(points, ones);
  double sum = 0;
  for (const Eigen::Vector2d& p : points) sum += (p - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// Returns the length of a window. Rare fixes need longer ones: the time of about five of them.
double window_length(std::span<const Anchor> anchors, double usual_s) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < anchors.size(); ++i)
    spacing.push_back(anchors[i].moving_s - anchors[i - 1].moving_s);
  return spacing.empty() ? usual_s : std::max(usual_s, 5 * upper_median(std::move(spacing)));
}

std::optional<HeadingWindow> align_window(std::span<const Anchor> anchors,
                                          std::span<const Eigen::Vector3d> poses, double least_spread_m) {
  if (anchors.size() < kMinAnchors) return std::nullopt;
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (const Anchor& anchor : anchors) {
    const Eigen::Vector3d& pose = poses[anchor.node];
    from.push_back(pose.head<2>() + rotate(pose[2], anchor.antenna_m));
    to.push_back(anchor.gnss);
  }
  const std::optional<Alignment> fit = align_robustly(from, to);
  if (!fit || fit->spread_m < least_spread_m || fit->residual_m > kMaxMisfit * fit->spread_m)
    return std::nullopt;
  const double noise = std::hypot(fit->residual_m, kResidualFloor);
  return HeadingWindow{.moving_s = 0.5 * (anchors.front().moving_s + anchors.back().moving_s),
                       .offset_rad = fit->rotation_rad,
                       .weight = std::pow(fit->spread_m / noise, 2)};
}

/// Returns the value that is nearest to `target` and equals `angle` except for whole turns.
double nearest_turn(double angle, double target) {
  return target + wrap_angle(angle - target);
}

/// The fixes of one stop.
struct Stop {
  std::vector<double> x, y;
  Eigen::Vector2d antennas = Eigen::Vector2d::Zero();  ///< sum
};

Anchor stop_anchor(double moving_s, std::size_t node, Stop& stop) {
  const Eigen::Vector2d antenna = stop.antennas / static_cast<double>(stop.x.size());
  const Anchor anchor{.moving_s = moving_s,
                      .node = node,
                      .gnss = {upper_median(stop.x), upper_median(stop.y)},
                      .antenna_m = antenna};
  stop = {};
  return anchor;
}

}  // namespace

double weighted_median(std::vector<std::pair<double, double>>& items) {
  if (items.empty()) return 0;
  std::sort(items.begin(), items.end());
  double total = 0;
  for (const auto& item : items) total += item.second;
  double below = 0;
  for (const auto& item : items) {
    below += item.second;
    if (below >= 0.5 * total) return item.first;
  }
  return items.back().first;
}

std::vector<double> moving_time(const Timeline& timeline, double standstill_mps) {
  std::vector<double> moving{0};
  moving.reserve(timeline.stamps.size());
  for (const Interval& interval : timeline.intervals)
    moving.push_back(moving.back() + (interval.stands(standstill_mps) ? 0 : interval.dt_s));
  return moving;
}

std::vector<Anchor> collect_anchors(const Timeline& timeline, std::span<const Fix> fixes,
                                    std::span<const double> moving_s) {
  std::vector<Anchor> anchors;
  Stop stop;
  std::size_t node = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::accepted) continue;
    if (!stop.x.empty() && moving_s[timeline.fix_node[i]] > moving_s[node])
      anchors.push_back(stop_anchor(moving_s[node], node, stop));
    node = timeline.fix_node[i];
    stop.x.push_back(fixes[i].position[0]);
    stop.y.push_back(fixes[i].position[1]);
    stop.antennas += fixes[i].antenna_m;
  }
  if (!stop.x.empty()) anchors.push_back(stop_anchor(moving_s[node], node, stop));
  return anchors;
}

std::optional<double> standstill_bias(const Timeline& timeline, double standstill_mps) {
  std::vector<std::pair<double, double>> rates;
  double total = 0;
  for (const Interval& interval : timeline.intervals) {
    if (!interval.stands(standstill_mps) || interval.bridged) continue;
    rates.emplace_back(interval.yaw_rate_radps, interval.dt_s);
    total += interval.dt_s;
  }
  if (total < kMinStandstill) return std::nullopt;
  return weighted_median(rates);
}

std::vector<Eigen::Vector3d> integrate_along(const Timeline& timeline, std::span<const double> headings,
                                             double standstill_mps) {
  std::vector<Eigen::Vector3d> poses;
  poses.reserve(headings.size());
  poses.emplace_back(0, 0, headings[0]);
  for (std::size_t i = 0; i < timeline.intervals.size(); ++i) {
    const Interval& interval = timeline.intervals[i];
    Eigen::Vector2d position = poses.back().head<2>();
    if (!interval.stands(standstill_mps)) {
      const Eigen::Vector3d twist(interval.speed_mps * interval.dt_s, 0, headings[i + 1] - headings[i]);
      position += rotate(headings[i], se2_exp(twist).position);
    }
    poses.emplace_back(position[0], position[1], headings[i + 1]);
  }
  return poses;
}

std::optional<Alignment> align_robustly(std::span<const Eigen::Vector2d> from,
                                        std::span<const Eigen::Vector2d> to) {
  if (from.size() < 2) return std::nullopt;
  Alignment alignment;
  alignment.spread_m = spread_of(from);
  if (!(alignment.spread_m > 0)) return std::nullopt;
  std::vector<double> weights(from.size(), 1.0);
  std::vector<double> distances(from.size());
  for (int k = 0; k < kReweightings; ++k) {
    alignment.rotation_rad = align_once(from, to, weights, distances);
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = 1 / std::max(distances[i], kReweightFloor);
  }
  alignment.residual_m = upper_median(distances);
  return alignment;
}

std::vector<HeadingWindow> align_windows(std::span<const Anchor> anchors,
                                         std::span<const Eigen::Vector3d> poses, const Windows& how) {
  std::vector<HeadingWindow> windows;
  if (anchors.empty()) return windows;
  const double length = window_length(anchors, how.length_s);
  const double step = length * how.step_s / how.length_s;
  std::size_t first = 0;
  std::size_t last = 0;  // one past the last anchor of the window
  for (double from = anchors.front().moving_s; first < anchors.size(); from += step) {
    while (first < anchors.size() && anchors[first].moving_s < from) ++first;
    last = std::max(last, first);
    while (last < anchors.size() && anchors[last].moving_s < from + length) ++last;
    const auto window = align_window(anchors.subspan(first, last - first), poses, how.least_spread_m);
    // Two windows over the same anchors (around a gap) would count the same vote twice.
    if (window && (windows.empty() || window->moving_s > windows.back().moving_s)) windows.push_back(*window);
    if (last == anchors.size() && from + step + 0.5 * length > anchors.back().moving_s) break;
  }
  return windows;
}

double median_slope(std::span<const HeadingWindow> windows, double apart_s) {
  std::vector<std::pair<double, double>> slopes;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    for (std::size_t j = i + 1; j < windows.size(); ++j) {
      const double dt = windows[j].moving_s - windows[i].moving_s;
      if (dt > apart_s) break;
      const double turn = wrap_angle(windows[j].offset_rad - windows[i].offset_rad);
      const double precision = 1 / (1 / windows[i].weight + 1 / windows[j].weight);
      slopes.emplace_back(turn / dt, precision * dt * dt);
    }
  }
  return weighted_median(slopes);
}

void unwrap_offsets(std::span<HeadingWindow> windows, const Windows& how) {
  if (windows.empty()) return;
  const auto heavier = [](const HeadingWindow& a, const HeadingWindow& b) { return a.weight < b.weight; };
  const auto best = std::max_element(windows.begin(), windows.end(), heavier);
  const auto start = static_cast<std::ptrdiff_t>(best - windows.begin());
  const auto count = static_cast<std::ptrdiff_t>(windows.size());
  for (const std::ptrdiff_t direction : {std::ptrdiff_t{1}, std::ptrdiff_t{-1}}) {
    for (std::ptrdiff_t k = start + direction; k >= 0 && k < count; k += direction) {
      std::vector<std::pair<double, double>> before;
      for (std::ptrdiff_t b = k - direction; before.size() < how.before && b >= 0 && b < count;
           b -= direction) {
        const HeadingWindow& window = windows[static_cast<std::size_t>(b)];
        before.emplace_back(window.offset_rad, window.weight);
        if (b == start) break;
      }
      HeadingWindow& window = windows[static_cast<std::size_t>(k)];
      window.offset_rad = nearest_turn(window.offset_rad, weighted_median(before));
    }
  }
}

Knots smooth_offsets(std::span<const HeadingWindow> windows, const Windows& how) {
  Knots knots;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const std::size_t first = k < how.beside ? 0 : k - how.beside;
    const std::size_t last = std::min(k + how.beside, windows.size() - 1);
    std::vector<std::pair<double, double>> near;
    for (std::size_t i = first; i <= last; ++i) near.emplace_back(windows[i].offset_rad, windows[i].weight);
    knots.at.push_back(windows[k].moving_s);
    knots.value.push_back(weighted_median(near));
  }
  return knots;
}

std::vector<double> evaluate(const Knots& knots, std::span<const double> at) {
  std::vector<double> values(at.size(), 0.0);
  if (knots.at.empty()) return values;
  std::size_t k = 0;  // knot at or before
  for (std::size_t i = 0; i < at.size(); ++i) {
    while (k + 1 < knots.at.size() && knots.at[k + 1] <= at[i]) ++k;
    values[i] = knots.value[k];
    if (at[i] <= knots.at[k] || k + 1 == knots.at.size()) continue;
    const double share = (at[i] - knots.at[k]) / (knots.at[k + 1] - knots.at[k]);
    values[i] += share * (knots.value[k + 1] - knots.value[k]);
  }
  return values;
}

}  // namespace waymark::drive::start_detail

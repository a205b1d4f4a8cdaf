#include <waymark/tools/drive/comparison/agreement.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kWindow_s = 20;
constexpr std::size_t kFewestReadings = 3;  ///< in a window
constexpr std::size_t kLeastWindows = 5;    ///< that two sources share
constexpr double kWidest = 5;               ///< deviations at which a source no longer agrees
constexpr double kGraduation = 1.4;         ///< of the graduation
/// Sources do not agree better than this by chance alone: 5 cm, and as much of a turn at 10 m.
constexpr double kLeastAccuracy = 0.05;

/// Returns the mean square of each component of the differences of two sources, by their medians; empty if
/// they share too few windows.
std::optional<Eigen::Vector2d> variance_between(std::span<const Statements> windows, std::size_t a,
                                                std::size_t b) {
  constexpr double kMedianOfSquare = 0.4549;  // of a standard normal number
  std::array<std::vector<double>, 2> squares;
  for (const Statements& window : windows) {
    if (!window[a] || !window[b]) continue;
    const Eigen::Vector2d apart = *window[a] - *window[b];
    for (int axis = 0; axis < 2; ++axis)
      squares[static_cast<std::size_t>(axis)].push_back(apart[axis] * apart[axis]);
  }
  if (squares[0].size() < kLeastWindows) return std::nullopt;
  return Eigen::Vector2d(upper_median(squares[0]), upper_median(squares[1])) / kMedianOfSquare;
}

double squared_distance(const Eigen::Vector2d& away, const Eigen::Vector2d& sigma) {
  return away.cwiseQuotient(sigma).squaredNorm();
}

/// Returns the mean of statements with the weights that they have, or nothing if no weight is left.
std::optional<Eigen::Vector2d> mean_of(const Statements& window,
                                       std::span<const std::optional<Eigen::Vector2d>> accuracies,
                                       std::span<const double> weights) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d total = Eigen::Vector2d::Zero();
  for (std::size_t s = 0; s < window.size(); ++s) {
    if (!window[s] || !accuracies[s] || weights[s] == 0) continue;
    const Eigen::Vector2d precision = weights[s] * accuracies[s]->cwiseAbs2().cwiseInverse();
    sum += precision.cwiseProduct(*window[s]);
    total += precision;
  }
  if (total[0] == 0) return std::nullopt;
  return Eigen::Vector2d(sum.cwiseQuotient(total));
}

/// The weight of a squared distance under the stretched loss (eq. 14 of the paper).
double weight_of(double squared, double stretch) {
  const double width = kWidest * kWidest;
  if (squared >= (stretch + 1) / stretch * width) return 0;
  if (squared <= stretch / (stretch + 1) * width) return 1;
  return kWidest / std::sqrt(squared) * std::sqrt(stretch * (stretch + 1)) - stretch;
}

/// Returns the weights of the sources in a window, each 0 or 1 in the end.
std::vector<double> graduated(const Statements& window,
                              std::span<const std::optional<Eigen::Vector2d>> accuracies) {
  std::vector<double> weights(window.size(), 0.0);
  for (std::size_t s = 0; s < window.size(); ++s) weights[s] = window[s] && accuracies[s] ? 1 : 0;
  double stretch = 0;
  for (int round = 0; round < 200; ++round) {
    const std::optional<Eigen::Vector2d> mean = mean_of(window, accuracies, weights);
    if (!mean) break;
    double largest = 0;
    std::vector<double> squared(window.size(), 0.0);
    for (std::size_t s = 0; s < window.size(); ++s) {
      if (!window[s] || !accuracies[s]) continue;
      squared[s] = squared_distance(*window[s] - *mean, *accuracies[s]);
      largest = std::max(largest, squared[s]);
    }
    if (round == 0) {
      const double width = kWidest * kWidest;
      if (2 * largest <= width) break;  // all agree
      stretch = width / (2 * largest - width);
    }
    bool decided = true;
    for (std::size_t s = 0; s < window.size(); ++s) {
      if (!window[s] || !accuracies[s]) continue;
      weights[s] = weight_of(squared[s], stretch);
      decided = decided && (weights[s] == 0 || weights[s] == 1);
    }
    if (decided && stretch > 1) break;
    stretch *= kGraduation;
  }
  return weights;
}

/// Tells whether two sources agree within their accuracies.
bool agree(const Statements& window, std::span<const std::optional<Eigen::Vector2d>> accuracies,
           std::size_t a, std::size_t b) {
  const Eigen::Vector2d sigma = (accuracies[a]->cwiseAbs2() + accuracies[b]->cwiseAbs2()).cwiseSqrt();
  return squared_distance(*window[a] - *window[b], sigma) <= kWidest * kWidest;
}

/// Returns the largest set of sources around two that agree; empty if there is none, or another one as large.
std::vector<char> largest_agreement(const Statements& window,
                                    std::span<const std::optional<Eigen::Vector2d>> accuracies) {
  const auto speaks = [&](std::size_t s) { return window[s] && accuracies[s]; };
  std::vector<char> best;
  std::ptrdiff_t most = 1;
  bool is_alone = false;
  for (std::size_t a = 0; a < window.size(); ++a) {
    for (std::size_t b = a + 1; b < window.size(); ++b) {
      if (!speaks(a) || !speaks(b) || !agree(window, accuracies, a, b)) continue;
      std::vector<char> members(window.size(), 0);
      for (std::size_t s = 0; s < window.size(); ++s)
        members[s] = s == a || s == b ||
                     (speaks(s) && agree(window, accuracies, s, a) && agree(window, accuracies, s, b));
      const std::ptrdiff_t count = std::count(members.begin(), members.end(), 1);
      if (count < most || members == best) continue;
      is_alone = count > most;
      most = count;
      best = std::move(members);
    }
  }
  return is_alone ? best : std::vector<char>();
}

/// The windows of a drive: the statements in each, and who contradicts.
struct Windows {
  Stamp start;
  std::vector<Statements> statements;

  [[nodiscard]] std::size_t of(Stamp stamp) const {
    return static_cast<std::size_t>(std::max(0.0, seconds_between(start, stamp) / kWindow_s));
  }
};

/// Marks the windows in which each source contradicts.
std::vector<std::vector<char>> verdicts(const Windows& windows, std::size_t sources) {
  std::vector<std::vector<char>> bad(sources, std::vector<char>(windows.statements.size(), 0));
  if (sources < 3) return bad;
  const auto accuracies = accuracies_by_agreement(windows.statements);
  for (std::size_t w = 0; w < windows.statements.size(); ++w)
    for (const std::size_t source : contradicting(windows.statements[w], accuracies)) bad[source][w] = 1;
  return bad;
}

/// Returns the median distance of a source from the mean of the others that do not contradict.
double distance_from_others(const Windows& windows, const std::vector<std::vector<char>>& bad,
                            std::size_t source, std::size_t first, std::size_t end) {
  std::vector<double> distances;
  for (std::size_t w = first; w < end; ++w) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double count = 0;
    for (std::size_t s = 0; s < bad.size(); ++s) {
      if (bad[s][w] != 0 || !windows.statements[w][s]) continue;
      sum += *windows.statements[w][s];
      ++count;
    }
    if (count > 0 && windows.statements[w][source])
      distances.push_back((*windows.statements[w][source] - sum / count).norm());
  }
  return distances.empty() ? 0 : upper_median(distances);
}

/// Joins windows to times. @param count readings of a source in windows [first, end)
std::vector<Disagreement> times_of(
    const Windows& windows, const std::vector<std::vector<char>>& bad,
    const std::function<std::size_t(std::size_t source, std::size_t first, std::size_t end)>& count) {
  std::vector<Disagreement> times;
  for (std::size_t source = 0; source < bad.size(); ++source) {
    for (std::size_t w = 0; w < bad[source].size(); ++w) {
      if (bad[source][w] == 0) continue;
      const std::size_t first = w;
      while (w < bad[source].size() && bad[source][w] != 0) ++w;
      times.push_back({.source = source,
                       .from = windows.start.later(kWindow_s * static_cast<double>(first)),
                       .to = windows.start.later(kWindow_s * static_cast<double>(w)),
                       .away_m = distance_from_others(windows, bad, source, first, w),
                       .readings = count(source, first, w)});
    }
  }
  return times;
}

/// Returns the median of where the fixes are, relative to the poses.
std::optional<Eigen::Vector2d> median_offset(std::vector<double>& x, std::vector<double>& y) {
  if (x.size() < kFewestReadings) return std::nullopt;
  return Eigen::Vector2d(upper_median(x), upper_median(y));
}

Windows windows_of_fixes(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> poses,
                         std::span<const std::size_t> voices, std::size_t sources) {
  Windows windows{.start = fixes.front().stamp, .statements = {}};
  windows.statements.assign(windows.of(fixes.back().stamp) + 1, Statements(sources));
  struct Offsets {
    std::vector<double> x, y;
  };
  std::map<std::pair<std::size_t, std::size_t>, Offsets> offsets;  // by window and source
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::accepted) continue;
    const Eigen::Vector2d antenna = poses[i].head<2>() + rotate(poses[i][2], fixes[i].antenna_m);
    const Eigen::Vector2d offset = fixes[i].position - antenna;
    Offsets& of = offsets[{windows.of(fixes[i].stamp), voices[static_cast<std::size_t>(fixes[i].source)]}];
    of.x.push_back(offset[0]);
    of.y.push_back(offset[1]);
  }
  for (auto& [key, of] : offsets) windows.statements[key.first][key.second] = median_offset(of.x, of.y);
  return windows;
}

/// Returns the distance [m] and the turn [10 rad: as far as an arm of 10 m moves] in each window that the
/// samples cover.
void add_motion(const std::vector<OdometrySample>& samples, std::size_t source, Windows& windows) {
  constexpr double kArm_m = 10;
  constexpr double kCovered = 0.9;
  std::vector<Eigen::Vector3d> sums(windows.statements.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = seconds_between(samples[i - 1].stamp, samples[i].stamp);
    if (dt > 0.1 * kWindow_s) continue;
    const double speed = 0.5 * (samples[i - 1].speed_mps + samples[i].speed_mps);
    const double yaw_rate = 0.5 * (samples[i - 1].yaw_rate_radps + samples[i].yaw_rate_radps);
    sums[windows.of(samples[i].stamp)] += dt * Eigen::Vector3d(speed, kArm_m * yaw_rate, 1);
  }
  for (std::size_t w = 0; w < sums.size(); ++w)
    if (sums[w][2] >= kCovered * kWindow_s)
      windows.statements[w][source] = kWindow_s / sums[w][2] * sums[w].head<2>();
}

}  // namespace

std::vector<std::optional<Eigen::Vector2d>> accuracies_by_agreement(std::span<const Statements> windows) {
  const std::size_t sources = windows.empty() ? 0 : windows.front().size();
  std::vector<std::optional<Eigen::Vector2d>> accuracies(sources);
  for (std::size_t a = 0; a < sources; ++a) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double count = 0;
    for (std::size_t b = 0; b < sources; ++b) {
      for (std::size_t c = b + 1; c < sources; ++c) {
        if (a == b || a == c) continue;
        const auto ab = variance_between(windows, a, b);
        const auto ac = variance_between(windows, a, c);
        const auto bc = variance_between(windows, b, c);
        if (!ab || !ac || !bc) continue;
        sum += 0.5 * (*ab + *ac - *bc);
        ++count;
      }
    }
    if (count > 0)
      accuracies[a] = Eigen::Vector2d((sum / count).cwiseMax(kLeastAccuracy * kLeastAccuracy).cwiseSqrt());
  }
  return accuracies;
}

std::vector<std::size_t> contradicting(const Statements& window,
                                       std::span<const std::optional<Eigen::Vector2d>> accuracies) {
  const std::vector<double> weights = graduated(window, accuracies);
  std::vector<char> agreeing(window.size(), 0);
  for (std::size_t s = 0; s < window.size(); ++s) agreeing[s] = weights[s] > 0.5;
  // A source that is far more accurate than the others draws the mean to itself, also when it is wrong.
  if (std::count(agreeing.begin(), agreeing.end(), 1) < 2) agreeing = largest_agreement(window, accuracies);
  std::vector<std::size_t> out;
  for (std::size_t s = 0; s < agreeing.size(); ++s)
    if (window[s] && accuracies[s] && agreeing[s] == 0) out.push_back(s);
  return out;
}

std::vector<Disagreement> reject_contradictions(std::span<Fix> fixes, std::span<const Eigen::Vector3d> poses,
                                                std::span<const std::size_t> voices) {
  const std::size_t sources = voices.empty() ? 0 : *std::max_element(voices.begin(), voices.end()) + 1;
  if (sources < 3) return {};
  const Windows windows = windows_of_fixes(fixes, poses, voices, sources);
  const std::vector<std::vector<char>> bad = verdicts(windows, sources);
  const auto reject = [&](std::size_t source, std::size_t first, std::size_t end) {
    std::size_t count = 0;
    for (Fix& fix : fixes) {
      const std::size_t window = windows.of(fix.stamp);
      if (voices[static_cast<std::size_t>(fix.source)] != source || window < first || window >= end) continue;
      if (fix.status != FixStatus::accepted) continue;
      fix.status = FixStatus::rejected;
      fix.reason = "contradicts";
      ++count;
    }
    return count;
  };
  return times_of(windows, bad, reject);
}

std::vector<Disagreement> leave_out_contradictions(std::span<std::vector<OdometrySample>* const> sources) {
  Stamp first{std::numeric_limits<std::int64_t>::max()};
  Stamp last{std::numeric_limits<std::int64_t>::min()};
  std::size_t count = 0;
  for (const std::vector<OdometrySample>* samples : sources) {
    if (samples->empty()) continue;
    ++count;
    first = std::min(first, samples->front().stamp);
    last = std::max(last, samples->back().stamp);
  }
  constexpr double kLongest_s = 30 * 86400;  // longer is a wrong clock, not a drive
  if (count < 3 || seconds_between(first, last) > kLongest_s) return {};
  Windows windows{.start = first, .statements = {}};
  windows.statements.assign(windows.of(last) + 1, Statements(sources.size()));
  for (std::size_t s = 0; s < sources.size(); ++s) add_motion(*sources[s], s, windows);
  const std::vector<std::vector<char>> bad = verdicts(windows, sources.size());
  return times_of(windows, bad, [&](std::size_t source, std::size_t begin, std::size_t end) {
    return std::erase_if(*sources[source], [&](const OdometrySample& sample) {
      const std::size_t window = windows.of(sample.stamp);
      return window >= begin && window < end;
    });
  });
}

std::string warning_of(const Disagreement& disagreement, const std::string& name, Stamp start) {
  return fmt::format(
      "{} contradicts the others, which agree, from {:.0f} to {:.0f} s after the start: by {:.1f} m; its {} "
      "readings there are left out",
      name, seconds_between(start, disagreement.from), seconds_between(start, disagreement.to),
      disagreement.away_m, disagreement.readings);
}

}  // namespace waymark::drive

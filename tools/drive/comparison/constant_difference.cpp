#include <waymark/tools/drive/comparison/constant_difference.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/comparison/chords.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// Where an antenna is beside the pose, and what its receiver claims.
struct Seen {
  Stamp stamp;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  double claims_m = 0;
};

/// Returns the speed of the vehicle at each fix, along its heading; NaN where it is not known.
std::vector<double> speeds_at(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> poses) {
  constexpr double kApart_s = 0.5;
  constexpr double kLongest_s = 10;
  std::vector<double> speeds(fixes.size(), std::numeric_limits<double>::quiet_NaN());
  std::size_t before = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    while (before + 1 < i && seconds_between(fixes[before + 1].stamp, fixes[i].stamp) >= kApart_s) ++before;
    const double apart_s = seconds_between(fixes[before].stamp, fixes[i].stamp);
    if (apart_s < kApart_s || apart_s > kLongest_s) continue;
    speeds[i] =
        rotate(-poses[i][2], Eigen::Vector2d(poses[i].head<2>() - poses[before].head<2>())).x() / apart_s;
  }
  return speeds;
}

/// Differences between two receivers, one for each pair of fixes.
struct Differences {
  std::array<std::vector<double>, 2> in_frame;
  std::array<std::vector<double>, 2> in_body;
  std::vector<double> speed_mps;
  std::vector<double> first_claims_m;
  std::vector<double> second_claims_m;
  Stamp from{};
  Stamp to{};

  /// How often lasting errors are new.
  [[nodiscard]] double minutes() const { return seconds_between(from, to) / 60; }
};

using Pairs = std::map<std::pair<int, int>, Differences>;

Pairs pairs_of(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> poses) {
  constexpr double kTogether_s = 1;
  const std::vector<double> speeds = speeds_at(fixes, poses);
  Pairs pairs;
  std::map<int, Seen> newest;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const Fix& fix = fixes[i];
    if (fix.status != FixStatus::accepted) continue;
    const Eigen::Vector2d antenna = poses[i].head<2>() + rotate(poses[i][2], fix.antenna_m);
    const Seen seen{fix.stamp, fix.position - antenna, fix.accuracy_m()};
    for (const auto& [other, before] : newest) {
      if (other >= fix.source || seconds_between(before.stamp, seen.stamp) > kTogether_s) continue;
      Differences& all = pairs[{other, fix.source}];
      if (all.first_claims_m.empty()) all.from = seen.stamp;
      all.to = seen.stamp;
      const Eigen::Vector2d difference = seen.offset - before.offset;
      const Eigen::Vector2d turned = rotate(-poses[i][2], difference);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        all.in_frame[axis].push_back(difference[static_cast<Eigen::Index>(axis)]);
        all.in_body[axis].push_back(turned[static_cast<Eigen::Index>(axis)]);
      }
      all.speed_mps.push_back(speeds[i]);
      all.first_claims_m.push_back(before.claims_m);
      all.second_claims_m.push_back(seen.claims_m);
    }
    newest[fix.source] = seen;
  }
  return pairs;
}

/// A median vector and the standard deviation of one difference.
struct Middle {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  double spread = 0;
};

Middle middle_of(const std::array<std::vector<double>, 2>& axes) {
  const Median x = median_with_sigma(axes[0]);
  const Median y = median_with_sigma(axes[1]);
  return {{x.value, y.value}, std::hypot(x.spread, y.spread)};
}

constexpr std::size_t kFewestPairs = 20;
constexpr double kFewestMinutes = 3;  // fewer tell neither a difference nor agreement

/// Returns Student's quantile that is 3 for a Gaussian, by Fisher and Cornish's expansion.
double three_sigmas(double degrees_of_freedom) {
  const double share = 1 / degrees_of_freedom;
  return 3 + share * (7.5 + share * (17.25 + share * 30.19));
}

/// Tells whether a median is more than what both claim and what it is known to.
bool counts(const Middle& middle, const Differences& all, double claims_m) {
  constexpr double kClaims = 2;
  const double independent = all.minutes();
  const double sigma = middle.spread / std::sqrt(independent);
  return middle.value.norm() >= std::max(kClaims * claims_m, three_sigmas(independent - 1) * sigma);
}

/// Where the second antenna is ahead, with the speed.
struct AtSpeed {
  double speed_mps;
  double forwards_m;
};

/// Returns how much further behind the second antenna is for each m/s, from the faster and the slower half.
/// Empty if the speed is about the same all the time.
std::optional<double> behind_by_speed_s(std::vector<AtSpeed> all) {
  constexpr double kLeastApart_mps = 3;
  if (all.size() < kFewestPairs) return std::nullopt;
  std::sort(all.begin(), all.end(),
            [](const AtSpeed& a, const AtSpeed& b) { return a.speed_mps < b.speed_mps; });
  const auto middles = [&](std::size_t begin, std::size_t end) {
    std::vector<double> speeds;
    std::vector<double> forwards;
    for (std::size_t i = begin; i < end; ++i) {
      speeds.push_back(all[i].speed_mps);
      forwards.push_back(all[i].forwards_m);
    }
    return AtSpeed{upper_median(std::move(speeds)), upper_median(std::move(forwards))};
  };
  const AtSpeed slow = middles(0, all.size() / 2);
  const AtSpeed fast = middles(all.size() / 2, all.size());
  if (fast.speed_mps - slow.speed_mps < kLeastApart_mps) return std::nullopt;
  return (slow.forwards_m - fast.forwards_m) / (fast.speed_mps - slow.speed_mps);
}

/// Returns how late the second receiver is, if that explains the difference.
std::optional<double> lateness(const Differences& all, double difference_m, double claims_m) {
  constexpr double kMost = 0.5;  // of the difference
  std::vector<AtSpeed> known;
  for (std::size_t i = 0; i < all.speed_mps.size(); ++i)
    if (std::isfinite(all.speed_mps[i])) known.push_back({all.speed_mps[i], all.in_body[0][i]});
  const std::optional<double> late_s = behind_by_speed_s(std::move(known));
  if (!late_s) return std::nullopt;
  std::array<std::vector<double>, 2> left;
  for (std::size_t i = 0; i < all.speed_mps.size(); ++i) {
    if (!std::isfinite(all.speed_mps[i])) continue;
    left[0].push_back(all.in_body[0][i] + *late_s * all.speed_mps[i]);
    left[1].push_back(all.in_body[1][i]);
  }
  const Middle middle = middle_of(left);
  if (counts(middle, all, claims_m) || middle.value.norm() > kMost * difference_m) return std::nullopt;
  return late_s;
}

/// @returns empty if they agree
std::optional<ConstantDifference> judged(const std::pair<int, int>& sources, const Differences& all) {
  constexpr double kBody = 1.1;
  const Middle frame = middle_of(all.in_frame);
  const Middle body = middle_of(all.in_body);
  ConstantDifference difference{.first = sources.first, .second = sources.second};
  difference.in_body = body.value.norm() > kBody * frame.value.norm();
  difference.turned = difference.in_body || frame.value.norm() > kBody * body.value.norm();
  difference.second_m = difference.in_body ? body.value : frame.value;
  difference.first_claims_m = upper_median(all.first_claims_m);
  difference.second_claims_m = upper_median(all.second_claims_m);
  const double claims_m = std::hypot(difference.first_claims_m, difference.second_claims_m);
  if (!counts(difference.in_body ? body : frame, all, claims_m)) return std::nullopt;
  if (difference.in_body || !difference.turned)
    difference.late_s = lateness(all, difference.second_m.norm(), claims_m);
  return difference;
}

/// Returns what the receivers differ by, where, and what to do.
std::string explanation(const ConstantDifference& difference) {
  constexpr const char* kPlace = "state the place of the antennas (antenna: [forwards, left])";
  constexpr const char* kDatum =
      "one of them has another datum, reference station or projection; leave it out, or state accuracies that "
      "contain this (accuracy: {default_sigma: ...})";
  if (!difference.turned) return std::string(kPlace) + "; or " + kDatum;
  return difference.in_body ? kPlace : kDatum;
}

}  // namespace

ComparedReceivers compare_receivers(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> poses) {
  ComparedReceivers compared;
  for (const auto& [sources, all] : pairs_of(fixes, poses)) {
    if (all.first_claims_m.size() < kFewestPairs || all.minutes() < kFewestMinutes) continue;
    if (const auto difference = judged(sources, all))
      compared.differ.push_back(*difference);
    else
      compared.agree.push_back(sources);
  }
  return compared;
}

std::vector<int> outvoted(const ComparedReceivers& compared, std::span<const std::size_t> voices) {
  std::map<int, std::set<int>> friends;
  std::map<int, std::set<int>> opponents;
  for (const auto& [first, second] : compared.agree) {
    friends[first].insert(second);
    friends[second].insert(first);
  }
  for (const ConstantDifference& difference : compared.differ) {
    if (difference.late_s) continue;
    opponents[difference.first].insert(difference.second);
    opponents[difference.second].insert(difference.first);
  }
  const auto voices_of = [&](const std::set<int>& receivers) {
    std::set<std::size_t> distinct;
    for (const int receiver : receivers) distinct.insert(voices[static_cast<std::size_t>(receiver)]);
    return distinct.size();
  };
  std::vector<int> found;
  for (const auto& opposed : opponents) {
    const int source = opposed.first;
    const std::set<int>& against = opposed.second;
    std::set<int> with = friends[source];
    with.insert(source);
    const std::size_t own = voices_of(with);
    const bool is_outvoted = std::any_of(against.begin(), against.end(), [&](int opponent) {
      std::set<int> camp{opponent};  // those against it that agree with this one
      for (const int other : friends[opponent])
        if (against.contains(other)) camp.insert(other);
      return voices_of(camp) > own;
    });
    if (is_outvoted) found.push_back(source);
  }
  return found;
}

std::string warning_of(const ConstantDifference& difference, std::span<const std::string> names,
                       const std::string& time) {
  const Eigen::Vector2d& by = difference.second_m;
  const std::string& first = names[static_cast<std::size_t>(difference.first)];
  const std::string& second = names[static_cast<std::size_t>(difference.second)];
  if (difference.late_s) {
    const bool is_second = *difference.late_s > 0;
    return fmt::format(
        "the fixes of {} are {:.2f} s later than those of {} {}: they are {:.3g} m away, and further the faster "
        "the vehicle is; add {:.2f} to the 'delay' of {}",
        is_second ? second : first, std::abs(*difference.late_s), is_second ? first : second, time, by.norm(),
        std::abs(*difference.late_s), is_second ? second : first);
  }
  const std::string where =
      difference.in_body
          ? fmt::format("{:.2g} m {} and {:.2g} m to the {} of where its antenna is stated", std::abs(by.x()),
                        by.x() < 0 ? "behind" : "before", std::abs(by.y()), by.y() < 0 ? "right" : "left")
          : fmt::format("{:.2g} m to the {} and {:.2g} m to the {}", std::abs(by.x()),
                        by.x() < 0 ? "west" : "east", std::abs(by.y()), by.y() < 0 ? "south" : "north");
  return fmt::format("{} is {:.3g} m away from {} {}, {}, though they claim {:.2g} and {:.2g} m: {}", second,
                     by.norm(), first, time, where, difference.second_claims_m, difference.first_claims_m,
                     explanation(difference));
}

std::string consequence_of(const ConstantDifference& difference) {
  return difference.late_s ? "" : ". The fused positions lie between them, and their covariances do not tell";
}

}  // namespace waymark::drive

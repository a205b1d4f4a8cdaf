#include <waymark/tools/drive/nodes/constant_difference.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/nodes/chords.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// Where an antenna is beside the pose, and what its receiver claims.
struct Seen {
  Stamp stamp;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  double claims_m = 0;
};

/// Differences between two receivers, one for each pair of fixes.
struct Differences {
  std::array<std::vector<double>, 2> in_frame;
  std::array<std::vector<double>, 2> in_body;
  std::vector<double> first_claims_m;
  std::vector<double> second_claims_m;
  Stamp from{};
  Stamp to{};
};

using Pairs = std::map<std::pair<int, int>, Differences>;

Pairs pairs_of(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> poses) {
  constexpr double kTogether_s = 1;
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

std::optional<ConstantDifference> judged(const std::pair<int, int>& sources, const Differences& all) {
  constexpr double kClaims = 2;
  constexpr double kSigmas = 3;
  constexpr double kErrorsLast_s = 60;
  constexpr double kBody = 1.1;
  constexpr std::size_t kFewest = 20;
  if (all.first_claims_m.size() < kFewest) return std::nullopt;
  const Middle frame = middle_of(all.in_frame);
  const Middle body = middle_of(all.in_body);
  ConstantDifference difference{.first = sources.first, .second = sources.second};
  difference.in_body = body.value.norm() > kBody * frame.value.norm();
  difference.turned = difference.in_body || frame.value.norm() > kBody * body.value.norm();
  difference.second_m = difference.in_body ? body.value : frame.value;
  difference.first_claims_m = upper_median(all.first_claims_m);
  difference.second_claims_m = upper_median(all.second_claims_m);
  const double independent = std::max(1.0, seconds_between(all.from, all.to) / kErrorsLast_s);
  const double sigma_m = (difference.in_body ? body : frame).spread / std::sqrt(independent);
  const double claims_m = std::hypot(difference.first_claims_m, difference.second_claims_m);
  if (difference.second_m.norm() < std::max(kClaims * claims_m, kSigmas * sigma_m)) return std::nullopt;
  return difference;
}

}  // namespace

std::vector<ConstantDifference> constant_differences(std::span<const Fix> fixes,
                                                     std::span<const Eigen::Vector3d> poses) {
  std::vector<ConstantDifference> found;
  for (const auto& [sources, all] : pairs_of(fixes, poses))
    if (const auto difference = judged(sources, all)) found.push_back(*difference);
  return found;
}

std::string warning_of(const ConstantDifference& difference, std::span<const std::string> names,
                       const std::string& time) {
  constexpr const char* kPlace = "state the place of the antennas (antenna: [forwards, left])";
  constexpr const char* kDatum =
      "one of them has another datum, reference station or projection; leave it out, or state accuracies that "
      "contain this (accuracy: {default_sigma: ...})";
  const Eigen::Vector2d& by = difference.second_m;
  const std::string where =
      difference.in_body
          ? fmt::format("{:.2g} m {} and {:.2g} m to the {} of where its antenna is stated", std::abs(by.x()),
                        by.x() < 0 ? "behind" : "before", std::abs(by.y()), by.y() < 0 ? "right" : "left")
          : fmt::format("{:.2g} m to the {} and {:.2g} m to the {}", std::abs(by.x()),
                        by.x() < 0 ? "west" : "east", std::abs(by.y()), by.y() < 0 ? "south" : "north");
  return fmt::format(
      "{} is {:.3g} m away from {} {}, {}, though they claim {:.2g} and {:.2g} m: {}. The fused "
      "positions lie between them, and their covariances do not tell",
      names[static_cast<std::size_t>(difference.second)], by.norm(),
      names[static_cast<std::size_t>(difference.first)], time, where, difference.second_claims_m,
      difference.first_claims_m,
      !difference.turned   ? std::string(kPlace) + "; or " + kDatum
      : difference.in_body ? kPlace
                           : kDatum);
}

}  // namespace waymark::drive

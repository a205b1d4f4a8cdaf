#include <waymark/tools/drive/trials/common_errors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/drive/trials/trial_drive.hpp>

namespace waymark::drive {
namespace {

/// Returns the fix nearest to a moment, of those within 1.5 s; their number if there is none.
std::size_t near(Stamp stamp, const std::vector<Stamp>& stamps) {
  constexpr double kSame_s = 1.5;
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  std::size_t nearest = stamps.size();
  double apart_s = kSame_s;
  for (auto at = after == stamps.begin() ? after : after - 1; at != stamps.end() && at <= after; ++at) {
    if (std::abs(seconds_between(*at, stamp)) > apart_s) continue;
    apart_s = std::abs(seconds_between(*at, stamp));
    nearest = static_cast<std::size_t>(at - stamps.begin());
  }
  return nearest;
}

/// Returns the correlation of what is left of two receivers, about zero: a constant error of both counts. 0 for few.
double correlation(const LeftOfFixes& one, const LeftOfFixes& other) {
  constexpr std::size_t kFewestPairs = 30;
  double squares_one = 0;
  double squares_other = 0;
  double products = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < one.stamps.size(); ++i) {
    const std::size_t j = near(one.stamps[i], other.stamps);
    if (j == other.stamps.size()) continue;
    squares_one += one.off_m[i].squaredNorm();
    squares_other += other.off_m[j].squaredNorm();
    products += one.off_m[i].dot(other.off_m[j]);
    ++count;
  }
  const double scale = std::sqrt(squares_one * squares_other);
  return count >= kFewestPairs && scale > 0 ? products / scale : 0;
}

/// Tells whether something is stated for a receiver alone, or of what it has in common.
bool is_stated(const std::string& name, const FusionSettings& settings) {
  for (const auto& [source, stated] : settings.sources)
    if (stated.common == name) return true;
  const auto own = settings.sources.find(name);
  if (own == settings.sources.end()) return false;
  const SourceSettings& stated = own->second;
  return !stated.model.empty() || !stated.options.empty() || !stated.calibration.empty() || stated.loss ||
         !stated.common.empty();
}

}  // namespace

std::map<std::string, std::string> find_common_errors(
    const PlacedDrive& placed, std::span<const PreparedSensor> sensors, const FusionSettings& stated,
    const FusionSettings& settings, const TypeRegistry& registry, const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 2;
  constexpr double kAlike = 0;
  std::map<std::string, std::string> common;
  if (placed.receivers.size() < 2 || !registry.gnss_modeling(settings.modeling).shares_errors) return common;
  const TrialDrive trial(sample_of(coarsen(placed, sensors, kFixPeriod_s)), settings, registry, between);
  std::vector<LeftOfFixes> left;
  for (int source = 0; source < std::ssize(placed.receivers); ++source) left.push_back(trial.left_of(source));
  for (std::size_t other = 1; other < left.size(); ++other) {
    if (is_stated(placed.receivers[other], stated)) continue;
    for (std::size_t first = 0; first < other; ++first) {
      const std::string& name = placed.receivers[first];
      if (common.contains(name) || is_stated(name, stated)) continue;
      if (correlation(left[first], left[other]) < kAlike) continue;
      common[placed.receivers[other]] = name;
      break;
    }
  }
  return common;
}

std::string warning_of(const std::map<std::string, std::string>& common) {
  std::string names;
  for (const auto& [name, first] : common)
    names += fmt::format("{}'{}' as '{}' does", names.empty() ? "" : ", ", name, first);
  return fmt::format(
      "receivers err alike, {}: they are taken for a group that shares the errors that last, because they do not confirm "
      "each other; state that by 'common'",
      names);
}

}  // namespace waymark::drive

#include <waymark/tools/drive/nodes/frozen_fixes.hpp>

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace waymark::drive {
namespace {

constexpr std::size_t kFewestRepeated = 2;
constexpr double kShortestWay_m = 20;

/// The fixes of one receiver at its present place.
struct Place {
  std::size_t first = 0;
  FrozenFixes fixes;
};

void keep_if_frozen(const Place& place, std::vector<FrozenFixes>& found) {
  if (place.fixes.repeated.size() >= kFewestRepeated && place.fixes.distance_m >= kShortestWay_m)
    found.push_back(place.fixes);
}

}  // namespace

std::vector<FrozenFixes> find_frozen_fixes(std::span<const Fix> fixes,
                                           std::span<const Eigen::Vector3d> dead_reckoned) {
  std::vector<FrozenFixes> found;
  std::map<int, Place> places;  // by receiver
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const auto [known, is_new] = places.try_emplace(fixes[i].source);
    Place& place = known->second;
    if (!is_new && fixes[i].position == fixes[place.first].position) {
      place.fixes.repeated.push_back(i);
      place.fixes.to = fixes[i].stamp;
      const Eigen::Vector2d way = dead_reckoned[i].head<2>() - dead_reckoned[place.first].head<2>();
      place.fixes.distance_m = std::max(place.fixes.distance_m, way.norm());
      continue;
    }
    keep_if_frozen(place, found);
    place = Place{i, FrozenFixes{{}, fixes[i].stamp, fixes[i].stamp, 0}};
  }
  for (const auto& [source, place] : places) keep_if_frozen(place, found);
  return found;
}

std::string warning_of(const FrozenFixes& frozen, Stamp start) {
  return fmt::format(
      "{} fixes repeat one position from {:.1f} s to {:.1f} s after the first fix, while the odometry moves by "
      "{:.0f} m: they are left out (rejected: frozen)",
      frozen.repeated.size(), seconds_between(start, frozen.from), seconds_between(start, frozen.to),
      frozen.distance_m);
}

}  // namespace waymark::drive

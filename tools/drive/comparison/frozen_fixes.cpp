#include <waymark/tools/drive/comparison/frozen_fixes.hpp>

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace waymark::drive {
namespace {

constexpr std::size_t kFewestRepeated = 2;
constexpr double kShortestWay_m = 20;

double way_between(std::span<const Eigen::Vector3d> dead_reckoned, std::size_t from, std::size_t to) {
  return (dead_reckoned[to].head<2>() - dead_reckoned[from].head<2>()).norm();
}

/// The fixes of one receiver, in order.
std::map<int, std::vector<std::size_t>> by_receiver(std::span<const Fix> fixes) {
  std::map<int, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < fixes.size(); ++i) members[fixes[i].source].push_back(i);
  return members;
}

/// The places of a receiver that at least one further fix repeats.
std::vector<FrozenFixes> repeated_places(std::span<const Fix> fixes,
                                         std::span<const Eigen::Vector3d> dead_reckoned,
                                         const std::vector<std::size_t>& members) {
  std::vector<FrozenFixes> places;
  for (std::size_t first = 0, next = 1; first < members.size(); first = next++) {
    const std::size_t at = members[first];
    FrozenFixes place{{}, fixes[at].stamp, fixes[at].stamp, 0};
    for (; next < members.size() && fixes[members[next]].position == fixes[at].position; ++next) {
      place.repeated.push_back(members[next]);
      place.to = fixes[members[next]].stamp;
      place.distance_m = std::max(place.distance_m, way_between(dead_reckoned, at, members[next]));
    }
    if (!place.repeated.empty()) places.push_back(std::move(place));
  }
  return places;
}

/// Tells whether a log holds each fix until the next one: most of its fixes repeat the one before although
/// the odometry moved meanwhile.
bool is_held(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
             const std::vector<std::size_t>& members) {
  constexpr double kMoves_m = 0.05;
  constexpr std::size_t kFewestHeld = 20;
  std::size_t moving = 0;
  std::size_t repeated = 0;
  for (std::size_t k = 1; k < members.size(); ++k) {
    if (way_between(dead_reckoned, members[k - 1], members[k]) < kMoves_m) continue;
    ++moving;
    repeated += fixes[members[k]].position == fixes[members[k - 1]].position;
  }
  return repeated >= kFewestHeld && 2 * repeated >= moving;
}

/// All that a log repeats which holds its fixes, as one.
FrozenFixes together(const std::vector<FrozenFixes>& places) {
  FrozenFixes all = places.front();
  all.held = true;
  all.to = places.back().to;
  for (std::size_t i = 1; i < places.size(); ++i) {
    all.repeated.insert(all.repeated.end(), places[i].repeated.begin(), places[i].repeated.end());
    all.distance_m += places[i].distance_m;
  }
  return all;
}

}  // namespace

std::vector<FrozenFixes> find_frozen_fixes(std::span<const Fix> fixes,
                                           std::span<const Eigen::Vector3d> dead_reckoned) {
  std::vector<FrozenFixes> found;
  for (const auto& [source, members] : by_receiver(fixes)) {
    const std::vector<FrozenFixes> places = repeated_places(fixes, dead_reckoned, members);
    if (is_held(fixes, dead_reckoned, members)) {
      found.push_back(together(places));
      continue;
    }
    for (const FrozenFixes& place : places)
      if (place.repeated.size() >= kFewestRepeated && place.distance_m >= kShortestWay_m)
        found.push_back(place);
  }
  return found;
}

std::string warning_of(const FrozenFixes& frozen, Stamp start) {
  if (frozen.held)
    return fmt::format(
        "the log holds each fix until the next one: {} fixes repeat the position before them, while the odometry "
        "moves by {:.0f} m in all; they are left out (rejected: held)",
        frozen.repeated.size(), frozen.distance_m);
  return fmt::format(
      "{} fixes repeat one position from {:.1f} s to {:.1f} s after the first fix, while the odometry moves by "
      "{:.0f} m: they are left out (rejected: frozen)",
      frozen.repeated.size(), seconds_between(start, frozen.from), seconds_between(start, frozen.to),
      frozen.distance_m);
}

}  // namespace waymark::drive

/// How late the fixes are against the odometry, before the graph is built.
///
/// A fix hangs on the node nearest to when it was measured, and its edge is exact at one assumed
/// offset only (EdgeGnssPositionLate). So the offset is found first, on a coarse drive.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/estimation/speed_slip.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// What a drive says about the delay of its fixes. Where there seems to be one, the speeds may slip instead, with a prior
/// of the usual size.
struct TimeOffset {
  double value_s = 0;        ///< posterior mean
  double sigma_s = 0;        ///< posterior
  double prior_sigma_s = 0;  ///< 0: the modeling has no option time_offset_sigma; the odds are then 0
  SpeedSlip slip{};          ///< where there seems to be a delay

  /// Returns the odds that there is no delay, against one that is drawn from its prior: the ratio of
  /// posterior and prior density at 0 (Dickey, "The weighted likelihood ratio", Annals of Mathematical
  /// Statistics 42, 1971).
  [[nodiscard]] double odds_of_none() const;
};

/// Finds PlacedDrive::time_offsets_s, for one setting after the other. The coarse drive is fused with the
/// offsets of before, and again with those that this gives, until they no longer move. Each call begins at
/// the poses of the last one.
class TimeOffsetSearch {
 public:
  /// @param sensors further ones, which take part @param registry must outlive this object
  /// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
  TimeOffsetSearch(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                   const TypeRegistry& registry, const std::function<void()>& between = {});

  /// Finds the offsets alone, and not what the drive says of them. Throws as find().
  void move(const FusionSettings& settings, PlacedDrive& placed);
  /// Nothing changes if the settings estimate no time offset.
  /// @param settings from decided() @param placed the drive of the constructor
  /// @throws UsageError for an unknown modeling or option; errors of the plugins
  /// @returns the offset of each group (groups_of() in build.hpp); empty for one that has none
  std::vector<std::optional<TimeOffset>> find(const FusionSettings& settings, PlacedDrive& placed);

 private:
  struct Minimum;

  /// As converge(), for the drive of the constructor, whose offsets are those of `placed` before and after.
  Minimum reach(const FusionSettings& settings, PlacedDrive& placed);
  /// Fuses a drive until its offsets no longer move, and leaves them and its poses there.
  [[nodiscard]] Minimum converge(const FusionSettings& settings, CoarseDrive& coarse) const;
  /// Makes what is known of the offsets what is known if the speeds may slip. They stay where the cost rises with a
  /// slip.
  void admit_slip(const FusionSettings& settings, Minimum minimum,
                  std::vector<std::optional<TimeOffset>>& offsets) const;

  CoarseDrive coarse_;
  const TypeRegistry& registry_;
  std::function<void()> between_;
};

/// Returns the vertex of the time offset that a graph estimates among some vertices, if it does.
[[nodiscard]] std::optional<VertexIndex> time_offset_vertex(const Graph& graph,
                                                            std::span<const formats::VertexRange> among);

}  // namespace waymark::drive

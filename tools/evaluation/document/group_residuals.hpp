/// Residuals of the measurements of a source by the groups that its plugin tells of: by satellite, by
/// anchor (core/drive/measurement_groups.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/drive/measurement_groups.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::evaluation {

/// One measurement after the fit. NaN: not known.
struct GroupedMeasurement {
  std::optional<Stamp> stamp;    ///< the latest one of its vertices
  std::size_t quantity = 0;      ///< index into GroupedResiduals::quantities
  std::size_t group = 0;         ///< index into GroupedResiduals::groups
  double residual = kUndefined;  ///< first number of the error, in the unit of the quantity
  double weight = 1;             ///< from the loss: rho'(e^T Omega e); 1 without a loss
  double signal = kUndefined;
  double bearing_rad = kUndefined;
  double elevation_rad = kUndefined;
};

/// The measurements of one quantity in one group, or in several together.
struct QuantityResiduals {
  std::size_t measurements = 0;
  double rms = kUndefined;           ///< of the residuals, in the unit of the quantity
  double whitened_rms = kUndefined;  ///< of sqrt(e^T Omega e); about 1 or below if the noise is as stated
  std::size_t robust = 0;            ///< measurements with a loss
  std::size_t down_weighted = 0;     ///< whose loss leaves less than half of their weight
  double weight = kUndefined;        ///< mean weight

  /// Returns the share of the down-weighted ones among all; undefined without a loss.
  [[nodiscard]] double share_down_weighted() const;
  /// Adds those of another group.
  void add(const QuantityResiduals& other);
};

struct GroupResiduals {
  std::string name;
  std::string family;
  std::vector<QuantityResiduals> quantities;  ///< as GroupedResiduals::quantities
  double signal = kUndefined;                 ///< mean of its measurements
  double lowest_rad = kUndefined;             ///< elevation
  double highest_rad = kUndefined;
};

/// The groups of one source.
struct GroupedResiduals {
  std::string source;
  std::string one;   ///< "satellite"
  std::string many;  ///< "satellites"
  std::string signal_name, signal_unit;
  std::vector<MeasurementGroups::Quantity> quantities;
  std::vector<GroupResiduals> groups;            ///< by family as they came, then by name
  std::vector<GroupedMeasurement> measurements;  ///< in the order of the groups, then of time

  /// Returns the families in the order of the groups; one without a name if the plugin names none.
  [[nodiscard]] std::vector<std::string> families() const;
};

/// Returns the residuals at the present values of the graph. O(n log n) in the number of measurements.
/// @param groups of this graph, with the places of their edges
[[nodiscard]] std::vector<GroupedResiduals> residuals_by_group(const Graph& graph,
                                                               std::span<const GroupsOfSource> groups);

/// Returns a row for each group.
[[nodiscard]] text::Table group_table(const GroupedResiduals& residuals);
/// Returns a row for each family, for the terminal. @param label of the result, if there are several
[[nodiscard]] text::Table family_table(const GroupedResiduals& residuals, const std::string& label = "");
[[nodiscard]] nlohmann::ordered_json grouped_residuals_json(std::span<const GroupedResiduals> residuals);

}  // namespace waymark::evaluation

/// Statistics of each source of a simulated drive against its exact poses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark::simulation {

struct SourceStatistics {
  std::string name;
  std::string kind;  ///< odometry or gnss
  double rate_hz = 0;
  std::size_t readings = 0;
  double availability_percent = 0;  ///< readings of the instants at which one was due
  /// of the distances between fixes and exact antenna positions; NaN for odometry
  double rms_m = evaluation::kUndefined;
};

/// Returns the odometries in the order of the recipe, then the receivers.
[[nodiscard]] std::vector<SourceStatistics> source_statistics(const SimulatedDrive& drive);

}  // namespace waymark::simulation

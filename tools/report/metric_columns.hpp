/// The metrics of positions as columns. Names and order are the same in all tables and figures.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::report {

/// A metric of positions.
struct PositionColumn {
  std::string name;  ///< "RMSE"
  std::string id;    ///< "rmse"
  std::string about;
  double evaluation::PositionMetrics::*value;
};
[[nodiscard]] const std::vector<PositionColumn>& position_columns();

}  // namespace waymark::report

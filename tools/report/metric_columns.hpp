/// The metrics of positions as columns: their names in tables and figures, in one order everywhere.
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

/// "-" where it is not defined.
[[nodiscard]] std::string decimals(double value, int digits);

}  // namespace waymark::report

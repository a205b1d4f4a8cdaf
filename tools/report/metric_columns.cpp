#include <waymark/tools/report/metric_columns.hpp>

namespace waymark::report {

const std::vector<PositionColumn>& position_columns() {
  static const std::vector<PositionColumn> columns = {
      {"Max", "max", "Largest distance from the truth", &evaluation::PositionMetrics::max_m},
      {"Acc", "acc", "Length of the mean offset: the systematic part",
       &evaluation::PositionMetrics::accuracy_m},
      {"Prec", "prec", "Deviation about the mean offset: the random part",
       &evaluation::PositionMetrics::precision_m},
      {"RMSE", "rmse", "Root of the mean squared distance", &evaluation::PositionMetrics::rmse_m},
      {"median", "median", "Median distance", &evaluation::PositionMetrics::median_m},
      {"CEP50", "cep50", "Radius that holds 50 % of the epochs", &evaluation::PositionMetrics::cep50_m},
      {"CEP95", "cep95", "Radius that holds 95 % of the epochs", &evaluation::PositionMetrics::cep95_m}};
  return columns;
}

}  // namespace waymark::report

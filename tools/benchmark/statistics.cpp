#include <waymark/tools/benchmark/statistics.hpp>

#include <algorithm>
#include <numeric>

#include <waymark/core/base/error.hpp>

namespace waymark::benchmark {
namespace {

void require_values(const std::vector<double>& values) {
  if (values.empty()) throw UsageError("a median needs at least one value");
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  require_values(values);
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {median, values.front(), values.back()};
}

std::size_t index_of_median(const std::vector<double>& values) {
  require_values(values);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order[(values.size() - 1) / 2];
}

}  // namespace waymark::benchmark

#include <waymark/core/linear/detail/factor_work.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/detail/factor_rows.hpp>

namespace waymark::detail {
namespace {

/// The neighbours of each column that come before it. Both are places in the order.
struct Earlier {
  std::vector<std::int64_t> begin;
  std::vector<int> columns;
};

Earlier earlier_neighbours(std::span<const std::int64_t> begin, std::span<const int> rows,
                           std::span<const int> order) {
  const std::size_t n = order.size();
  std::vector<int> place(n);
  for (std::size_t k = 0; k < n; ++k) place[at(order[k])] = static_cast<int>(k);
  const auto for_each_pair = [&](auto visit) {
    for (std::size_t j = 0; j < n; ++j) {
      for (auto e = begin[j]; e < begin[j + 1]; ++e) {
        const int other = place[at(rows[at(e)])];
        visit(at(std::max(place[j], other)), std::min(place[j], other));
      }
    }
  };
  Earlier result{std::vector<std::int64_t>(n + 1, 0), std::vector<int>(rows.size())};
  for_each_pair([&](std::size_t later, int) { ++result.begin[later + 1]; });
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::vector<std::int64_t> next(result.begin.begin(), result.begin.end() - 1);
  for_each_pair([&](std::size_t later, int earlier) { result.columns[at(next[later]++)] = earlier; });
  return result;
}

}  // namespace

double factor_work(std::span<const std::int64_t> begin, std::span<const int> rows, std::span<const int> order,
                   std::span<const int> sizes, double limit) {
  const std::size_t n = order.size();
  const Earlier earlier = earlier_neighbours(begin, rows, order);
  FactorRows factor(n);
  std::vector<double> height(n);
  double work = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double size = sizes[at(order[k])];
    height[k] = size;
    work += size * size * size;
    factor.begin(k);
    for (auto e = earlier.begin[k]; e < earlier.begin[k + 1]; ++e) {
      factor.follow(earlier.columns[at(e)], [&](int j) {
        work += sizes[at(order[at(j)])] * size * (2 * height[at(j)] + size);
        height[at(j)] += size;
      });
      if (work > limit) return work;
    }
  }
  return work;
}

}  // namespace waymark::detail

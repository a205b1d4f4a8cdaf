/// The work of a factorisation, by which orders are compared.
#pragma once

#include <cstdint>
#include <span>

#include <waymark/core/base/export.hpp>

namespace waymark::detail {

/// Returns about the multiplications of a Cholesky factorisation in an order: the squares of the heights of the
/// scalar columns of the factor, summed. Beyond the limit it stops and returns less, but more than the limit.
/// @param begin, rows upper triangle of the blocks, as in order_blocks
/// @param order of all columns
/// @param sizes scalar columns of each
[[nodiscard]] WAYMARK_EXPORT double factor_work(std::span<const std::int64_t> begin,
                                                std::span<const int> rows, std::span<const int> order,
                                                std::span<const int> sizes, double limit);

}  // namespace waymark::detail

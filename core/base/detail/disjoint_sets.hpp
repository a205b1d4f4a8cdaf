/// Sets of the numbers from 0 to n - 1 that grow together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace waymark::detail {

/// Union and find with path halving (Tarjan and van Leeuwen 1984). The name of a set is its first member.
class DisjointSets {
 public:
  /// Each number is a set of its own.
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// Returns the name of the set of a member.
  [[nodiscard]] std::int32_t of(std::int32_t member) {
    while (parent(member) != member) member = parent(member) = parent(parent(member));
    return member;
  }

  /// Makes the sets of two members one. @return its name
  std::int32_t join(std::int32_t a, std::int32_t b) {
    const auto [first, last] = std::minmax({of(a), of(b)});
    return parent(last) = first;
  }

 private:
  [[nodiscard]] std::int32_t& parent(std::int32_t member) {
    return parent_[static_cast<std::size_t>(member)];
  }

  std::vector<std::int32_t> parent_;
};

}  // namespace waymark::detail

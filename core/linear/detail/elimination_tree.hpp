/// The elimination tree of a block pattern, and the order of its nodes that a factorisation walks.
#pragma once

#include <cstdint>
#include <vector>

#include <waymark/core/linear/block_pattern.hpp>

namespace waymark {

/// Parents in the elimination tree (Liu 1990): parent[j] is the first row below the diagonal in column j of
/// the factor, -1 where there is none.
[[nodiscard]] std::vector<int> elimination_tree(const BlockPattern& pattern);

/// First child and next sibling of every node, children ascending; -1: none.
struct Children {
  std::vector<int> first;
  std::vector<int> next;

  explicit Children(const std::vector<int>& parent);
};

/// A postorder of the tree: subtrees contiguous, children before parents. A chain of more than a few dozen
/// single links that ends at a root is re-rooted at its middle, so that it is eliminated from both ends;
/// `parent` becomes the tree of that order (still by the pattern's columns).
[[nodiscard]] std::vector<int> twisted_postorder(const BlockPattern& pattern, std::vector<int>& parent);

}  // namespace waymark

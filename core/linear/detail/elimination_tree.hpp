/// The elimination tree of a block pattern, and the order in which a factorisation
/// visits its nodes.
#pragma once

#include <cstdint>
#include <vector>

#include <waymark/core/linear/block_pattern.hpp>

namespace waymark {

/// Returns the parents in the elimination tree (Liu 1990). parent[j] is the first row below the
/// diagonal in column j of the factor, or -1 if there is none.
[[nodiscard]] std::vector<int> elimination_tree(const BlockPattern& pattern);

/// The first child and the next sibling of every node, children ascending; -1: none.
struct Children {
  std::vector<int> first;
  std::vector<int> next;

  explicit Children(const std::vector<int>& parent);
};

/// Returns a postorder of the tree: subtrees are contiguous, and children come before parents. A
/// chain of more than a few dozen single links that ends at a root gets a new root in its middle,
/// so that it is eliminated from both ends. `parent` becomes the tree of that order (still by the
/// columns of the pattern).
[[nodiscard]] std::vector<int> twisted_postorder(const BlockPattern& pattern, std::vector<int>& parent);

}  // namespace waymark

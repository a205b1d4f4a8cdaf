#include <waymark/core/linear/detail/elimination_tree.hpp>

#include <waymark/core/base/detail/index.hpp>

namespace waymark {
namespace {

using detail::at;

}  // namespace

std::vector<int> elimination_tree(const BlockPattern& pattern) {
  const int n = pattern.columns();
  std::vector<int> parent(at(n), -1);
  std::vector<int> ancestor(at(n), -1);
  for (int k = 0; k < n; ++k) {
    for (auto e = pattern.column[at(k)]; e + 1 < pattern.column[at(k) + 1]; ++e) {
      int i = pattern.row[at(e)];
      while (i >= 0 && i < k) {
        const int up = ancestor[at(i)];
        ancestor[at(i)] = k;
        if (up < 0) parent[at(i)] = k;
        i = up;
      }
    }
  }
  return parent;
}

Children::Children(const std::vector<int>& parent) : first(parent.size(), -1), next(parent.size(), -1) {
  for (int k = static_cast<int>(parent.size()) - 1; k >= 0; --k) {
    const int up = parent[at(k)];
    if (up < 0) continue;
    next[at(k)] = first[at(up)];
    first[at(up)] = k;
  }
}

namespace {

/// Appends the subtree of `root` in postorder.
void append_postorder(const Children& children, int root, std::vector<int>& order) {
  std::vector<int> stack = {root};
  std::vector<int> child(1, children.first[at(root)]);
  while (!stack.empty()) {
    const int c = child.back();
    if (c >= 0) {
      child.back() = children.next[at(c)];
      stack.push_back(c);
      child.push_back(children.first[at(c)]);
    } else {
      order.push_back(stack.back());
      stack.pop_back();
      child.pop_back();
    }
  }
}

/// Finds nodes for which they and all their descendants have a column of the factor with at most
/// one block below the diagonal. By induction, the column of such a node is that of the matrix.
std::vector<char> find_simple(const BlockPattern& pattern, const std::vector<int>& parent) {
  const int n = pattern.columns();
  std::vector<int> below(at(n), 0);
  for (int j = 0; j < n; ++j) {
    for (auto e = pattern.column[at(j)]; e + 1 < pattern.column[at(j) + 1]; ++e) {
      ++below[at(pattern.row[at(e)])];
    }
  }
  std::vector<char> simple(at(n), 1);
  for (int j = 0; j < n; ++j) {
    if (below[at(j)] > 1) simple[at(j)] = 0;
    if (!simple[at(j)] && parent[at(j)] >= 0) simple[at(parent[at(j)])] = 0;
  }
  return simple;
}

constexpr int kShortestTwist = 64;  // a shorter chain does not profit from two halves

}  // namespace

std::vector<int> twisted_postorder(const BlockPattern& pattern, std::vector<int>& parent) {
  const Children children(parent);
  const std::vector<char> simple = find_simple(pattern, parent);
  const int n = pattern.columns();
  std::vector<int> weight(at(n), 1);  // nodes of a subtree
  for (int k = 0; k < n; ++k) {
    if (parent[at(k)] >= 0) weight[at(parent[at(k)])] += weight[at(k)];
  }
  std::vector<int> order;
  order.reserve(at(n));
  std::vector<int> path;
  for (int root = 0; root < n; ++root) {
    if (parent[at(root)] >= 0) continue;
    // Go down the heaviest children as long as everything below is simple, until half of the
    // tree is passed.
    path.clear();
    int node = root;
    while (simple[at(node)] && weight[at(node)] > weight[at(root)] / 2) {
      path.push_back(node);
      int heaviest = -1;
      for (int c = children.first[at(node)]; c >= 0; c = children.next[at(c)]) {
        if (heaviest < 0 || weight[at(c)] > weight[at(heaviest)]) heaviest = c;
      }
      if (heaviest < 0) break;
      node = heaviest;
    }
    if (static_cast<int>(path.size()) < kShortestTwist) {
      append_postorder(children, root, order);
      continue;
    }
    // The last node of the path becomes the root. First come its descendants, then the path from
    // the old root.
    const int middle = path.back();
    for (int c = children.first[at(middle)]; c >= 0; c = children.next[at(c)]) {
      append_postorder(children, c, order);
    }
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      for (int c = children.first[at(path[i])]; c >= 0; c = children.next[at(c)]) {
        if (c != path[i + 1]) append_postorder(children, c, order);
      }
      order.push_back(path[i]);
      parent[at(path[i])] = path[i + 1];
    }
    order.push_back(middle);
    parent[at(middle)] = -1;
  }
  return order;
}

}  // namespace waymark

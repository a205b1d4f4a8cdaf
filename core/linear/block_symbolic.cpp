#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/block_symbolic.hpp>
#include <waymark/core/linear/detail/elimination_tree.hpp>

namespace waymark {
namespace {

using detail::at;

/// Blocks of the matrix by the earlier of their two columns.
struct LowerBlocks {
  struct Block {
    int row;          // the later column, in elimination order
    int from;         // block column of the pattern
    int entry;        // its entry there
    bool transposed;  // the rows of the earlier column are stored
  };
  std::vector<std::int64_t> begin;
  std::vector<Block> blocks;
};

LowerBlocks lower_blocks(const BlockPattern& pattern, const std::vector<int>& place) {
  const int n = pattern.columns();
  LowerBlocks lower;
  lower.begin.assign(at(n) + 1, 0);
  const auto visit = [&](auto take) {
    for (int j = 0; j < n; ++j) {
      for (auto e = pattern.column[at(j)]; e + 1 < pattern.column[at(j) + 1]; ++e) {
        take(place[at(pattern.row[at(e)])], place[at(j)], j, static_cast<int>(e));
      }
    }
  };
  visit([&](int a, int b, int, int) { ++lower.begin[at(std::min(a, b)) + 1]; });
  std::partial_sum(lower.begin.begin(), lower.begin.end(), lower.begin.begin());
  lower.blocks.resize(at(lower.begin.back()));
  std::vector<std::int64_t> next(lower.begin.begin(), lower.begin.end() - 1);
  visit([&](int a, int b, int j, int e) {
    lower.blocks[at(next[at(std::min(a, b))]++)] = {std::max(a, b), j, e, a < b};
  });
  return lower;
}

/// The rows below the diagonal of every block column of the factor, ascending.
struct FactorColumns {
  std::vector<std::int64_t> begin{0};
  std::vector<int> rows;
  [[nodiscard]] std::int64_t count(int k) const { return begin[at(k) + 1] - begin[at(k)]; }
};

FactorColumns factor_columns(const LowerBlocks& lower, const std::vector<int>& parent) {
  const Children children(parent);
  const int n = static_cast<int>(parent.size());
  FactorColumns factor;
  factor.begin.reserve(at(n) + 1);
  factor.rows.reserve(lower.blocks.size() + at(n));
  std::vector<int> seen(at(n), -1);
  for (int k = 0; k < n; ++k) {
    const auto first = factor.rows.size();
    const auto add = [&](int row) {
      if (row == k || seen[at(row)] == k) return;
      seen[at(row)] = k;
      factor.rows.push_back(row);
    };
    for (auto e = lower.begin[at(k)]; e < lower.begin[at(k) + 1]; ++e) add(lower.blocks[at(e)].row);
    for (int c = children.first[at(k)]; c >= 0; c = children.next[at(c)]) {
      for (auto e = factor.begin[at(c)]; e < factor.begin[at(c) + 1]; ++e) add(factor.rows[at(e)]);
    }
    std::sort(factor.rows.begin() + static_cast<std::ptrdiff_t>(first), factor.rows.end());
    factor.begin.push_back(static_cast<std::int64_t>(factor.rows.size()));
  }
  return factor;
}

/// Estimates the nanoseconds of a dense front: a call, the numbers it touches, its flops.
double front_cost(double columns, double below) {
  const double rows = columns + below;
  const double flops = columns * columns * (columns / 3 + below) + columns * below * below;
  return 150 + 0.5 * (rows * columns + below * below) + 0.12 * flops;
}

double cost(const Supernode& node) {
  constexpr double kLinkCost = 30;
  return node.links > 0 ? kLinkCost * node.links : front_cost(node.columns, node.below);
}

/// Finds supernodes: chains, and columns of nested structure. Further columns are joined if a
/// common front, with its zeros, is estimated to be faster.
std::vector<Supernode> find_supernodes(const BlockSymbolic& symbolic, const FactorColumns& factor,
                                       const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<char> children(at(n), 0);    // counted only up to two
  std::vector<char> wide_child(at(n), 0);  // a child reaches further than its parent
  for (int k = 0; k < n; ++k) {
    const int up = parent[at(k)];
    if (up < 0) continue;
    children[at(up)] = static_cast<char>(std::min(children[at(up)] + 1, 2));
    if (factor.count(k) > 1) wide_child[at(up)] = 1;
  }
  std::vector<Supernode> made;
  for (int k = 0; k < n; ++k) {
    Supernode node;
    node.first = k;
    node.last = k + 1;
    node.columns = symbolic.size[at(k)];
    for (auto e = factor.begin[at(k)]; e < factor.begin[at(k) + 1]; ++e) {
      node.below += symbolic.size[at(factor.rows[at(e)])];
    }
    if (node.columns == Supernode::kLinkSize && node.below == Supernode::kLinkSize && factor.count(k) == 1 &&
        !wide_child[at(k)]) {
      if (!made.empty() && made.back().links > 0 && parent[at(k) - 1] == k && children[at(k)] == 1) {
        Supernode& chain = made.back();
        chain.last = k + 1;
        chain.columns += node.columns;
        ++chain.links;
        continue;
      }
      node.links = 1;
      made.push_back(node);
      continue;
    }
    // The last child is just before the node. If it joins, the next last child may join too.
    while (!made.empty()) {
      const Supernode& child = made.back();
      const int up = parent[at(child.last) - 1];
      if (up < node.first || up >= node.last || child.links > 1) break;
      const double together = front_cost(child.columns + node.columns, node.below);
      if (together > cost(child) + cost(node)) break;
      node.first = child.first;
      node.columns += child.columns;
      made.pop_back();
    }
    made.push_back(node);
  }
  return made;
}

/// Fills panels, row lists and the matrix blocks of the supernodes.
class Layout {
 public:
  Layout(const BlockPattern& pattern, const LowerBlocks& lower, const FactorColumns& factor,
         const std::vector<int>& parent, BlockSymbolic& symbolic)
      : pattern_(pattern),
        lower_(lower),
        factor_(factor),
        parent_(parent),
        symbolic_(symbolic),
        front_row_(parent.size(), 0) {}

  void run() {
    join();
    for (Supernode& node : symbolic_.nodes) {
      node.start = symbolic_.start[at(node.first)];
      node.panel = symbolic_.factor_size;
      node.rows = static_cast<std::int64_t>(symbolic_.rows.size());
      const int last = node.last - 1;
      node.row_count = static_cast<int>(factor_.count(last));
      const auto rows = factor_.rows.begin() + factor_.begin[at(last)];
      symbolic_.rows.insert(symbolic_.rows.end(), rows, rows + node.row_count);
      if (node.links > 0) {
        lay_out_chain(node);
      } else {
        lay_out_front(node);
      }
    }
    find_positions();
  }

 private:
  /// Builds the tree over the supernodes.
  void join() {
    std::vector<int> node_of(parent_.size());
    for (std::size_t s = 0; s < symbolic_.nodes.size(); ++s) {
      const Supernode& node = symbolic_.nodes[s];
      std::fill(node_of.begin() + node.first, node_of.begin() + node.last, static_cast<int>(s));
    }
    for (std::size_t s = symbolic_.nodes.size(); s-- > 0;) {
      Supernode& node = symbolic_.nodes[s];
      const int up = parent_[at(node.last) - 1];
      if (up < 0) continue;
      node.parent = node_of[at(up)];
      Supernode& parent = symbolic_.nodes[at(node.parent)];
      node.next_sibling = parent.first_child;
      parent.first_child = static_cast<int>(s);
    }
  }

  [[nodiscard]] std::uint32_t source(int from, std::int64_t entry) const {
    return static_cast<std::uint32_t>(pattern_.value[at(from)] + pattern_.row_offset[at(entry)]);
  }
  [[nodiscard]] std::int64_t diagonal_entry(int from) const { return pattern_.column[at(from) + 1] - 1; }

  void lay_out_chain(Supernode& node) {
    symbolic_.factor_size += Supernode::kLinkNumbers * std::int64_t{node.links};
    node.entries = static_cast<std::int64_t>(symbolic_.links.size());
    for (int k = node.first; k < node.last; ++k) {
      const int own = symbolic_.column[at(k)];
      const auto& block = lower_.blocks[at(lower_.begin[at(k)])];
      const int stride = pattern_.height[at(block.from)];
      symbolic_.links.push_back({source(own, diagonal_entry(own)), source(block.from, block.entry),
                                 pattern_.height[at(own)], block.transposed ? -stride : stride});
    }
    node.entries_end = static_cast<std::int64_t>(symbolic_.links.size());
  }

  void lay_out_front(Supernode& node) {
    const int height = node.columns + node.below;
    node.stride = (height + 3) / 4 * 4;
    // Kernels read whole registers: up to 3 numbers after the last column. These must not belong to
    // another subtree, because a thread may be writing there.
    symbolic_.factor_size += std::int64_t{node.stride} * node.columns + (node.below + 3) / 4 * 4 - node.below;
    symbolic_.largest_front = std::max(symbolic_.largest_front, height);
    int row = 0;
    const auto place = [&](int k) {
      front_row_[at(k)] = row;
      row += symbolic_.size[at(k)];
    };
    for (int k = node.first; k < node.last; ++k) place(k);
    for (int i = 0; i < node.row_count; ++i) place(symbolic_.rows[at(node.rows + i)]);
    node.entries = static_cast<std::int64_t>(symbolic_.entries.size());
    for (int k = node.first; k < node.last; ++k) {
      const auto add = [&](int from, std::int64_t entry, int block_row, bool transposed) {
        symbolic_.entries.push_back({source(from, entry), pattern_.height[at(from)],
                                     front_row_[at(block_row)] + front_row_[at(k)] * node.stride,
                                     static_cast<std::uint16_t>(pattern_.size[at(pattern_.row[at(entry)])]),
                                     static_cast<std::uint16_t>(pattern_.size[at(from)]), transposed});
      };
      const int own = symbolic_.column[at(k)];
      add(own, diagonal_entry(own), k, false);
      for (auto e = lower_.begin[at(k)]; e < lower_.begin[at(k) + 1]; ++e) {
        const auto& block = lower_.blocks[at(e)];
        add(block.from, block.entry, block.row, block.transposed);
      }
    }
    node.entries_end = static_cast<std::int64_t>(symbolic_.entries.size());
  }

  /// Finds the place of each row of a supernode in the front of its parent. In a chain only the
  /// first link is reached from outside.
  void find_positions() {
    symbolic_.position.assign(symbolic_.rows.size(), 0);
    for (const Supernode& node : symbolic_.nodes) {
      if (node.parent < 0) continue;
      const Supernode& up = symbolic_.nodes[at(node.parent)];
      auto known = symbolic_.rows.begin() + up.rows;
      int below = up.columns;
      for (int i = 0; i < node.row_count; ++i) {
        const int k = symbolic_.rows[at(node.rows + i)];
        int& row = symbolic_.position[at(node.rows + i)];
        if (k < up.last) {
          row = static_cast<int>(symbolic_.start[at(k)] - up.start);
          continue;
        }
        while (*known != k) below += symbolic_.size[at(*known++)];
        row = below;
      }
    }
  }

  const BlockPattern& pattern_;
  const LowerBlocks& lower_;
  const FactorColumns& factor_;
  const std::vector<int>& parent_;
  BlockSymbolic& symbolic_;
  std::vector<int> front_row_;
};

constexpr std::size_t kMostSubtrees = 8;
// nanoseconds; for a smaller subtree a thread costs more than it saves
constexpr double kSmallestSubtree = 20'000;

/// Finds disjoint subtrees that can be processed in parallel. The heaviest one is split at a
/// branching if both parts are large enough and little work remains above.
void find_subtrees(BlockSymbolic& symbolic) {
  const int n = static_cast<int>(symbolic.nodes.size());
  std::vector<double> weight(at(n));
  std::vector<int> first(at(n));  // first member of each subtree
  std::vector<int> parent(at(n));
  for (int s = 0; s < n; ++s) first[at(s)] = s;
  for (int s = 0; s < n; ++s) {
    const Supernode& node = symbolic.nodes[at(s)];
    weight[at(s)] += cost(node);
    parent[at(s)] = node.parent;
    if (node.parent < 0) continue;
    weight[at(node.parent)] += weight[at(s)];
    first[at(node.parent)] = std::min(first[at(node.parent)], first[at(s)]);
  }
  const Children children(parent);
  // Goes down the heaviest children to the first branching with large parts. Returns -1 if
  // there is none.
  const auto branching = [&](int root) {
    int s = root;
    while (weight[at(s)] > 0.7 * weight[at(root)]) {
      int heaviest = -1;
      double second = 0;
      for (int c = children.first[at(s)]; c >= 0; c = children.next[at(c)]) {
        if (heaviest < 0 || weight[at(c)] > weight[at(heaviest)]) {
          if (heaviest >= 0) second = std::max(second, weight[at(heaviest)]);
          heaviest = c;
        } else {
          second = std::max(second, weight[at(c)]);
        }
      }
      if (heaviest < 0) return -1;
      if (second > std::max(kSmallestSubtree, 0.1 * weight[at(root)])) return s;
      s = heaviest;
    }
    return -1;
  };
  std::vector<int> roots;
  for (int s = 0; s < n; ++s) {
    if (parent[at(s)] < 0 && weight[at(s)] >= kSmallestSubtree) roots.push_back(s);
  }
  while (roots.size() < kMostSubtrees) {
    std::sort(roots.begin(), roots.end(), [&](int a, int b) { return weight[at(a)] > weight[at(b)]; });
    std::size_t opened = 0;
    int at_branch = -1;
    while (opened < roots.size() && at_branch < 0) {
      at_branch = branching(roots[opened]);
      if (at_branch < 0) ++opened;
    }
    if (at_branch < 0) break;
    std::vector<int> parts;
    for (int s = at_branch; s >= 0 && s != roots[opened]; s = parent[at(s)]) {
      const int up = parent[at(s)];
      for (int c = children.first[at(up)]; c >= 0; c = children.next[at(c)]) {
        if (c != s) parts.push_back(c);
      }
    }
    for (int c = children.first[at(at_branch)]; c >= 0; c = children.next[at(c)]) parts.push_back(c);
    roots.erase(roots.begin() + static_cast<std::ptrdiff_t>(opened));
    for (const int part : parts) {
      if (weight[at(part)] >= kSmallestSubtree) roots.push_back(part);
    }
  }
  std::sort(roots.begin(), roots.end());
  std::vector<char> covered(at(n), 0);
  for (const int root : roots) {
    symbolic.subtrees.push_back({first[at(root)], root + 1});
    std::fill(covered.begin() + first[at(root)], covered.begin() + root + 1, char{1});
  }
  for (int s = 0; s < n; ++s) {
    if (!covered[at(s)]) symbolic.top.push_back(s);
  }
}

/// Places of the update matrices: one stack per subtree, and one for the rest. The update of a
/// front is computed above those of its children, and then moved to the begin of the first of them.
class UpdateStack {
 public:
  explicit UpdateStack(std::int64_t base) : top_(base), peak_(base) {}

  void place(std::vector<Supernode>& nodes, int s) {
    Supernode& node = nodes[at(s)];
    const auto size = std::int64_t{node.update_stride()} * node.below;
    peak_ = std::max(peak_, top_ + size);
    node.assembly = top_;
    while (!open_.empty() && nodes[at(open_.back())].parent == s) {
      top_ = nodes[at(open_.back())].update;
      open_.pop_back();
    }
    node.update = top_;
    top_ += size;
    open_.push_back(s);
  }
  [[nodiscard]] std::int64_t peak() const { return peak_; }

 private:
  std::vector<int> open_;
  std::int64_t top_;
  std::int64_t peak_;
};

void place_updates(BlockSymbolic& symbolic) {
  std::int64_t size = 0;
  for (const Subtree& subtree : symbolic.subtrees) {
    UpdateStack stack(size);
    for (int s = subtree.first; s < subtree.last; ++s) stack.place(symbolic.nodes, s);
    size = stack.peak();
  }
  UpdateStack stack(size);
  for (const int s : symbolic.top) stack.place(symbolic.nodes, s);
  symbolic.update_size = stack.peak();
  for (Supernode& node : symbolic.nodes) {
    node.vector = symbolic.vector_size;
    symbolic.vector_size += node.below;
  }
}

}  // namespace

BlockSymbolic analyze_blocks(const BlockPattern& pattern) {
  if (pattern.value_count() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("the normal equations have more numbers than the block Cholesky can index");
  }
  BlockSymbolic symbolic;
  std::vector<int> old_parent = elimination_tree(pattern);
  symbolic.column = twisted_postorder(pattern, old_parent);
  std::vector<int> place(symbolic.column.size());
  for (std::size_t k = 0; k < place.size(); ++k) place[at(symbolic.column[k])] = static_cast<int>(k);
  std::vector<int> parent(place.size(), -1);
  symbolic.start.assign(1, 0);
  for (std::size_t k = 0; k < place.size(); ++k) {
    const auto j = at(symbolic.column[k]);
    if (old_parent[j] >= 0) parent[k] = place[at(old_parent[j])];
    symbolic.size.push_back(pattern.size[j]);
    symbolic.outside.push_back(pattern.start[j]);
    symbolic.start.push_back(symbolic.start.back() + pattern.size[j]);
  }
  const LowerBlocks lower = lower_blocks(pattern, place);
  const FactorColumns factor = factor_columns(lower, parent);
  symbolic.nodes = find_supernodes(symbolic, factor, parent);
  Layout(pattern, lower, factor, parent, symbolic).run();
  find_subtrees(symbolic);
  place_updates(symbolic);
  return symbolic;
}

}  // namespace waymark

/// Patterns of every kind that the analysis of the block Cholesky distinguishes: short and long
/// chains, chains with leaves, separate parts, trees, grids, dense columns, mixed sizes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "support/block_matrices.hpp"

namespace waymark_test {

/// A pattern under construction: nodes with sizes, joined in any order and then eliminated
/// in any order.
struct Shape {
  std::string name;
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> joined;

  int add(int size) {
    sizes.push_back(size);
    return static_cast<int>(sizes.size()) - 1;
  }
  void join(int a, int b) {
    if (a != b) joined.emplace_back(a, b);
  }
  /// Appends a chain and returns its first node.
  int add_chain(int length, int size = 3) {
    const int first = add(size);
    for (int i = 1; i < length; ++i) join(first + i - 1, add(size));
    return first;
  }

  [[nodiscard]] waymark::BlockPattern pattern() const {
    Pairs pairs;
    for (const auto& [a, b] : joined) pairs.insert({std::min(a, b), std::max(a, b)});
    return make_pattern(sizes, pairs);
  }
  /// Returns the same matrix with a random order of elimination. Some stored blocks are
  /// then transposed.
  [[nodiscard]] Shape shuffled(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::vector<int> place(sizes.size());
    std::iota(place.begin(), place.end(), 0);
    std::shuffle(place.begin(), place.end(), random);
    Shape result{name + ", shuffled", std::vector<int>(sizes.size()), {}};
    for (std::size_t i = 0; i < sizes.size(); ++i)
      result.sizes[static_cast<std::size_t>(place[i])] = sizes[i];
    for (const auto& [a, b] : joined)
      result.join(place[static_cast<std::size_t>(a)], place[static_cast<std::size_t>(b)]);
    return result;
  }
};

[[nodiscard]] inline Shape chain(int length) {
  Shape shape{"chain of " + std::to_string(length), {}, {}};
  shape.add_chain(length);
  return shape;
}

/// Each leaf comes just before the node it is joined to, like the GNSS nodes of a drive.
[[nodiscard]] inline Shape chain_with_leaves(int length, int every, int leaf_size) {
  Shape shape{"chain of " + std::to_string(length) + " with leaves of " + std::to_string(leaf_size), {}, {}};
  int last = -1;
  for (int i = 0; i < length; ++i) {
    const int leaf = i % every == 0 ? shape.add(leaf_size) : -1;
    const int link = shape.add(3);
    if (leaf >= 0) shape.join(leaf, link);
    if (last >= 0) shape.join(last, link);
    last = link;
  }
  return shape;
}

[[nodiscard]] inline Shape tree(int nodes, std::uint64_t seed, bool mixed) {
  Shape shape{std::string("random tree") + (mixed ? " of mixed sizes" : ""), {}, {}};
  std::mt19937_64 random(seed);
  for (int i = 0; i < nodes; ++i) shape.add(mixed ? 1 + static_cast<int>(random() % 6) : 3);
  for (int i = 0; i + 1 < nodes; ++i)
    shape.join(i, i + 1 + static_cast<int>(random() % static_cast<unsigned>(nodes - i - 1)));
  return shape;
}

[[nodiscard]] inline Shape grid(int side) {
  Shape shape{"grid of " + std::to_string(side), {}, {}};
  for (int i = 0; i < side * side; ++i) {
    shape.add(3);
    if (i % side > 0) shape.join(i - 1, i);
    if (i >= side) shape.join(i - side, i);
  }
  return shape;
}

[[nodiscard]] inline Shape with_dense_columns(Shape shape, int columns) {
  shape.name += " with dense columns";
  const int others = static_cast<int>(shape.sizes.size());
  for (int c = 0; c < columns; ++c) {
    const int dense = shape.add(1 + c % 4);
    for (int i = 0; i < dense; ++i)
      if (i >= others || i % 3 != c) shape.join(i, dense);
  }
  return shape;
}

[[nodiscard]] inline Shape random_shape(int blocks, int extra, std::uint64_t seed) {
  Shape shape{"random of mixed sizes", {}, {}};
  std::mt19937_64 random(seed);
  for (int i = 0; i < blocks; ++i) shape.add(1 + static_cast<int>(random() % 6));
  for (int i = 0; i < extra; ++i) {
    shape.join(static_cast<int>(random() % static_cast<unsigned>(blocks)),
               static_cast<int>(random() % static_cast<unsigned>(blocks)));
  }
  return shape;
}

[[nodiscard]] inline std::vector<Shape> all_shapes() {
  std::vector<Shape> shapes;
  shapes.push_back({"empty", {}, {}});
  for (int size = 1; size <= 6; ++size) shapes.push_back({"one block", {size}, {}});
  shapes.push_back({"one block of 45", {45}, {}});
  for (const int length : {2, 3, 4, 63, 64, 65, 126, 127, 128, 129, 200}) shapes.push_back(chain(length));
  for (const int size : {1, 2, 4, 6}) {
    Shape other{"chain of blocks of " + std::to_string(size), {}, {}};
    other.add_chain(80, size);
    shapes.push_back(other);
  }
  shapes.push_back(chain_with_leaves(40, 5, 3));
  shapes.push_back(chain_with_leaves(150, 7, 3));
  shapes.push_back(chain_with_leaves(150, 1, 3));
  shapes.push_back(chain_with_leaves(90, 4, 2));
  shapes.push_back(tree(100, 1, false));
  shapes.push_back(tree(60, 2, true));
  shapes.push_back(grid(7));
  shapes.push_back(with_dense_columns(grid(5), 3));
  shapes.push_back(with_dense_columns(chain(140), 1));
  shapes.push_back(with_dense_columns(chain_with_leaves(60, 6, 3), 4));

  Shape components{"several components", {}, {}};
  for (const int length : {1, 70, 2, 130, 40}) components.add_chain(length);
  components.add(5);
  shapes.push_back(components);

  Shape star{"three long arms at one node", {}, {}};
  const int centre = star.add(3);
  for (int arm = 0; arm < 3; ++arm) star.join(star.add_chain(70), centre);
  shapes.push_back(star);

  Shape ring{"ring", {}, {}};
  ring.add_chain(150);
  ring.join(0, 149);
  shapes.push_back(ring);

  Shape closures{"chain with closures", {}, {}};
  closures.add_chain(160);
  for (int i = 0; i < 150; i += 15) closures.join(i, i + 9);
  shapes.push_back(closures);

  Shape tail{"long tail at a clique", {}, {}};
  const int clique = tail.add_chain(12);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < i; ++j) tail.join(clique + j, clique + i);
  }
  tail.join(tail.add_chain(120), clique + 5);
  shapes.push_back(tail);

  Shape interrupted{"chain interrupted by blocks of 2", {}, {}};
  for (int i = 0; i < 150; ++i) {
    interrupted.add(i % 40 == 20 ? 2 : 3);
    if (i > 0) interrupted.join(i - 1, i);
  }
  shapes.push_back(interrupted);
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    shapes.push_back(random_shape(30, 10 * static_cast<int>(seed), seed));

  const std::size_t plain = shapes.size();
  for (std::size_t i = 0; i < plain; ++i) {
    if (shapes[i].sizes.size() > 1) shapes.push_back(shapes[i].shuffled(17 + i));
  }
  return shapes;
}

/// Returns problems with enough work for several subtrees.
[[nodiscard]] inline std::vector<Shape> large_shapes() {
  std::vector<Shape> shapes;
  shapes.push_back(chain(6000));
  shapes.push_back(chain_with_leaves(6000, 25, 3));
  shapes.push_back(with_dense_columns(chain(3000), 1));
  Shape components{"chains of many lengths", {}, {}};
  for (int length = 100; length < 2500; length += 400) components.add_chain(length);
  shapes.push_back(components);
  Shape comb{"chains that end in a grid", {}, {}};
  for (int arm = 0; arm < 7; ++arm) comb.add_chain(900 + 50 * arm);
  const int first = static_cast<int>(comb.sizes.size());
  int end = -1;
  for (int i = 0; i < 49; ++i) {
    comb.add(3);
    if (i % 7 > 0) comb.join(first + i - 1, first + i);
    if (i >= 7) comb.join(first + i - 7, first + i);
    if (i % 7 == 3) {
      end += 900 + 50 * (i / 7);
      comb.join(end, first + i);
    }
  }
  shapes.push_back(comb);
  return shapes;
}

}  // namespace waymark_test

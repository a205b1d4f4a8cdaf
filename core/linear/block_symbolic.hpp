/// Symbolic analysis of the block Cholesky factorisation: elimination tree, supernodes, where everything
/// goes.
#pragma once

#include <cstdint>
#include <vector>

#include <waymark/core/linear/block_pattern.hpp>

namespace waymark {

/// Where one block of the matrix goes in the panel of its supernode.
struct BlockEntry {
  std::uint32_t source = 0;  ///< first number of the block among the matrix's numbers
  std::int32_t stride = 0;   ///< between its columns
  std::int32_t target = 0;   ///< first number within the panel
  std::uint16_t rows = 0;    ///< of the stored block
  std::uint16_t columns = 0;
  bool transposed = false;  ///< whether the panel takes the transpose
};

/// One link of a chain: a block column of three with one block of three rows below it.
struct ChainLink {
  std::uint32_t diagonal = 0;  ///< first number of its diagonal block among the matrix's numbers
  std::uint32_t below = 0;     ///< of the block that joins it to the next
  std::int32_t diagonal_stride = 0;
  std::int32_t below_stride = 0;  ///< negative: stored is the transpose
};

/// Block columns that are factorised together. Either a dense front: the panel has the supernode's own
/// columns and, as rows, first these columns and then the later ones that they reach. Or a chain: links one
/// after the other, each reaching only the next, the last the parent.
struct Supernode {
  static constexpr int kLinkSize = 3;      ///< scalar size of a link: poses of the plane
  static constexpr int kLinkNumbers = 15;  ///< factor of a link: 3 pivots, 3 below them, 9 towards the next

  int first = 0;         ///< first block column, in the order of BlockSymbolic::column
  int last = 0;          ///< behind the last block column
  int links = 0;         ///< of a chain; 0: a dense front
  int columns = 0;       ///< scalar columns
  int below = 0;         ///< scalar rows below them
  int stride = 0;        ///< between columns of the panel of a dense front, numbers
  int parent = -1;       ///< supernode that takes its update; -1: none
  int first_child = -1;  ///< supernodes whose update it takes, ascending by next_sibling
  int next_sibling = -1;
  int row_count = 0;      ///< block rows below
  std::int64_t rows = 0;  ///< begin of its block rows in BlockSymbolic::rows, and in `position`
  std::int64_t entries =
      0;  ///< begin of its blocks of the matrix: in BlockSymbolic::entries or BlockSymbolic::links
  std::int64_t entries_end = 0;
  std::int64_t start = 0;     ///< first scalar column, in the order of BlockSymbolic::column
  std::int64_t panel = 0;     ///< begin of its numbers in the factor
  std::int64_t assembly = 0;  ///< where its update matrix is made in the workspace
  std::int64_t update = 0;    ///< and where it is then kept for the parent
  std::int64_t vector = 0;    ///< begin of its update vector in the workspace of a solve

  /// Between columns of the update matrix: whole vector registers.
  [[nodiscard]] int update_stride() const { return (below + 3) / 4 * 4; }
};

/// A range of supernodes that depends on nothing outside: a subtree, its members in postorder.
struct Subtree {
  int first = 0;
  int last = 0;  ///< behind the root
};

/// Everything that depends on the pattern alone.
///
/// The order given is kept up to equivalence: a postorder of its elimination tree, so that subtrees are
/// contiguous. A chain that ends at a root is eliminated from both ends towards its middle, which needs no
/// more numbers and gives two independent halves (in numerical terms a twisted factorisation).
struct BlockSymbolic {
  std::vector<int> column;  ///< column[k] is the pattern's block column that is eliminated as number k
  std::vector<int> size;    ///< scalar columns of each, in this order
  std::vector<std::int64_t> start;    ///< first scalar of each, in this order; one more at the end
  std::vector<std::int64_t> outside;  ///< first scalar of each in the pattern's order
  std::vector<Supernode> nodes;       ///< in postorder
  std::vector<int> rows;              ///< block rows below, per supernode ascending
  std::vector<int> position;          ///< for each of them its first row in the front of the parent
  std::vector<BlockEntry> entries;    ///< of dense fronts
  std::vector<ChainLink> links;       ///< of chains
  std::vector<Subtree> subtrees;      ///< disjoint; nodes in none of them come after all of them
  std::vector<int> top;               ///< those nodes, ascending
  std::int64_t factor_size = 0;       ///< numbers in all panels
  std::int64_t update_size = 0;       ///< numbers of workspace that a factorisation needs
  std::int64_t vector_size = 0;       ///< numbers of workspace that a solve needs
  int largest_front = 0;              ///< scalar rows of the largest front
};

/// @throws std::length_error where the matrix has more than 2^32 - 1 numbers.
[[nodiscard]] BlockSymbolic analyze_blocks(const BlockPattern& pattern);

}  // namespace waymark

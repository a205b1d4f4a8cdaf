/// Symbolic analysis of the block Cholesky factorisation: elimination tree, supernodes, and the
/// places of all numbers.
///
/// It is a plain value without a reference to the pattern.
#pragma once

#include <cstdint>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/block_pattern.hpp>

namespace WAYMARK_EXPORT waymark {

/// The place of one block of the matrix in the panel of its supernode.
struct BlockEntry {
  /// first number of the block, as an index into the numbers of the matrix
  std::uint32_t source = 0;
  std::int32_t stride = 0;  ///< distance between its columns
  std::int32_t target = 0;  ///< first number within the panel
  std::uint16_t rows = 0;   ///< of the stored block
  std::uint16_t columns = 0;
  bool transposed = false;  ///< the panel takes the transpose
};

/// One link of a chain: a block column of three with one block of three rows below it.
struct ChainLink {
  /// first number of its diagonal block, as an index into the numbers of the matrix
  std::uint32_t diagonal = 0;
  std::uint32_t below = 0;  ///< first number of the block that joins it to the next link
  std::int32_t diagonal_stride = 0;
  std::int32_t below_stride = 0;  ///< negative: the transpose is stored
};

/// Block columns that are factorised together, as a dense front or as a chain. The panel of a dense
/// front has the columns of the supernode. Its rows are first these columns and then the later ones
/// that they reach. A chain has links one after the other. Each link reaches only the next one, and
/// the last one reaches the parent.
struct Supernode {
  static constexpr int kLinkSize = 3;  ///< scalar size of a link: poses of the plane
  /// factor of a link: 3 pivots, 3 below them, 9 towards the next
  static constexpr int kLinkNumbers = 15;

  int first = 0;    ///< first block column, in the order of BlockSymbolic::column
  int last = 0;     ///< one after the last block column
  int links = 0;    ///< links of a chain; 0: a dense front
  int columns = 0;  ///< scalar columns
  int below = 0;    ///< scalar rows below them
  int stride = 0;   ///< distance between columns of the panel of a dense front, in numbers
  int parent = -1;  ///< supernode that receives its update; -1: none
  /// first supernode whose update it receives; the others follow in ascending order by next_sibling
  int first_child = -1;
  int next_sibling = -1;
  int row_count = 0;      ///< number of block rows below
  std::int64_t rows = 0;  ///< begin of its block rows in BlockSymbolic::rows, and in `position`
  std::int64_t entries =
      0;  ///< begin of its matrix blocks, in BlockSymbolic::entries or BlockSymbolic::links
  std::int64_t entries_end = 0;
  std::int64_t start = 0;     ///< first scalar column, in the order of BlockSymbolic::column
  std::int64_t panel = 0;     ///< begin of its numbers in the factor
  std::int64_t assembly = 0;  ///< place in the workspace where its update matrix is computed
  /// place in the workspace where the update matrix waits for the parent
  std::int64_t update = 0;
  std::int64_t vector = 0;  ///< begin of its update vector in the workspace of a solve

  /// Returns the distance between columns of the update matrix, rounded up to whole
  /// vector registers.
  [[nodiscard]] int update_stride() const { return (below + 3) / 4 * 4; }
};

/// A range of supernodes that depends on nothing outside: a subtree with its members in postorder.
struct Subtree {
  int first = 0;
  int last = 0;  ///< one after the root
};

/// The part of the factorisation that depends only on the pattern.
///
/// The given order is kept up to equivalence: a postorder of its elimination tree makes subtrees
/// contiguous. A chain that ends at a root is eliminated from both ends towards its middle. This
/// needs no more numbers and gives two independent halves (numerically a twisted factorisation).
struct BlockSymbolic {
  std::vector<int> column;  ///< block column column[k] of the pattern is eliminated as number k
  std::vector<int> size;    ///< scalar columns of each, in this order
  /// first scalar of each in this order, and the end of the last one
  std::vector<std::int64_t> start;
  std::vector<std::int64_t> outside;  ///< first scalar of each in the order of the pattern
  std::vector<Supernode> nodes;       ///< in postorder
  std::vector<int> rows;              ///< block rows below each supernode, ascending
  /// for each of them, its first row in the front of the parent
  std::vector<int> position;
  std::vector<BlockEntry> entries;  ///< of dense fronts
  std::vector<ChainLink> links;     ///< of chains
  std::vector<Subtree> subtrees;    ///< disjoint; a node in none of them comes after all of them
  std::vector<int> top;             ///< these nodes, ascending
  std::int64_t factor_size = 0;     ///< numbers in all panels
  std::int64_t update_size = 0;     ///< numbers of workspace that a factorisation needs
  std::int64_t vector_size = 0;     ///< numbers of workspace that a solve needs
  int largest_front = 0;            ///< scalar rows of the largest front
};

/// @throws std::length_error if the matrix has more than 2^32 - 1 numbers
[[nodiscard]] BlockSymbolic analyze_blocks(const BlockPattern& pattern);

}  // namespace waymark

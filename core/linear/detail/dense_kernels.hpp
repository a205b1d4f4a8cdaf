/// Dense kernels of the block Cholesky. They are compiled for several vector widths, and the
/// processor decides once which are used. All matrices are column-major. If a stride says so, rows
/// are rounded up to whole registers.
#pragma once

#include <span>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Lower triangles are input and output. Entries above diagonals are arbitrary.
struct DenseKernels {
  /// Factorises the first `columns` columns of a front of `rows` rows in place. The result is L
  /// with the reciprocals of its diagonal. @param stride a multiple of 4, >= rows
  /// @return 0, or 1 + the column whose pivot is not positive and finite
  int (*factorize_panel)(double* panel, int rows, int columns, int stride);
  /// Computes the lower triangle of update -= B B^T. B has `rows` rows and `columns` columns. It
  /// reads up to 4 numbers after a column of B, and writes rows up to the next multiple of 4.
  /// @param update_stride a multiple of 4, >= rows
  void (*subtract_product)(const double* b, int stride, int rows, int columns, double* update,
                           int update_stride);
  const char* name;  ///< "portable", "avx2", "avx512"
};

/// Returns all kernels that this processor can run, the widest last. The portable ones are
/// always there.
[[nodiscard]] std::span<const DenseKernels> all_dense_kernels();
/// Returns the widest of them.
[[nodiscard]] const DenseKernels& dense_kernels();

}  // namespace waymark

/// Dense kernels of the block Cholesky, compiled for several vector widths and chosen once by what the
/// processor has. All matrices are column-major; rows are rounded up to whole registers where a stride says
/// so.
#pragma once

#include <span>

namespace waymark {

/// Lower triangles are in and out; what stands above diagonals is arbitrary.
struct DenseKernels {
  /// Factorises the first `columns` columns of a front of `rows` rows in place: L with the reciprocals of its
  /// diagonal. @param stride a multiple of 4, >= rows. Returns 0, or 1 + the column whose pivot is not
  /// positive and finite.
  int (*factorize_panel)(double* panel, int rows, int columns, int stride);
  /// update -= B B^T, lower triangle, B of `rows` rows and `columns` columns. Reads up to 4 numbers behind a
  /// column of B, writes rows up to the next multiple of 4. @param update_stride a multiple of 4, >= rows
  void (*subtract_product)(const double* b, int stride, int rows, int columns, double* update,
                           int update_stride);
  const char* name;  ///< "portable", "avx2", "avx512"
};

/// All that this processor runs, the widest last; the portable one is always there.
[[nodiscard]] std::span<const DenseKernels> all_dense_kernels();
/// The widest of them.
[[nodiscard]] const DenseKernels& dense_kernels();

}  // namespace waymark

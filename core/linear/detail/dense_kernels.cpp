#include <cmath>
#include <cstring>
#include <limits>

#include <waymark/core/base/detail/processor.hpp>
#include <waymark/core/linear/detail/dense_kernels.hpp>

// All functions below are inlined into functions that are compiled for one instruction set each.
#define WAYMARK_INLINE [[gnu::always_inline]] inline

namespace waymark {
namespace {

/// W numbers in a register. GCC and clang split it if the instruction set has only shorter ones.
template <int W>
struct Register {
  using Type [[gnu::vector_size(W * sizeof(double))]] = double;
  /// The same numbers in memory, which are aligned as single ones. Not for variables: clang forgets
  /// the alignment of an element of an array of it, and takes it for that of Type.
  using InMemory [[gnu::vector_size(W * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] =
      double;
};

template <int W>
WAYMARK_INLINE void load(const double* from, typename Register<W>::Type& to) {
  to = *reinterpret_cast<const typename Register<W>::InMemory*>(from);
}

template <int W>
WAYMARK_INLINE void store(const typename Register<W>::Type& from, double* to) {
  *reinterpret_cast<typename Register<W>::InMemory*>(to) = from;
}

/// Computes a tile of 4 columns and R registers of rows: c -= a b^T, over `depth` columns. Only the
/// first `width` columns are stored.
template <int W, int R>
WAYMARK_INLINE void subtract_tile(const double* a, const double* b, int stride, int depth, double* c,
                                  int c_stride, int width) {
  using V = typename Register<W>::Type;
  V sum[4][R] = {};
  for (int k = 0; k < depth; ++k, a += stride, b += stride) {
    V row[R];
    for (int r = 0; r < R; ++r) load<W>(a + r * W, row[r]);
    for (int j = 0; j < 4; ++j) {
      for (int r = 0; r < R; ++r) sum[j][r] += row[r] * b[j];
    }
  }
  for (int j = 0; j < 4; ++j) {
    if (j >= width) break;
    for (int r = 0; r < R; ++r) {
      V old;
      load<W>(c + j * c_stride + r * W, old);
      store<W>(old - sum[j][r], c + j * c_stride + r * W);
    }
  }
}

/// Computes rows [0, rows) of at most four columns. The number of rows is rounded up to a
/// multiple of 4.
template <int W>
WAYMARK_INLINE void subtract_columns(const double* a, const double* b, int stride, int depth, double* c,
                                     int c_stride, int rows, int width) {
  int i = 0;
  for (; i + 2 * W <= rows; i += 2 * W) subtract_tile<W, 2>(a + i, b, stride, depth, c + i, c_stride, width);
  if constexpr (W > 4) {
    for (; i + W <= rows; i += W) subtract_tile<W, 1>(a + i, b, stride, depth, c + i, c_stride, width);
  }
  for (; i < rows; i += 4) {
    if constexpr (W >= 4) {
      subtract_tile<4, 1>(a + i, b, stride, depth, c + i, c_stride, width);
    } else {
      subtract_tile<2, 2>(a + i, b, stride, depth, c + i, c_stride, width);
    }
  }
}

/// Factorises the diagonal block of up to four columns, with reciprocals on the diagonal.
WAYMARK_INLINE int factorize_diagonal(double* block, int size, int stride) {
  for (int j = 0; j < size; ++j) {
    double pivot = block[j + j * stride];
    for (int k = 0; k < j; ++k) pivot -= block[j + k * stride] * block[j + k * stride];
    if (!(pivot > 0 && pivot <= std::numeric_limits<double>::max())) return 1 + j;
    const double reciprocal = 1 / std::sqrt(pivot);
    block[j + j * stride] = reciprocal;
    for (int i = j + 1; i < size; ++i) {
      double sum = block[i + j * stride];
      for (int k = 0; k < j; ++k) sum -= block[i + k * stride] * block[j + k * stride];
      block[i + j * stride] = sum * reciprocal;
    }
  }
  return 0;
}

/// Solves W rows below the diagonal block: x L^T = c, column by column.
template <int W>
WAYMARK_INLINE void solve_rows(const double* block, int size, int stride, double* rows) {
  using V = typename Register<W>::Type;
  V x[4];
  for (int j = 0; j < 4; ++j) {
    if (j >= size) break;
    load<W>(rows + j * stride, x[j]);
    for (int k = 0; k < j; ++k) x[j] -= x[k] * block[j + k * stride];
    x[j] *= block[j + j * stride];
    store<W>(x[j], rows + j * stride);
  }
}

template <int W>
WAYMARK_INLINE int factorize_panel(double* panel, int rows, int columns, int stride) {
  for (int j = 0; j < columns; j += 4) {
    const int width = columns - j < 4 ? columns - j : 4;
    double* block = panel + j + j * stride;
    if (j > 0) subtract_columns<W>(panel + j, panel + j, stride, j, block, stride, rows - j, width);
    if (const int bad = factorize_diagonal(block, width, stride)) return j + bad;
    int i = width;
    const int behind = stride - j;  // rows of this column
    for (; i < rows - j && i + W <= behind; i += W) solve_rows<W>(block, width, stride, block + i);
    if constexpr (W > 2) {
      for (; i < rows - j && i + 2 <= behind; i += 2) solve_rows<2>(block, width, stride, block + i);
    }
    for (; i < rows - j; ++i) solve_rows<1>(block, width, stride, block + i);
  }
  return 0;
}

template <int W>
WAYMARK_INLINE void subtract_product(const double* b, int stride, int rows, int columns, double* update,
                                     int update_stride) {
  for (int j = 0; j < rows; j += 4) {
    const int width = rows - j < 4 ? rows - j : 4;
    subtract_columns<W>(b + j, b + j, stride, columns, update + j + j * update_stride, update_stride,
                        rows - j, width);
  }
}

// Defines a pair of functions for an instruction set.
#define WAYMARK_KERNELS(name, attribute, width)                                                              \
  attribute int factorize_panel_##name(double* panel, int rows, int columns, int stride) {                   \
    return factorize_panel<width>(panel, rows, columns, stride);                                             \
  }                                                                                                          \
  attribute void subtract_product_##name(const double* b, int stride, int rows, int columns, double* update, \
                                         int update_stride) {                                                \
    subtract_product<width>(b, stride, rows, columns, update, update_stride);                                \
  }

WAYMARK_KERNELS(portable, , 2)
#if defined(__x86_64__)
WAYMARK_KERNELS(avx2, __attribute__((target("avx2,fma"))), 4)
WAYMARK_KERNELS(avx512, __attribute__((target("avx512f,avx512vl,avx2,fma"))), 8)
#endif

#if defined(__x86_64__)
constexpr DenseKernels kKernels[] = {
    {&factorize_panel_portable, &subtract_product_portable, "portable"},
    {&factorize_panel_avx2, &subtract_product_avx2, "avx2"},
    {&factorize_panel_avx512, &subtract_product_avx512, "avx512"},
};
#else
constexpr DenseKernels kKernels[] = {{&factorize_panel_portable, &subtract_product_portable, "portable"}};
#endif

}  // namespace

std::span<const DenseKernels> all_dense_kernels() {
  std::size_t count = 1;
  if (has_fused_multiply()) count = 2;
  if (has_wide_vectors()) count = 3;
  return {kKernels, count};
}

const DenseKernels& dense_kernels() {
  return all_dense_kernels().back();
}

}  // namespace waymark

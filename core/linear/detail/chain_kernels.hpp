/// Kernels for the links of a chain: blocks of 3 x 3, each joined only to the next.
///
/// A link is factorised as L D L^T (one division per pivot, no square root), because a long chain
/// waits for the latency of a link. The kernels work on one number or on a pair. A pair processes
/// two independent chains at once and hides half of that latency. Both do the same operations in
/// the same order, so the choice does not change results. This file must be compiled without
/// contraction of products and sums.
#pragma once

#include <array>
#include <limits>

namespace waymark {

/// Two numbers in one register.
using NumberPair [[gnu::vector_size(16)]] = double;

/// The update that a link passes to the next one: a lower triangle, column by column, to
/// be subtracted.
template <typename T>
using LinkUpdate = std::array<T, 6>;

/// The factor of a link as it is stored, column by column: reciprocal pivots r, L below them (unit
/// diagonal), and G = B L^-T D^-1 of the block B towards the next link. r0 l10 l20 g00 g10 g20  r1
/// l21 g01 g11 g21  r2 g02 g12 g22.
template <typename T>
using LinkFactor = std::array<T, 15>;
/// The places of r0, r1, r2 in it.
inline constexpr std::array<unsigned, 3> kLinkPivots = {0, 6, 11};

/// @param diagonal lower triangle, column by column
/// @param below B, column by column
/// @param carry in: the update of earlier links; out: the update of this one
/// @param pivots the three pivots
template <typename T>
[[gnu::always_inline]] inline void factorize_link(const std::array<T, 6>& diagonal,
                                                  const std::array<T, 9>& below, LinkUpdate<T>& carry,
                                                  LinkFactor<T>& factor, std::array<T, 3>& pivots) {
  const T d00 = diagonal[0] - carry[0];
  const T d10 = diagonal[1] - carry[1];
  const T d20 = diagonal[2] - carry[2];
  const T r0 = 1.0 / d00;
  const T l10 = d10 * r0;
  const T l20 = d20 * r0;
  const T d11 = (diagonal[3] - carry[3]) - l10 * d10;
  const T d21 = (diagonal[4] - carry[4]) - l20 * d10;
  const T r1 = 1.0 / d11;
  const T l21 = d21 * r1;
  const T d22 = ((diagonal[5] - carry[5]) - l20 * d20) - l21 * d21;
  const T r2 = 1.0 / d22;
  pivots = {d00, d11, d22};
  std::array<T, 9> b;  // B L^-T
  std::array<T, 9> g;
  for (unsigned row = 0; row < 3; ++row) {
    b[row] = below[row];
    b[row + 3] = below[row + 3] - b[row] * l10;
    b[row + 6] = (below[row + 6] - b[row] * l20) - b[row + 3] * l21;
    g[row] = b[row] * r0;
    g[row + 3] = b[row + 3] * r1;
    g[row + 6] = b[row + 6] * r2;
  }
  unsigned at = 0;
  for (unsigned c = 0; c < 3; ++c) {
    for (unsigned row = c; row < 3; ++row) {
      carry[at++] = (g[row] * b[c] + g[row + 3] * b[c + 3]) + g[row + 6] * b[c + 6];
    }
  }
  factor = {r0, l10, l20, g[0], g[1], g[2], r1, l21, g[3], g[4], g[5], r2, g[6], g[7], g[8]};
}

/// Forward substitution: x = D^-1 L^-1 (b + carry). carry becomes the term for the right side of
/// the next link.
template <typename T>
[[gnu::always_inline]] inline void solve_link(const LinkFactor<T>& f, const std::array<T, 3>& b,
                                              std::array<T, 3>& carry, std::array<T, 3>& x) {
  const T y0 = b[0] + carry[0];
  const T y1 = (b[1] + carry[1]) - f[1] * y0;
  const T y2 = ((b[2] + carry[2]) - f[2] * y0) - f[7] * y1;
  carry[0] = -((f[3] * y0 + f[8] * y1) + f[12] * y2);
  carry[1] = -((f[4] * y0 + f[9] * y1) + f[13] * y2);
  carry[2] = -((f[5] * y0 + f[10] * y1) + f[14] * y2);
  x = {y0 * f[0], y1 * f[6], y2 * f[11]};
}

/// Backward substitution: x = L^-T (x - G^T next). next is the solution of the next link,
/// and becomes x.
template <typename T>
[[gnu::always_inline]] inline void solve_link_back(const LinkFactor<T>& f, std::array<T, 3>& next,
                                                   std::array<T, 3>& x) {
  const T t0 = x[0] - ((f[3] * next[0] + f[4] * next[1]) + f[5] * next[2]);
  const T t1 = x[1] - ((f[8] * next[0] + f[9] * next[1]) + f[10] * next[2]);
  const T t2 = x[2] - ((f[12] * next[0] + f[13] * next[1]) + f[14] * next[2]);
  const T x1 = t1 - f[7] * t2;
  const T x0 = (t0 - f[1] * x1) - f[2] * t2;
  x = {x0, x1, t2};
  next = x;
}

/// A symmetric block of three, its lower triangle column by column.
using LinkInverse = std::array<double, 6>;

/// Computes the block of the inverse for a link from that of the next link. With M = L^-T G^T, the
/// unknowns of the link are -M times those of the next link plus an independent part. So Z := L^-T
/// D^-1 L^-1 + M Z M^T. Entries that only zeros couple stay exactly zero.
[[gnu::always_inline]] inline void invert_link(const double* f, LinkInverse& z) {
  const double m20 = f[12];
  const double m21 = f[13];
  const double m22 = f[14];
  const double m10 = f[8] - f[7] * m20;
  const double m11 = f[9] - f[7] * m21;
  const double m12 = f[10] - f[7] * m22;
  const double m00 = (f[3] - f[2] * m20) - f[1] * m10;
  const double m01 = (f[4] - f[2] * m21) - f[1] * m11;
  const double m02 = (f[5] - f[2] * m22) - f[1] * m12;
  // W = M Z
  const double w00 = (m00 * z[0] + m01 * z[1]) + m02 * z[2];
  const double w01 = (m00 * z[1] + m01 * z[3]) + m02 * z[4];
  const double w02 = (m00 * z[2] + m01 * z[4]) + m02 * z[5];
  const double w10 = (m10 * z[0] + m11 * z[1]) + m12 * z[2];
  const double w11 = (m10 * z[1] + m11 * z[3]) + m12 * z[4];
  const double w12 = (m10 * z[2] + m11 * z[4]) + m12 * z[5];
  const double w20 = (m20 * z[0] + m21 * z[1]) + m22 * z[2];
  const double w21 = (m20 * z[1] + m21 * z[3]) + m22 * z[4];
  const double w22 = (m20 * z[2] + m21 * z[4]) + m22 * z[5];
  // U = L^-T, S = U D^-1 U^T
  const double u02 = f[1] * f[7] - f[2];
  const double s02 = u02 * f[11];
  const double s12 = -f[7] * f[11];
  const double s01 = u02 * s12 - f[1] * f[6];
  const double s11 = f[6] - f[7] * s12;
  const double s00 = (f[0] + f[1] * f[1] * f[6]) + u02 * s02;
  z[0] = s00 + ((w00 * m00 + w01 * m01) + w02 * m02);
  z[1] = s01 + ((w10 * m00 + w11 * m01) + w12 * m02);
  z[2] = s02 + ((w20 * m00 + w21 * m01) + w22 * m02);
  z[3] = s11 + ((w10 * m10 + w11 * m11) + w12 * m12);
  z[4] = s12 + ((w20 * m10 + w21 * m11) + w22 * m12);
  z[5] = f[11] + ((w20 * m20 + w21 * m21) + w22 * m22);
}

}  // namespace waymark

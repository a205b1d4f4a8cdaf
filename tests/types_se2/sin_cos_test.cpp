// The inlined sine and cosine against the long double ones of the C library.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/types_se2/detail/sin_cos.hpp>

namespace sin_cos_test {

using namespace waymark;

namespace {

/// The larger of both absolute errors. Angles are doubles, so they are exact in long double.
double error_at(double angle) {
  const SinCos both = sin_cos(angle);
  const auto exact = static_cast<long double>(angle);
  return static_cast<double>(std::max(std::abs(std::sin(exact) - static_cast<long double>(both.sin)),
                                      std::abs(std::cos(exact) - static_cast<long double>(both.cos))));
}

/// The angle is reduced with two roundings of a number below pi/4 (2^-54 each), the result is rounded once
/// (2^-54 near 1), and all terms of the polynomials after the first are below 0.31, so their roundings are
/// below 2^-55 in all: 3.5 * 2^-54 = 1.94e-16 at most; the polynomials' own error is below 1e-18
/// (FDLIBM 5.3).
constexpr double kBound = 1.95e-16;

bool is_even_and_odd(double angle) {
  const SinCos plus = sin_cos(angle);
  const SinCos minus = sin_cos(-angle);
  return plus.cos == minus.cos && plus.sin == -minus.sin;
}

}  // namespace

TEST_CASE("sin_cos: ten million random angles up to 1e5") {
  std::mt19937_64 random(1);
  double largest = 0;
  bool symmetric = true;
  double norm = 0;
  for (const double range : {std::numbers::pi, 100.0, 1e5}) {
    std::uniform_real_distribution<double> angle(-range, range);
    for (int i = 0; i < 3'400'000; ++i) {
      const double x = angle(random);
      largest = std::max(largest, error_at(x));
      symmetric = symmetric && is_even_and_odd(x);
      const SinCos both = sin_cos(x);
      norm = std::max(norm, std::abs(both.sin * both.sin + both.cos * both.cos - 1));
    }
  }
  INFO("largest error " << largest);
  CHECK(largest < kBound);
  CHECK(norm < 4.5e-16);  // a rotation matrix is one to two units in the last place
  CHECK(symmetric);
}

TEST_CASE("sin_cos: near multiples of a quarter of pi, where the angle is reduced and quadrants change") {
  double largest = 0;
  bool symmetric = true;
  for (int k = 0; k <= 127'000; ++k) {
    const double multiple = static_cast<double>(k * (std::numbers::pi_v<long double> / 4));
    if (multiple > 1e5 - 1) break;
    double below = multiple;
    double above = multiple;
    for (int step = 0; step < 4; ++step) {
      for (const double x : {below, above}) {
        largest = std::max(largest, error_at(x));
        symmetric = symmetric && is_even_and_odd(x);
      }
      below = std::nextafter(below, -1.0);
      above = std::nextafter(above, 1e9);
    }
    for (const double offset : {1e-12, 1e-8, 1e-4}) largest = std::max(largest, error_at(multiple + offset));
  }
  INFO("largest error " << largest);
  CHECK(largest < kBound);
  CHECK(symmetric);
}

TEST_CASE("sin_cos: tiny angles are their own sine, to the last digit") {
  for (double x = 1e-9; x > 0; x /= 10) {
    CHECK(sin_cos(x).sin == x);
    CHECK(sin_cos(-x).sin == -x);
    CHECK(sin_cos(x).cos == 1);
  }
  CHECK(sin_cos(0.0).sin == 0);
  CHECK(sin_cos(0.0).cos == 1);
  for (double x = 1e-8; x < 0.7; x *= 1.0001) {
    const auto exact = static_cast<double>(std::sin(static_cast<long double>(x)));
    CHECK_FALSE(std::abs(sin_cos(x).sin - exact) > 2.3e-16 * exact);  // relative, not only absolute
  }
}

TEST_CASE("sin_cos: beyond 1e5 those of the C library, NaN and infinity are NaN") {
  for (const double x : {1e5, -1e5, 123456.789, 1e9, -1e22, 1e300}) {
    CHECK(sin_cos(x).sin == std::sin(x));
    CHECK(sin_cos(x).cos == std::cos(x));
  }
  CHECK(error_at(std::nextafter(1e5, 0)) < kBound);
  for (const double x :
       {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    CHECK(std::isnan(sin_cos(x).sin));
    CHECK(std::isnan(sin_cos(x).cos));
  }
}

}  // namespace sin_cos_test

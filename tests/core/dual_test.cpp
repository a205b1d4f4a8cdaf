// Dual numbers: values of the C++ library, derivatives of the textbook and of central differences.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/dual.hpp>

namespace dual_test {

using waymark::Dual;
using Number = Dual<2>;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The variables x (number 0) and y (number 1).
Number x_at(double value) {
  return Number::variable(value, 0);
}
Number y_at(double value) {
  return Number::variable(value, 1);
}

/// A central difference of fourth order.
template <typename Function>
double difference(const Function& function, double at) {
  constexpr double kStep = 1e-3;
  const auto half = [&](double step) { return (function(at + step) - function(at - step)) / (2 * step); };
  return (4 * half(kStep) - half(2 * kStep)) / 3;
}

/// Compares a function of one number with itself on plain ones, and with its exact derivative.
template <typename Function, typename Slope>
void check_unary(const char* name, const Function& function, const Slope& slope,
                 const std::vector<double>& places) {
  for (const double at : places) {
    INFO(name << " at " << at);
    const Number result = function(Number(at, {1, -2}));
    CHECK(result.value == function(at));
    CHECK(result.derivative[0] == Approx(slope(at)).epsilon(1e-13).margin(1e-300));
    CHECK(result.derivative[1] == Approx(-2 * slope(at)).epsilon(1e-13).margin(1e-300));
    CHECK(result.derivative[0] == Approx(difference(function, at)).epsilon(1e-8).margin(1e-8));
  }
}

/// Compares a function of two numbers with itself on plain ones, by central differences; one of them may
/// be a plain number.
template <typename Function>
void check_binary(const char* name, const Function& function,
                  const std::vector<std::pair<double, double>>& places) {
  for (const auto& [x, y] : places) {
    INFO(name << " at " << x << ", " << y);
    const double by_x = difference([&, b = y](double a) { return function(a, b); }, x);
    const double by_y = difference([&, a = x](double b) { return function(a, b); }, y);
    const Number both = function(x_at(x), y_at(y));
    CHECK(both.value == function(x, y));
    CHECK(both.derivative[0] == Approx(by_x).epsilon(1e-8).margin(1e-8));
    CHECK(both.derivative[1] == Approx(by_y).epsilon(1e-8).margin(1e-8));
    const Number first = function(x_at(x), y);
    CHECK(first.value == both.value);
    CHECK(first.derivative.isApprox(Number::Derivative(both.derivative[0], 0)));
    const Number second = function(x, y_at(y));
    CHECK(second.value == both.value);
    CHECK(second.derivative.isApprox(Number::Derivative(0, both.derivative[1])));
  }
}

}  // namespace

// The formula of an edge: found by `using std::f` for plain numbers, and by the argument for others.
#define WAYMARK_TEST_UNARY(f, slope, ...) \
  check_unary(                            \
      #f,                                 \
      [](const auto& of) {                \
        using std::f;                     \
        return f(of);                     \
      },                                  \
      [](double x) -> double { return slope; }, __VA_ARGS__)
#define WAYMARK_TEST_BINARY(f, ...)      \
  check_binary(                          \
      #f,                                \
      [](const auto& a, const auto& b) { \
        using std::f;                    \
        return f(a, b);                  \
      },                                 \
      __VA_ARGS__)

TEST_CASE("dual: angles and their inverses") {
  WAYMARK_TEST_UNARY(sin, std::cos(x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(cos, -std::sin(x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(tan, 1 / (std::cos(x) * std::cos(x)), {-1.2, 0.0, 0.7});
  WAYMARK_TEST_UNARY(asin, 1 / std::sqrt(1 - x * x), {-0.8, 0.0, 0.3});
  WAYMARK_TEST_UNARY(acos, -1 / std::sqrt(1 - x * x), {-0.8, 0.0, 0.3});
  WAYMARK_TEST_UNARY(atan, 1 / (1 + x * x), {-30.0, 0.0, 0.7});
}

TEST_CASE("dual: hyperbolic functions and their inverses") {
  WAYMARK_TEST_UNARY(sinh, std::cosh(x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(cosh, std::sinh(x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(tanh, 1 / std::pow(std::cosh(x), 2), {-2.0, 0.0, 0.7, 20.0, 800.0});
  WAYMARK_TEST_UNARY(asinh, 1 / std::sqrt(1 + x * x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(acosh, 1 / std::sqrt(x * x - 1), {1.5, 20.0});
  WAYMARK_TEST_UNARY(atanh, 1 / (1 - x * x), {-0.8, 0.0, 0.3});
}

TEST_CASE("dual: exponentials, logarithms, roots and the error function") {
  WAYMARK_TEST_UNARY(exp, std::exp(x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(exp2, std::exp2(x) * std::log(2.0), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(expm1, std::exp(x), {-2.0, 1e-12, 0.7});
  WAYMARK_TEST_UNARY(log, 1 / x, {0.1, 1.0, 30.0});
  WAYMARK_TEST_UNARY(log2, 1 / (x * std::log(2.0)), {0.1, 1.0, 30.0});
  WAYMARK_TEST_UNARY(log10, 1 / (x * std::log(10.0)), {0.1, 1.0, 30.0});
  WAYMARK_TEST_UNARY(log1p, 1 / (1 + x), {-0.5, 1e-12, 30.0});
  WAYMARK_TEST_UNARY(sqrt, 1 / (2 * std::sqrt(x)), {0.1, 1.0, 30.0});
  WAYMARK_TEST_UNARY(cbrt, 1 / (3 * std::pow(std::abs(x), 2.0 / 3)), {-8.0, 0.3, 27.0});
  WAYMARK_TEST_UNARY(erf, 2 / std::sqrt(std::numbers::pi) * std::exp(-x * x), {-2.0, 0.0, 0.7});
  WAYMARK_TEST_UNARY(erfc, -2 / std::sqrt(std::numbers::pi) * std::exp(-x * x), {-2.0, 0.0, 0.7});
}

TEST_CASE("dual: magnitudes, and steps that have the derivative 0") {
  WAYMARK_TEST_UNARY(abs, x < 0 ? -1 : 1, {-2.0, 0.7});
  WAYMARK_TEST_UNARY(fabs, x < 0 ? -1 : 1, {-2.0, 0.7});
  WAYMARK_TEST_UNARY(floor, 0 * x, {-2.5, 0.7});
  WAYMARK_TEST_UNARY(ceil, 0 * x, {-2.5, 0.7});
  WAYMARK_TEST_UNARY(round, 0 * x, {-2.4, 0.7});
  WAYMARK_TEST_UNARY(trunc, 0 * x, {-2.5, 0.7});
}

TEST_CASE("dual: functions of two numbers, of which one may be a plain one") {
  WAYMARK_TEST_BINARY(atan2, {{1, 2}, {-1, -2}, {3, -0.5}});
  WAYMARK_TEST_BINARY(hypot, {{1, 2}, {-3, 4}, {0, 1}});
  WAYMARK_TEST_BINARY(pow, {{2, 3}, {0.5, -1.5}, {7, 0}, {1, 2.5}});
  WAYMARK_TEST_BINARY(fmod, {{7.3, 2}, {-7.3, 2}, {1, 3}, {1e3, 300}});
  WAYMARK_TEST_BINARY(remainder, {{7.3, 2}, {-7.3, 2}, {1, 3}, {1e3, 300}});
  WAYMARK_TEST_BINARY(copysign, {{2, 3}, {2, -3}, {-2, 3}, {-2, -3}});
}

TEST_CASE("dual: the smaller and the larger number, for arguments of one scalar") {
  using std::max;
  using std::min;
  CHECK(max(x_at(1), y_at(2)).derivative.isApprox(Number::Derivative(0, 1)));
  CHECK(min(x_at(1), y_at(2)).derivative.isApprox(Number::Derivative(1, 0)));
  CHECK(max(x_at(1), 0.5).derivative.isApprox(Number::Derivative(1, 0)));
  CHECK(min(0.5, x_at(1)).is_constant());
  CHECK(max(x_at(1), y_at(1)).derivative.isApprox(Number::Derivative(1, 0)));  // as std::max, the first
}

TEST_CASE("dual: the length of a vector in space") {
  using std::hypot;
  const Number length = hypot(x_at(2), y_at(3), Number(6));
  CHECK(length.value == 7);
  CHECK(length.derivative.isApprox(Number::Derivative(2.0 / 7, 3.0 / 7)));
}

TEST_CASE("dual: a power at the base 0 and at negative bases") {
  const auto slope = [](double base, double exponent) { return pow(x_at(base), exponent).derivative[0]; };
  CHECK(slope(0, 2) == 0);
  CHECK(slope(0, 1) == 1);
  CHECK(slope(0, 0) == 0);                              // x^0 is 1 everywhere
  CHECK(pow(x_at(0), 0.5).derivative[0] == kInfinity);  // as the root
  CHECK(slope(-2, 3) == 12);
  CHECK(pow(x_at(-2), 2).value == 4);
  CHECK(pow(x_at(-2), Number(3)).derivative[0] == 12);  // T(3) is as good as 3
  CHECK(pow(0.0, y_at(2)).derivative[1] == 0);
  CHECK(pow(x_at(0), y_at(2)).derivative.isApproxToConstant(0));
  CHECK(pow(-2.0, Number(3)).is_constant());
  CHECK(std::isnan(pow(-2.0, y_at(3)).derivative[1]));  // no real power is near
}

TEST_CASE("dual: at the end of a domain derivatives are infinite or no numbers, never wrong") {
  CHECK(std::isinf(asin(x_at(1)).derivative[0]));
  CHECK(acos(x_at(-1)).derivative[0] == -kInfinity);
  CHECK(std::isinf(cbrt(x_at(0)).derivative[0]));
  CHECK(std::isinf(sqrt(x_at(0)).derivative[0]));
  CHECK(std::isnan(hypot(x_at(0), y_at(0)).derivative[0]));
}

TEST_CASE("dual: tests look at the value, so both scalars take one branch") {
  using std::isfinite;
  using std::isinf;
  using std::isnan;
  using std::signbit;
  const Number steep(1, {kInfinity, std::nan("")});
  CHECK(isfinite(steep));
  CHECK_FALSE(isnan(steep));
  CHECK_FALSE(isinf(steep));
  CHECK(isinf(Number(-kInfinity)));
  CHECK(isnan(Number(std::nan(""))));
  CHECK_FALSE(isfinite(Number(std::nan(""))));
  CHECK(signbit(Number(-0.0)));
  CHECK_FALSE(signbit(Number(0.0)));
}

TEST_CASE("dual: Eigen's functions of vectors find them") {
  using Vector = Eigen::Matrix<Number, 2, 1>;
  const Vector v(x_at(3), y_at(4));
  CHECK(v.norm().value == 5);
  CHECK(v.norm().derivative.isApprox(Number::Derivative(0.6, 0.8)));
  CHECK(v.cwiseAbs().maxCoeff().value == 4);
  CHECK(v.allFinite());
  CHECK_FALSE(v.hasNaN());
  CHECK(v.normalized()[0].derivative.isApprox(Number::Derivative(16.0 / 125, -12.0 / 125)));
  CHECK(v.array().tanh()[0].value == std::tanh(3.0));
  CHECK(v.array().log1p()[1].derivative[1] == Approx(0.2));
  CHECK(v.array().floor()[1].is_constant());
  CHECK(Eigen::numext::pow(v[0], v[0]).derivative[0] == Approx(27 * (1 + std::log(3.0))));
  CHECK(Eigen::numext::isfinite(v[0]));
}

}  // namespace dual_test

/// Forward-mode automatic differentiation: a value with its N partial derivatives. error(...) of an
/// edge, evaluated with Dual numbers, gives exact Jacobians. This is the default for every edge
/// type without linearize(...).
#pragma once

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/detail/dual_functions.hpp>

namespace WAYMARK_EXPORT waymark {

template <int N>
struct Dual : DualFunctions<Dual<N>> {
  using Derivative = Eigen::Array<double, N, 1, Eigen::DontAlign>;

  double value = 0;
  Derivative derivative = Derivative::Zero();

  Dual() = default;
  Dual(double v) : value(v) {}  // implicit, so that formulas may mix constants and variables
  Dual(double v, const Derivative& d) : value(v), derivative(d) {}

  /// Returns the variable with number `index` and the given value.
  [[nodiscard]] static Dual variable(double v, int index) {
    Dual result(v);
    result.derivative[index] = 1;
    return result;
  }

  /// Tells whether no variable changes it.
  [[nodiscard]] bool is_constant() const { return (derivative == 0).all(); }

  Dual& operator+=(const Dual& b) {
    value += b.value;
    derivative += b.derivative;
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    value -= b.value;
    derivative -= b.derivative;
    return *this;
  }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator-(const Dual& a) { return Dual(-a.value, -a.derivative); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return Dual(a.value * b.value, a.derivative * b.value + b.derivative * a.value);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double inverse = 1 / b.value;
    const double quotient = a.value * inverse;
    return Dual(quotient, (a.derivative - quotient * b.derivative) * inverse);
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
};

}  // namespace waymark

/// @cond  Doxygen knows no template that it has not read.
template <int N>
struct Eigen::NumTraits<waymark::Dual<N>> : Eigen::NumTraits<double> {
  using Real = waymark::Dual<N>;
  using NonInteger = waymark::Dual<N>;
  using Nested = waymark::Dual<N>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 3,
    MulCost = 5
  };
};
/// @endcond

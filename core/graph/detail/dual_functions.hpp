/// The functions of <cmath> for dual numbers. An edge finds them by their arguments, also after
/// `using std::pow;`, which the same formula needs for plain numbers.
///
/// Values are those of the C++ library. Derivatives follow the textbook: where there is none they
/// are infinite or NaN (the root at 0), and a function in steps (floor, round) has 0. Comparisons
/// and tests look at the value alone, so both scalars take the same branch.
#pragma once

#include <cmath>
#include <numbers>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// A base of the dual number D. Functions of two numbers take plain ones too.
template <typename D>
struct DualFunctions {
  friend D sin(const D& a) { return chain(a, std::sin(a.value), std::cos(a.value)); }
  friend D cos(const D& a) { return chain(a, std::cos(a.value), -std::sin(a.value)); }
  friend D tan(const D& a) {
    const double t = std::tan(a.value);
    return chain(a, t, 1 + t * t);
  }
  friend D asin(const D& a) { return chain(a, std::asin(a.value), 1 / leg(a.value)); }
  friend D acos(const D& a) { return chain(a, std::acos(a.value), -1 / leg(a.value)); }
  friend D atan(const D& a) { return chain(a, std::atan(a.value), 1 / (1 + a.value * a.value)); }
  friend D atan2(const D& y, const D& x) {
    const double squared = x.value * x.value + y.value * y.value;
    return D(std::atan2(y.value, x.value), (x.value * y.derivative - y.value * x.derivative) / squared);
  }

  friend D sinh(const D& a) { return chain(a, std::sinh(a.value), std::cosh(a.value)); }
  friend D cosh(const D& a) { return chain(a, std::cosh(a.value), std::sinh(a.value)); }
  friend D tanh(const D& a) {
    const double c = std::cosh(a.value);
    return chain(a, std::tanh(a.value), 1 / (c * c));
  }
  friend D asinh(const D& a) { return chain(a, std::asinh(a.value), 1 / std::hypot(1, a.value)); }
  friend D acosh(const D& a) {
    return chain(a, std::acosh(a.value), 1 / (std::sqrt(a.value - 1) * std::sqrt(a.value + 1)));
  }
  friend D atanh(const D& a) { return chain(a, std::atanh(a.value), 1 / ((1 - a.value) * (1 + a.value))); }

  friend D exp(const D& a) {
    const double e = std::exp(a.value);
    return chain(a, e, e);
  }
  friend D exp2(const D& a) {
    const double e = std::exp2(a.value);
    return chain(a, e, e * std::numbers::ln2);
  }
  friend D expm1(const D& a) { return chain(a, std::expm1(a.value), std::exp(a.value)); }
  friend D log(const D& a) { return D(std::log(a.value), a.derivative / a.value); }
  friend D log2(const D& a) { return chain(a, std::log2(a.value), 1 / (a.value * std::numbers::ln2)); }
  friend D log10(const D& a) { return chain(a, std::log10(a.value), 1 / (a.value * std::numbers::ln10)); }
  friend D log1p(const D& a) { return chain(a, std::log1p(a.value), 1 / (1 + a.value)); }

  friend D sqrt(const D& a) {
    const double r = std::sqrt(a.value);
    return D(r, a.derivative * (0.5 / r));
  }
  friend D cbrt(const D& a) {
    const double r = std::cbrt(a.value);
    return chain(a, r, 1 / (3 * r * r));
  }
  friend D hypot(const D& a, const D& b) {
    const double r = std::hypot(a.value, b.value);
    return D(r, (a.value * a.derivative + b.value * b.derivative) / r);
  }
  friend D hypot(const D& a, const D& b, const D& c) {
    const double r = std::hypot(a.value, b.value, c.value);
    return D(r, (a.value * a.derivative + b.value * b.derivative + c.value * c.derivative) / r);
  }
  /// A constant exponent of 0 has the derivative 0 for every base.
  friend D pow(const D& base, double exponent) {
    const double slope = exponent == 0 ? 0 : exponent * std::pow(base.value, exponent - 1);
    return chain(base, std::pow(base.value, exponent), slope);
  }
  /// The derivative by a positive exponent is 0 at the base 0; by any exponent it is NaN at a negative base.
  friend D pow(double base, const D& exponent) {
    const double power = std::pow(base, exponent.value);
    if (exponent.is_constant()) return D(power);
    return chain(exponent, power, power == 0 ? 0 : power * std::log(base));
  }
  /// A constant, such as T(2), takes part as the plain number it is: a negative base has a square.
  friend D pow(const D& base, const D& exponent) {
    if (exponent.is_constant()) return pow(base, exponent.value);
    if (base.is_constant()) return pow(base.value, exponent);
    D power = pow(base, exponent.value);
    power.derivative += pow(base.value, exponent).derivative;
    return power;
  }

  friend D erf(const D& a) { return chain(a, std::erf(a.value), bell(a.value)); }
  friend D erfc(const D& a) { return chain(a, std::erfc(a.value), -bell(a.value)); }

  friend D abs(const D& a) { return a.value < 0 ? -a : a; }
  friend D fabs(const D& a) { return abs(a); }
  friend D copysign(const D& a, const D& sign) { return signbit(a) == signbit(sign) ? a : -a; }
  friend D min(const D& a, const D& b) { return b < a ? b : a; }
  friend D max(const D& a, const D& b) { return a < b ? b : a; }

  friend D floor(const D& a) { return D(std::floor(a.value)); }
  friend D ceil(const D& a) { return D(std::ceil(a.value)); }
  friend D round(const D& a) { return D(std::round(a.value)); }
  friend D trunc(const D& a) { return D(std::trunc(a.value)); }
  friend D fmod(const D& a, const D& b) { return rest(a, b, std::fmod(a.value, b.value)); }
  friend D remainder(const D& a, const D& b) { return rest(a, b, std::remainder(a.value, b.value)); }

  friend bool isfinite(const D& a) { return std::isfinite(a.value); }
  friend bool isinf(const D& a) { return std::isinf(a.value); }
  friend bool isnan(const D& a) { return std::isnan(a.value); }
  friend bool signbit(const D& a) { return std::signbit(a.value); }

 private:
  static D chain(const D& a, double value, double slope) { return D(value, slope * a.derivative); }
  /// The other leg of a right triangle with the hypotenuse 1.
  static double leg(double x) { return std::sqrt((1 - x) * (1 + x)); }
  static double bell(double x) { return 2 * std::numbers::inv_sqrtpi * std::exp(-x * x); }
  /// a - n b with a whole number n.
  static D rest(const D& a, const D& b, double value) {
    return D(value, a.derivative - std::round((a.value - value) / b.value) * b.derivative);
  }
};

}  // namespace waymark

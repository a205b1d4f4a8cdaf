/// SE(2): planar rigid motions, generic in the scalar (double or a dual number).
///
/// Conventions (types_se2/README.md states them once): a pose is (x, y, heading) in metres and
/// radians. Tangent vectors are (rho_x, rho_y, theta) in the body frame. exp and log are those of
/// the group; V(theta) maps rho to the translation.
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include <waymark/types_se2/detail/sin_cos.hpp>

namespace waymark {

template <typename T>
using Vector2 = Eigen::Matrix<T, 2, 1>;
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// Returns the equivalent angle in (-pi, pi]. Derivatives pass through unchanged, because whole
/// turns are constants.
template <typename T>
[[nodiscard]] [[gnu::always_inline]] inline T wrap_angle(const T& angle) {
  using std::ceil;
  constexpr double kTurn = 2 * std::numbers::pi;
  double value;
  if constexpr (std::is_same_v<T, double>) {
    value = angle;
  } else {
    value = angle.value;
  }
  if (value > -std::numbers::pi && value <= std::numbers::pi) return angle;
  return angle - T(kTurn * std::ceil((value - std::numbers::pi) / kTurn));
}

/// Returns the signed angle from a to b, in (-pi, pi]; 0 if one of them is zero.
[[nodiscard]] inline double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
}

/// A pose or a relative motion: translation [m] and heading [rad]. The constructor does not wrap
/// the heading.
template <typename T>
struct Pose2 {
  Vector2<T> position = Vector2<T>(T(0.0), T(0.0));
  T heading = T(0.0);

  Pose2() = default;
  Pose2(const Vector2<T>& p, const T& h) : position(p), heading(h) {}
  Pose2(const T& x, const T& y, const T& h) : position(x, y), heading(h) {}

  [[nodiscard]] Vector3<T> vector() const { return Vector3<T>(position[0], position[1], heading); }
};

/// Converts a measured pose or vector to the scalar of an error function.
template <typename T>
[[nodiscard]] Pose2<T> constant_pose(const Eigen::Vector3d& v) {
  return Pose2<T>(T(v[0]), T(v[1]), T(v[2]));
}
template <typename T>
[[nodiscard]] Vector2<T> constant_vector(const Eigen::Vector2d& v) {
  return Vector2<T>(T(v[0]), T(v[1]));
}

namespace detail {

template <typename T>
[[gnu::always_inline]] inline void sin_cos_of(const T& angle, T& s, T& c) {
  if constexpr (std::is_same_v<T, double>) {
    const SinCos both = sin_cos(angle);
    s = both.sin;
    c = both.cos;
  } else {
    s = sin(angle);
    c = cos(angle);
  }
}

}  // namespace detail

/// Returns R(angle) v.
template <typename T>
[[nodiscard]] [[gnu::always_inline]] inline Vector2<T> rotate(const T& angle, const Vector2<T>& v) {
  T s;
  T c;
  detail::sin_cos_of(angle, s, c);
  return Vector2<T>(c * v[0] - s * v[1], s * v[0] + c * v[1]);
}

/// Returns R(angle)^T v.
template <typename T>
[[nodiscard]] [[gnu::always_inline]] inline Vector2<T> rotate_back(const T& angle, const Vector2<T>& v) {
  T s;
  T c;
  detail::sin_cos_of(angle, s, c);
  return Vector2<T>(c * v[0] + s * v[1], c * v[1] - s * v[0]);
}

/// Returns |v|. The norm has no derivative at 0; this one is zero there.
template <typename T>
[[nodiscard]] T length(const Vector2<T>& v) {
  using std::hypot;
  if (v[0] == T(0.0) && v[1] == T(0.0)) return T(0.0);
  return hypot(v[0], v[1]);
}

/// Returns a * b: the motion b, applied in the frame of a. The heading is the plain sum, so
/// windings are kept.
template <typename T>
[[nodiscard]] [[gnu::always_inline]] inline Pose2<T> compose(const Pose2<T>& a, const Pose2<T>& b) {
  return Pose2<T>(Vector2<T>(a.position + rotate(a.heading, b.position)), T(a.heading + b.heading));
}

/// Returns a^-1 * b: the pose b in the frame of a. The heading difference is not wrapped.
template <typename T>
[[nodiscard]] [[gnu::always_inline]] inline Pose2<T> between(const Pose2<T>& a, const Pose2<T>& b) {
  return Pose2<T>(rotate_back(a.heading, Vector2<T>(b.position - a.position)), T(b.heading - a.heading));
}

template <typename T>
[[nodiscard]] Pose2<T> inverse(const Pose2<T>& a) {
  return between(a, Pose2<T>());
}

namespace detail {

/// The series are used for |theta| below this; their first omitted term is then below 1e-18.
inline constexpr double kSeriesBelow = 1e-3;

template <typename T>
[[nodiscard]] double real_part(const T& value) {
  if constexpr (std::is_same_v<T, double>) {
    return value;
  } else {
    return value.value;
  }
}

template <typename T>
[[nodiscard]] bool is_small(const T& theta) {
  return std::abs(real_part(theta)) < kSeriesBelow;
}

/// Returns sin(theta) / theta.
template <typename T>
[[nodiscard]] T sinc(const T& theta) {
  using std::sin;
  const T t2 = theta * theta;
  if (is_small(theta)) return T(1.0) - t2 * (T(1.0 / 6) - t2 * (T(1.0 / 120) - t2 * T(1.0 / 5040)));
  return sin(theta) / theta;
}

/// Returns (1 - cos(theta)) / theta.
template <typename T>
[[nodiscard]] T one_minus_cos_over(const T& theta) {
  using std::sin;
  const T t2 = theta * theta;
  if (is_small(theta))
    return theta * (T(0.5) - t2 * (T(1.0 / 24) - t2 * (T(1.0 / 720) - t2 * T(1.0 / 40320))));
  const T half = sin(theta * T(0.5));  // 1 - cos(theta) = 2 sin^2(theta / 2): no cancellation
  return T(2.0) * half * half / theta;
}

/// Returns (theta / 2) cot(theta / 2): 1 at 0, and 0 at +-pi.
template <typename T>
[[nodiscard]] T half_cot(const T& theta) {
  using std::cos;
  using std::sin;
  const T half = theta * T(0.5);
  const T t2 = theta * theta;
  if (is_small(theta)) return T(1.0) - t2 * (T(1.0 / 12) + t2 * (T(1.0 / 720) + t2 * T(1.0 / 30240)));
  return half * cos(half) / sin(half);
}

/// Returns the derivative of half_cot by theta.
[[nodiscard]] inline double half_cot_slope(double theta) {
  const double t2 = theta * theta;
  if (is_small(theta)) return -theta * (1.0 / 6 + t2 * (1.0 / 180 + t2 / 5040));
  const SinCos half = sin_cos(0.5 * theta);
  return (half.cos * half.sin - 0.5 * theta) / (2 * half.sin * half.sin);
}

}  // namespace detail

/// The group exponential: the motion of a body that follows the constant twist xi = (rho, theta)
/// for unit time. exp([v dt, 0, w dt]) is the exact arc of a vehicle with speed v and yaw rate w.
/// The heading of the result is theta, not wrapped.
template <typename T>
[[nodiscard]] Pose2<T> se2_exp(const Vector3<T>& xi) {
  const T a = detail::sinc(xi[2]);
  const T b = detail::one_minus_cos_over(xi[2]);
  return Pose2<T>(T(a * xi[0] - b * xi[1]), T(b * xi[0] + a * xi[1]), xi[2]);
}

/// The group logarithm, with the heading taken in (-pi, pi]. V(theta)^-1 = [h, theta/2; -theta/2,
/// h], h = (theta/2) cot(theta/2).
template <typename T>
[[nodiscard]] Vector3<T> se2_log(const Pose2<T>& pose) {
  const T theta = wrap_angle(pose.heading);
  const T h = detail::half_cot(theta);
  const T half = theta * T(0.5);
  return Vector3<T>(T(h * pose.position[0] + half * pose.position[1]),
                    T(h * pose.position[1] - half * pose.position[0]), theta);
}

/// The adjoint. Ad(X) xi is the body twist xi, expressed in the frame in which X is given.
[[nodiscard]] Eigen::Matrix3d se2_adjoint(const Pose2<double>& pose);
/// The right Jacobian: exp(xi + d) = exp(xi) exp(Jr(xi) d) to first order.
[[nodiscard]] Eigen::Matrix3d se2_right_jacobian(const Eigen::Vector3d& xi);
/// The inverse of se2_right_jacobian. It is finite for |theta| < 2 pi.
[[nodiscard]] Eigen::Matrix3d se2_right_jacobian_inverse(const Eigen::Vector3d& xi);

}  // namespace waymark

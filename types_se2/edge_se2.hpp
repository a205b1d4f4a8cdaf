/// The classic edges of the plane. A tag has one meaning only. EDGE_SE2 is always the (t, theta)
/// form that every reader of g2o files expects. The form with the group logarithm is EDGE_SE2_LOG.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {

/// A relative pose in (t, theta) form. With D = Z^-1 (X_from^-1 X_to) the error is e = (D.x, D.y,
/// wrap(D.heading)). measured = (x, y, heading) of Z, in metres and radians.
struct EdgeSe2 {
  static constexpr std::string_view kTag = "EDGE_SE2";
  static constexpr std::string_view kForm = "(t, theta)";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeSe2::measured>("measured")}; }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    const Pose2<T> d = between(constant_pose<T>(measured), between(from, to));
    return Vector3<T>(d.position[0], d.position[1], wrap_angle(d.heading));
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<3>& e,
                 JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) const;

  /// Stores the measured translation in the axes of the measured pose.
  void prepare();

  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
  /// R(heading)^T translation of Z, by prepare()
  Eigen::Vector2d turned = Eigen::Vector2d::Zero();
};

/// A measurement Z of a relative pose, in the form that the linearisation needs.
struct RelativeMeasurement {
  RelativeMeasurement() = default;
  explicit RelativeMeasurement(const Pose2<double>& z)
      : heading(z.heading), turned(rotate_back(z.heading, z.position)) {}

  double heading = 0;
  Eigen::Vector2d turned = Eigen::Vector2d::Zero();  ///< R(heading)^T translation
};

/// Computes e = log(Z^-1 (X_from^-1 X_to)) and its exact Jacobians, for every edge with that error.
/// Let D = (t, theta) = Z^-1 X_from^-1 X_to and a = theta_from + theta_Z. Then t = R(a)^T (p_to -
/// p_from) - R(theta_Z)^T t_Z and e = (V^-1 t, theta) with V^-1 = [h, theta/2; -theta/2, h]. So
/// de/dp_to = V^-1 R(a)^T and de/dtheta_to = (dV^-1/dtheta t, 1). The other Jacobian follows from
/// these, because e does not change if both poses move together.
[[gnu::always_inline]] inline void linearize_log_error(const RelativeMeasurement& z,
                                                       const Pose2<double>& from, const Pose2<double>& to,
                                                       ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from,
                                                       JacobianMatrix<3, 3>& by_to) {
  const double a = from.heading + z.heading;
  const auto [s, c] = sin_cos(a);
  const double dx = to.position[0] - from.position[0];
  const double dy = to.position[1] - from.position[1];
  const double tx = c * dx + s * dy - z.turned[0];
  const double ty = c * dy - s * dx - z.turned[1];
  const double theta = wrap_angle(to.heading - a);
  const double half = 0.5 * theta;
  const double h = detail::half_cot(theta);
  const double slope = detail::half_cot_slope(theta);
  e[0] = h * tx + half * ty;
  e[1] = h * ty - half * tx;
  e[2] = theta;
  by_to(0, 0) = h * c - half * s;
  by_to(0, 1) = h * s + half * c;
  by_to(1, 0) = -by_to(0, 1);
  by_to(1, 1) = by_to(0, 0);
  by_to(0, 2) = slope * tx + 0.5 * ty;
  by_to(1, 2) = slope * ty - 0.5 * tx;
  by_to(2, 0) = by_to(2, 1) = 0;
  by_to(2, 2) = 1;
  for (int row = 0; row < 3; ++row) {
    by_from(row, 0) = -by_to(row, 0);
    by_from(row, 1) = -by_to(row, 1);
    by_from(row, 2) = by_to(row, 0) * dy - by_to(row, 1) * dx - by_to(row, 2);
  }
}

/// A relative pose in logarithmic form, equation (1) of the paper: e = log(Z^-1 (X_from^-1 X_to)),
/// ordered (rho, theta).
struct EdgeSe2Log {
  static constexpr std::string_view kTag = "EDGE_SE2_LOG";
  static constexpr std::string_view kForm = "log";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeSe2Log::measured>("measured")}; }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    return se2_log(between(constant_pose<T>(measured), between(from, to)));
  }

  void prepare();
  void linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<3>& e,
                 JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) const {
    linearize_log_error(relative, from, to, e, by_from, by_to);
  }

  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
  RelativeMeasurement relative{};  ///< of measured, by prepare()
};

/// A prior on a pose in (t, theta) form. With D = Z^-1 X the error is e = (D.x, D.y,
/// wrap(D.heading)).
struct EdgePriorSe2 {
  static constexpr std::string_view kTag = "EDGE_PRIOR_SE2";
  static constexpr std::string_view kForm = "(t, theta)";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgePriorSe2::measured>("measured")}; }

  template <typename T>
  Vector3<T> error(const Pose2<T>& pose) const {
    const Pose2<T> d = between(constant_pose<T>(measured), pose);
    return Vector3<T>(d.position[0], d.position[1], wrap_angle(d.heading));
  }

  void linearize(const Pose2<double>& pose, ErrorVector<3>& e, JacobianMatrix<3, 3>& by_pose) const;

  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
};

/// A landmark seen from a pose: e = R^T (p_landmark - p) - measured. Metres.
struct EdgeSe2Xy {
  static constexpr std::string_view kTag = "EDGE_SE2_XY";
  static constexpr std::string_view kForm = "body frame";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeSe2Xy::measured>("measured")}; }

  template <typename T>
  Vector2<T> error(const Pose2<T>& pose, const Vector2<T>& landmark) const {
    const Vector2<T> seen = rotate_back(pose.heading, Vector2<T>(landmark - pose.position));
    return seen - constant_vector<T>(measured);
  }

  void linearize(const Pose2<double>& pose, const Vector2<double>& landmark, ErrorVector<2>& e,
                 JacobianMatrix<2, 3>& by_pose, JacobianMatrix<2, 2>& by_landmark) const;
  [[nodiscard]] Sight sight() const { return Sight::of_place(measured); }

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

[[gnu::always_inline]] inline void EdgeSe2::linearize(const Pose2<double>& from, const Pose2<double>& to,
                                                      ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from,
                                                      JacobianMatrix<3, 3>& by_to) const {
  // With a = theta_from + z.heading: e_t = R(a)^T (p_to - p_from) - R(z.heading)^T z.t.
  const double a = from.heading + measured[2];
  const auto [s, c] = sin_cos(a);
  const double dx = to.position[0] - from.position[0];
  const double dy = to.position[1] - from.position[1];
  const double turned_x = c * dx + s * dy;
  const double turned_y = c * dy - s * dx;
  e[0] = turned_x - turned[0];
  e[1] = turned_y - turned[1];
  e[2] = wrap_angle(to.heading - a);
  // The entries are set one by one, because a comma initialiser would keep the matrices in memory.
  const auto set = [](JacobianMatrix<3, 3> & m, double cosine, double sine, double x, double y, double unit)
      __attribute__((always_inline)) {
    m(0, 0) = m(1, 1) = cosine;
    m(0, 1) = sine;
    m(1, 0) = -sine;
    m(0, 2) = x;
    m(1, 2) = y;
    m(2, 0) = m(2, 1) = 0;
    m(2, 2) = unit;
  };
  set(by_from, -c, -s, turned_y, -turned_x, -1);
  set(by_to, c, s, 0, 0, 1);
}

// This is compiled once, in edge_se2.cpp, and not in every file that adds an edge.
extern template class EdgeBatch<EdgeSe2>;
extern template class EdgeBatch<EdgeSe2Log>;
extern template class EdgeBatch<EdgePriorSe2>;
extern template class EdgeBatch<EdgeSe2Xy>;

}  // namespace waymark

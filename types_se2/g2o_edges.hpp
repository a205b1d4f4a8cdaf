/// The other plane edges of g2o (its types/slam2d): priors on positions, bearings, and measurements
/// of sensors that are not mounted at the origin of the body. The offset of a sensor is its pose in
/// the body frame. g2o keeps it in PARAMS_SE2OFFSET lines; here it is a field of the edge
/// (formats/README.md).
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {

/// The position of a pose in the axes of the frame: e = p - measured. Metres. The heading
/// does not enter.
struct EdgePriorSe2Xy {
  static constexpr std::string_view kTag = "EDGE_PRIOR_SE2_XY";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgePriorSe2Xy::measured>("measured")}; }

  template <typename T>
  Vector2<T> error(const Pose2<T>& pose) const {
    return pose.position - constant_vector<T>(measured);
  }
  void linearize(const Pose2<double>& pose, ErrorVector<2>& e, JacobianMatrix<2, 3>& by_pose) const;

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

/// The position of a point: e = p - measured. Metres.
struct EdgePriorXy {
  static constexpr std::string_view kTag = "EDGE_PRIOR_XY";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgePriorXy::measured>("measured")}; }

  template <typename T>
  Vector2<T> error(const Vector2<T>& point) const {
    return point - constant_vector<T>(measured);
  }
  void linearize(const Vector2<double>& point, ErrorVector<2>& e, JacobianMatrix<2, 2>& by_point) const;

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

/// The direction in which a pose sees a point, counter-clockwise from the heading of the pose. With
/// q = R^T (p_point - p) the error is e = wrap(atan2(q.y, q.x) - measured). Radians. g2o uses the
/// opposite sign; chi2 is the same. If the pose is at the point, there is no direction. The error
/// is then that of a point straight ahead, and its derivative is zero.
struct EdgeBearingSe2Xy {
  static constexpr std::string_view kTag = "EDGE_BEARING_SE2_XY";
  static constexpr std::string_view kForm = "bearing";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() { return std::array{field<&EdgeBearingSe2Xy::measured>("measured")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& point) const {
    using std::atan2;
    const Vector2<T> seen = rotate_back(pose.heading, Vector2<T>(point - pose.position));
    const double x = detail::real_part(seen[0]);
    const double y = detail::real_part(seen[1]);
    const T bearing = x * x + y * y > 0 ? T(atan2(seen[1], seen[0])) : T(0.0);
    return Eigen::Matrix<T, 1, 1>(wrap_angle(T(bearing - T(measured))));
  }
  void linearize(const Pose2<double>& pose, const Vector2<double>& point, ErrorVector<1>& e,
                 JacobianMatrix<1, 3>& by_pose, JacobianMatrix<1, 2>& by_point) const;
  [[nodiscard]] Sight sight() const { return Sight::of_bearing(measured); }

  double measured = 0;
};

/// The relative pose of two sensors in (t, theta) form. With D = Z^-1 (X_from O_from)^-1 (X_to
/// O_to) the error is e = (D.x, D.y, wrap(D.heading)). Metres and radians.
struct EdgeSe2Offset {
  static constexpr std::string_view kTag = "EDGE_SE2_OFFSET";
  static constexpr std::string_view kForm = "(t, theta)";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2Offset::measured>("measured"),
                      field<&EdgeSe2Offset::offset_from>("offset_from"),
                      field<&EdgeSe2Offset::offset_to>("offset_to")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    // The relative pose of the bodies comes first, so that nothing is added to large coordinates.
    const Pose2<T> moved = compose(between(from, to), constant_pose<T>(offset_to));
    const Pose2<T> d = between(constant_pose<T>(measured), between(constant_pose<T>(offset_from), moved));
    return Vector3<T>(d.position[0], d.position[1], wrap_angle(d.heading));
  }

  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
  /// O_from: the sensor in the body frame of `from`
  Eigen::Vector3d offset_from = Eigen::Vector3d::Zero();
  /// O_to: the sensor in the body frame of `to`
  Eigen::Vector3d offset_to = Eigen::Vector3d::Zero();
};

/// A point seen by a sensor: e = (X O)^-1 p_point - measured. Metres, in the axes of the sensor.
struct EdgeSe2PointXyOffset {
  static constexpr std::string_view kTag = "EDGE_SE2_POINTXY_OFFSET";
  static constexpr std::string_view kForm = "sensor frame";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeSe2PointXyOffset::measured>("measured"),
                      field<&EdgeSe2PointXyOffset::offset>("offset")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& pose, const Vector2<T>& point) const {
    const Vector2<T> by_body = rotate_back(pose.heading, Vector2<T>(point - pose.position));
    const Pose2<T> sensor = constant_pose<T>(offset);
    const Vector2<T> seen = rotate_back(sensor.heading, Vector2<T>(by_body - sensor.position));
    return seen - constant_vector<T>(measured);
  }
  void linearize(const Pose2<double>& pose, const Vector2<double>& point, ErrorVector<2>& e,
                 JacobianMatrix<2, 3>& by_pose, JacobianMatrix<2, 2>& by_point) const;
  [[nodiscard]] Sight sight() const {
    return {.sensor = offset.head<2>(), .way = rotate(offset[2], measured)};
  }

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< O: the sensor in the body frame
};

// This is compiled once, in g2o_edges.cpp.
extern template class EdgeBatch<EdgePriorSe2Xy>;
extern template class EdgeBatch<EdgePriorXy>;
extern template class EdgeBatch<EdgeBearingSe2Xy>;
extern template class EdgeBatch<EdgeSe2Offset>;
extern template class EdgeBatch<EdgeSe2PointXyOffset>;

}  // namespace waymark

/// The edges of GNSS positions, and the time offset between GNSS and odometry as a state
/// of the graph.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {

/// The position of an antenna, seen from a reference pose: e = R_from^T (p_to + R_to antenna -
/// p_from) - measured. Metres. For GNSS the reference is the fixed origin of the frame or a fixed
/// GNSS node. If it is the origin, e is the difference in the axes of the frame, and no heading
/// error enters it. This is the decoupled GNSS error.
struct EdgeGnssPosition {
  static constexpr std::string_view kTag = "EDGE_GNSS_POSITION";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssPosition::measured>("measured"),
                      field<&EdgeGnssPosition::antenna>("antenna")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& from, const Pose2<T>& to) const {
    const Vector2<T> place = to.position + rotate(to.heading, constant_vector<T>(antenna));
    const Vector2<T> seen = rotate_back(from.heading, Vector2<T>(place - from.position));
    return seen - constant_vector<T>(measured);
  }

  void linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<2>& e,
                 JacobianMatrix<2, 3>& by_from, JacobianMatrix<2, 3>& by_to) const;

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  /// in the body frame of `to`: x forward, y left
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();
};

/// How late the stamps of a receiver are on the odometry's clock, in s. A fix with stamp t shows
/// the antenna as it was at t - offset. It is the same number as `delay` in a drive.yaml.
struct VertexTimeOffset : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_TIME_OFFSET";
  static constexpr std::array<std::string_view, 1> value_names() { return {"time_offset"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"s"}; }
};

/// EDGE_GNSS_POSITION of a fix whose lateness is estimated:
///   e = R_from^T (p_to + R_to antenna - p_from) - (offset - assumed_offset) velocity - measured.
/// Metres. `to` and `antenna` are where the antenna was if the fix is late by `assumed_offset`. The
/// velocity is a number, not that of `to`: with the heading of `to` in this product each fix could
/// buy itself a step to the side with a larger offset, and a poor gyro would make all of them do so.
/// So the edge is exact where the offset is the assumed one, and right to first order about it.
struct EdgeGnssPositionLate {
  static constexpr std::string_view kTag = "EDGE_GNSS_POSITION_LATE";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexTimeOffset>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssPositionLate::measured>("measured"),
                      field<&EdgeGnssPositionLate::antenna>("antenna"),
                      field<&EdgeGnssPositionLate::velocity>("velocity"),
                      field<&EdgeGnssPositionLate::assumed_offset>("assumed_offset")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& offset) const {
    const Vector2<T> place = to.position + rotate(to.heading, constant_vector<T>(antenna));
    const Vector2<T> seen = rotate_back(from.heading, Vector2<T>(place - from.position));
    const T since = offset - T(assumed_offset);
    return {seen[0] - since * T(velocity[0]) - T(measured[0]),
            seen[1] - since * T(velocity[1]) - T(measured[1])};
  }

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();   ///< in the body frame of `to`: x forward, y left
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< of the antenna, in the axes of `from`, m/s
  double assumed_offset = 0;                           ///< s
};

// This is compiled once, in edge_gnss.cpp.
extern template class EdgeBatch<EdgeGnssPosition>;
extern template class EdgeBatch<EdgeGnssPositionLate>;

}  // namespace waymark

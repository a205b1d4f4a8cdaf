/// Absolute headings from a dual antenna or a compass. The reading is used as it is, with a constant
/// deviation that is estimated, or with one that wanders about it too.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/plugin_kit/gauss_markov_process.hpp>

namespace waymark::plugins::heading {

/// The constant deviation of a heading sensor in rad, counter-clockwise: reading = heading +
/// offset. For a magnetometer it contains the declination and the vehicle's iron; for a dual
/// antenna, the mounting angle of the baseline.
struct VertexHeadingOffset : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_HEADING_OFFSET";
  static constexpr std::array<std::string_view, 1> value_names() { return {"heading_offset"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"rad"}; }

  static void retract(double* value, const double* delta) { value[0] = wrap_angle(value[0] + delta[0]); }
  static void local(const double* from, const double* to, double* delta) {
    delta[0] = wrap_angle(to[0] - from[0]);
  }
};

/// What the deviation of a heading sensor is about a moment, beside VERTEX_HEADING_OFFSET, in rad: iron beside
/// the road, the slope, reflections at the antennas.
struct VertexHeadingWander : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_HEADING_WANDER";
  static constexpr std::array<std::string_view, 1> value_names() { return {"heading_wander"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"rad"}; }
};

/// One step of the wander, in radians.
struct EdgeHeadingWanderDecay : GaussMarkovDecay<EdgeHeadingWanderDecay, VertexHeadingWander> {
  static constexpr std::string_view kTag = "EDGE_HEADING_WANDER_DECAY";
};

/// The wander at a moment between two others, in radians.
struct EdgeHeadingWanderBetween : GaussMarkovBetween<EdgeHeadingWanderBetween, VertexHeadingWander> {
  static constexpr std::string_view kTag = "EDGE_HEADING_WANDER_BETWEEN";
};

/// e = wrap(heading - measured). Radians, counter-clockwise from the frame's x axis (grid east).
struct EdgeHeading {
  static constexpr std::string_view kTag = "EDGE_HEADING";
  static constexpr std::string_view kForm = "angle";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeHeading::measured>("measured")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    return Eigen::Matrix<T, 1, 1>(wrap_angle(T(pose.heading - T(measured))));
  }
  void linearize(const Pose2<double>& pose, ErrorVector<1>& e, JacobianMatrix<1, 3>& by_pose) const {
    e = error(pose);
    by_pose << 0, 0, 1;
  }

  double measured = 0;
};

/// e = wrap(heading + offset - measured). Radians.
struct EdgeHeadingOffset {
  static constexpr std::string_view kTag = "EDGE_HEADING_OFFSET";
  static constexpr std::string_view kForm = "angle";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexHeadingOffset>;
  static constexpr auto fields() { return std::array{field<&EdgeHeadingOffset::measured>("measured")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const T& offset) const {
    return Eigen::Matrix<T, 1, 1>(wrap_angle(T(pose.heading + offset - T(measured))));
  }
  void linearize(const Pose2<double>& pose, double offset, ErrorVector<1>& e, JacobianMatrix<1, 3>& by_pose,
                 JacobianMatrix<1, 1>& by_offset) const {
    e = error(pose, offset);
    by_pose << 0, 0, 1;
    by_offset << 1;
  }

  double measured = 0;
};

/// e = wrap(heading + offset + wander - measured). Radians.
struct EdgeHeadingWandering {
  static constexpr std::string_view kTag = "EDGE_HEADING_WANDERING";
  static constexpr std::string_view kForm = "angle";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexHeadingOffset, VertexHeadingWander>;
  static constexpr auto fields() { return std::array{field<&EdgeHeadingWandering::measured>("measured")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const T& offset, const T& wander) const {
    return Eigen::Matrix<T, 1, 1>(wrap_angle(T(pose.heading + offset + wander - T(measured))));
  }

  double measured = 0;
};

}  // namespace waymark::plugins::heading

/// Correlated errors of a receiver: states that several fixes share, and the edges that use them.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/plugin_kit/gauss_markov_process.hpp>

namespace waymark::plugins::gnss_correlated {

/// The slow error of all fixes about a moment. It lasts for minutes (atmosphere, orbits).
/// Metres, frame axes.
struct VertexGnssBias : PlaneState {
  static constexpr std::string_view kTag = "VERTEX_GNSS_BIAS";
  static constexpr std::array<std::string_view, 2> value_names() { return {"gnss_bias_x", "gnss_bias_y"}; }
  static constexpr std::array<std::string_view, 2> value_units() { return {"m", "m"}; }
};

/// The part of the error that lasts for seconds (reflections, the smoothing of the receiver). Its
/// unit is its own standard deviation, which each fix states; frame axes.
struct VertexGnssMultipath : PlaneState {
  static constexpr std::string_view kTag = "VERTEX_GNSS_MULTIPATH";
  static constexpr std::array<std::string_view, 2> value_names() { return {"x", "y"}; }
};

/// One step of the slow error.
struct EdgeGnssBiasDecay : GaussMarkovDecay<EdgeGnssBiasDecay, VertexGnssBias> {
  static constexpr std::string_view kTag = "EDGE_GNSS_BIAS_DECAY";
};

/// The slow error of a fix that arrives after a later one.
struct EdgeGnssBiasBetween : GaussMarkovBetween<EdgeGnssBiasBetween, VertexGnssBias> {
  static constexpr std::string_view kTag = "EDGE_GNSS_BIAS_BETWEEN";
};

/// The same for the part of the error that lasts for seconds.
struct EdgeGnssMultipathDecay : GaussMarkovDecay<EdgeGnssMultipathDecay, VertexGnssMultipath> {
  static constexpr std::string_view kTag = "EDGE_GNSS_MULTIPATH_DECAY";
};
struct EdgeGnssMultipathBetween : GaussMarkovBetween<EdgeGnssMultipathBetween, VertexGnssMultipath> {
  static constexpr std::string_view kTag = "EDGE_GNSS_MULTIPATH_BETWEEN";
};

/// EDGE_GNSS_POSITION_LATE with the correlated errors in the measurement:
///   e = R_from^T (p_to + R_to antenna - p_from) - (offset - assumed_offset) velocity
///       + bias + scale multipath - measured.
/// `from` is the fixed origin; its axes are those of the frame. Metres.
struct EdgeGnssPositionCorrelated {
  static constexpr std::string_view kTag = "EDGE_GNSS_POSITION_CORRELATED";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexTimeOffset, VertexGnssBias, VertexGnssMultipath>;
  static constexpr bool kRelative = true;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssPositionCorrelated::measured>("measured"),
                      field<&EdgeGnssPositionCorrelated::antenna>("antenna"),
                      field<&EdgeGnssPositionCorrelated::velocity>("velocity"),
                      field<&EdgeGnssPositionCorrelated::assumed_offset>("assumed_offset"),
                      field<&EdgeGnssPositionCorrelated::scale>("scale")};
  }

  template <typename T>
  Vector2<T> error(const Pose2<T>& from, const Pose2<T>& to, const T& offset, const Vector2<T>& bias,
                   const Vector2<T>& multipath) const {
    const EdgeGnssPositionLate fix{measured, antenna, velocity, assumed_offset};
    const Vector2<T> spread = {multipath[0] * scale[0] + multipath[1] * scale[1],
                               multipath[0] * scale[1] + multipath[1] * scale[2]};
    return fix.error(from, to, offset) + bias + spread;
  }

  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();   ///< in the body frame of `to`: x forward, y left
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< of the antenna, in the axes of `from`, m/s
  double assumed_offset = 0;                           ///< s
  /// The symmetric root of the covariance of the part that lasts for seconds: xx, xy, yy, in m.
  Eigen::Vector3d scale = {1, 0, 1};
};

}  // namespace waymark::plugins::gnss_correlated

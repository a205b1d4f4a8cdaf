/// Correlated errors of a receiver: states that several fixes share, and the edges that use them.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/types_se2/edge_gnss.hpp>

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

/// One step of a first-order Gauss-Markov process: e = x_to - decay x_from, decay = exp(-dt / tau).
struct EdgeGnssBiasDecay {
  static constexpr std::string_view kTag = "EDGE_GNSS_BIAS_DECAY";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexGnssBias, VertexGnssBias>;
  static constexpr auto fields() { return std::array{field<&EdgeGnssBiasDecay::decay>("decay")}; }

  template <typename T>
  Vector2<T> error(const Vector2<T>& from, const Vector2<T>& to) const {
    return to - from * T(decay);
  }

  double decay = 1;
};

/// The same step for the part of the error that lasts for seconds.
struct EdgeGnssMultipathDecay : EdgeGnssBiasDecay {
  static constexpr std::string_view kTag = "EDGE_GNSS_MULTIPATH_DECAY";
  using Vertices = VertexList<VertexGnssMultipath, VertexGnssMultipath>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssBiasDecay::decay, EdgeGnssMultipathDecay>("decay")};
  }
};

/// The same process at a moment between two others, for a fix that arrives after a later one:
///   e = x - (before x_before + after x_after).
/// Given its neighbours, a Gauss-Markov process has no memory.
struct EdgeGnssBiasBetween {
  static constexpr std::string_view kTag = "EDGE_GNSS_BIAS_BETWEEN";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexGnssBias, VertexGnssBias, VertexGnssBias>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssBiasBetween::before>("before"),
                      field<&EdgeGnssBiasBetween::after>("after")};
  }

  template <typename T>
  Vector2<T> error(const Vector2<T>& earlier, const Vector2<T>& later, const Vector2<T>& between) const {
    return between - earlier * T(before) - later * T(after);
  }

  double before = 0.5;
  double after = 0.5;
};

/// The same for the part of the error that lasts for seconds.
struct EdgeGnssMultipathBetween : EdgeGnssBiasBetween {
  static constexpr std::string_view kTag = "EDGE_GNSS_MULTIPATH_BETWEEN";
  using Vertices = VertexList<VertexGnssMultipath, VertexGnssMultipath, VertexGnssMultipath>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssBiasBetween::before, EdgeGnssMultipathBetween>("before"),
                      field<&EdgeGnssBiasBetween::after, EdgeGnssMultipathBetween>("after")};
  }
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

/// Raw measurements of a GNSS receiver: states of its clock, its height and the errors of its
/// satellites, and the edges of pseudoranges and range rates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <waymark/core/graph/edge.hpp>
#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/types_se2/plugin_kit/gauss_markov_process.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::plugins::gnss_raw {

/// The clock of a receiver, in metres and m/s of light: what it adds to every pseudorange and to
/// every range rate.
struct VertexGnssClock : PlaneState {
  static constexpr std::string_view kTag = "VERTEX_GNSS_CLOCK";
  static constexpr std::array<std::string_view, 2> value_names() { return {"clock_bias", "clock_drift"}; }
};

/// Height of the antenna above the ellipsoid, m. It changes slowly.
struct VertexGnssHeight : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_GNSS_HEIGHT";
  static constexpr bool kHeight = true;
  static constexpr std::array<std::string_view, 1> value_names() { return {"antenna_height"}; }
};

/// What all pseudoranges of one system have more than those of the first system, m: one value for
/// a drive.
struct VertexGnssSystemBias : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_GNSS_SYSTEM_BIAS";
  static constexpr bool kDense = true;
  static constexpr std::array<std::string_view, 1> value_names() { return {"system_bias"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"m"}; }
};

/// A part of the error of one satellite's pseudoranges that lasts: for seconds (reflections), or for
/// an hour (orbit, ionosphere). Its unit is the standard deviation that each edge states.
struct VertexGnssSatelliteBias : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_GNSS_SATELLITE_BIAS";
  static constexpr std::array<std::string_view, 1> value_names() { return {"satellite_bias"}; }
};

/// The clock runs on: e = (b_to - b_from - dt (d_from + d_to) / 2, d_to - d_from).
struct EdgeGnssClockStep {
  static constexpr std::string_view kTag = "EDGE_GNSS_CLOCK_STEP";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexGnssClock, VertexGnssClock>;
  static constexpr auto fields() { return std::array{field<&EdgeGnssClockStep::dt>("dt")}; }

  template <typename T>
  Vector2<T> error(const Vector2<T>& from, const Vector2<T>& to) const {
    return {to[0] - from[0] - (from[1] + to[1]) * T(0.5 * dt), to[1] - from[1]};
  }

  double dt = 1;  ///< s
};

/// A height that wanders: e = h_to - h_from - change.
struct EdgeGnssHeightWalk {
  static constexpr std::string_view kTag = "EDGE_GNSS_HEIGHT_WALK";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexGnssHeight, VertexGnssHeight>;
  static constexpr auto fields() { return std::array{field<&EdgeGnssHeightWalk::change>("change")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& from, const T& to) const {
    return Eigen::Matrix<T, 1, 1>(T(to - from - T(change)));
  }

  double change = 0;  ///< the expected change, m; usually 0
};

/// One step of such a part.
struct EdgeGnssSatelliteBiasDecay : GaussMarkovDecay<EdgeGnssSatelliteBiasDecay, VertexGnssSatelliteBias> {
  static constexpr std::string_view kTag = "EDGE_GNSS_SATELLITE_BIAS_DECAY";
};

/// One pseudorange, corrected for the satellite's clock and the atmosphere:
///   e = |s - p| - |s| + clock bias + system bias + spread * late(lasting) + slow_spread * slow - measured.
/// late(x) = (exp(skew x) - 1) / skew, x without skew: a reflection is longer than the way it stands for, so
/// large errors are late ones (a shifted log-normal distribution with the median 0).
/// p is the antenna and s the satellite, in metres from a reference point near the antenna, along
/// the axes of the grid there and upwards; s is turned by the rotation of the Earth while the signal
/// travels. `measured` is the pseudorange minus |s|, so no digits are lost.
struct EdgeGnssPseudorange {
  static constexpr std::string_view kTag = "EDGE_GNSS_PSEUDORANGE";
  static constexpr std::string_view kForm = "range";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexGnssHeight, VertexGnssClock, VertexGnssSystemBias,
                              VertexGnssSatelliteBias, VertexGnssSatelliteBias>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssPseudorange::measured>("measured"),
                      field<&EdgeGnssPseudorange::satellite>("satellite"),
                      field<&EdgeGnssPseudorange::reference>("reference"),
                      field<&EdgeGnssPseudorange::ground>("ground"),
                      field<&EdgeGnssPseudorange::antenna>("antenna"),
                      field<&EdgeGnssPseudorange::spread>("spread"),
                      field<&EdgeGnssPseudorange::slow_spread>("slow_spread"),
                      field<&EdgeGnssPseudorange::skew>("skew")};
  }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const T& height, const Vector2<T>& clock,
                               const T& system, const T& lasting, const T& slow) const {
    using std::sqrt;
    const Vector2<T> at = pose.position + rotate(pose.heading, constant_vector<T>(antenna));
    const T x = (at[0] - T(reference[0])) * T(ground);
    const T y = (at[1] - T(reference[1])) * T(ground);
    const T z = height - T(reference[2]);
    // |s - p| - |s| = (|p|^2 - 2 s p) / (|s - p| + |s|)
    const T wx = T(satellite[0]) - x;
    const T wy = T(satellite[1]) - y;
    const T wz = T(satellite[2]) - z;
    constexpr double kTiny = 1e-12;  // the square of a micrometre keeps the root differentiable at 0
    const T range = sqrt(T(wx * wx + wy * wy + wz * wz + T(kTiny)));
    const T excess =
        (x * (x - T(2 * satellite[0])) + y * (y - T(2 * satellite[1])) + z * (z - T(2 * satellite[2]))) /
        (range + T(satellite.norm()));
    return Eigen::Matrix<T, 1, 1>(
        T(excess + clock[0] + system + late(lasting) * T(spread) + slow * T(slow_spread) - T(measured)));
  }

  template <typename T>
  T late(const T& lasting) const {
    using std::exp;
    if (!(skew > 0)) return lasting;
    const double bend = std::min(skew, kLargestSkew);
    const T curved = lasting < T(kLinearFrom) ? lasting : T(kLinearFrom);
    return (exp(T(curved * T(bend))) - T(1)) / T(bend) + (lasting - curved) * T(std::exp(bend * kLinearFrom));
  }

  /// late(x) goes on as a line from here, so that a step of the optimizer may be long.
  static constexpr double kLinearFrom = 4;
  static constexpr double kLargestSkew = 10;             ///< a larger one counts as this
  double measured = 0;                                   ///< pseudorange - |satellite|, m
  Eigen::Vector3d satellite = Eigen::Vector3d::UnitZ();  ///< m, from the reference point
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();   ///< x, y in the frame; height, m
  double ground = 1;                                     ///< metres on the ground per grid metre
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();     ///< in the body frame of the pose, m
  double spread = 0;       ///< standard deviation of the lasting part, m; with a skew, for small errors
  double slow_spread = 0;  ///< standard deviation of the slow part, m
  double skew = 0;         ///< of the lasting part, at least 0
};

/// One range rate (Doppler): e = clock drift - u (p_to - p_from) rate - measured, where u points from
/// the antenna p to the satellite, along the axes of the grid. The satellite's own motion is taken
/// off `measured`; the vehicle does not climb.
struct EdgeGnssRangeRate {
  static constexpr std::string_view kTag = "EDGE_GNSS_RANGE_RATE";
  static constexpr std::string_view kForm = "range rate";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexSe2, VertexGnssClock>;
  static constexpr auto fields() {
    return std::array{field<&EdgeGnssRangeRate::measured>("measured"),
                      field<&EdgeGnssRangeRate::direction>("direction"),
                      field<&EdgeGnssRangeRate::rate>("rate"), field<&EdgeGnssRangeRate::antenna>("antenna")};
  }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& from, const Pose2<T>& to, const Vector2<T>& clock) const {
    const Vector2<T> way = to.position + rotate(to.heading, constant_vector<T>(antenna)) - from.position -
                           rotate(from.heading, constant_vector<T>(antenna));
    const T closing = (way[0] * T(direction[0]) + way[1] * T(direction[1])) * T(rate);
    return Eigen::Matrix<T, 1, 1>(T(clock[1] - closing - T(measured)));
  }

  double measured = 0;                                  ///< m/s, without the satellite's motion
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  ///< horizontal part of u
  double rate = 1;                                      ///< metres on the ground per grid metre, over dt, 1/s
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();    ///< in the body frame, m
};

}  // namespace waymark::plugins::gnss_raw

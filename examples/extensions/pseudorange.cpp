// Edge types on one, two and three vertices: positioning by radio beacons whose clock the receiver does not
// share. Every error but the last is differentiated by dual numbers.
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "clock_bias.hpp"

using namespace waymark;

/// Unary: the clock was set to this, m. e = clock - measured.
struct EdgeClockSet {
  static constexpr std::string_view kTag = "EDGE_CLOCK_SET";
  static constexpr std::string_view kForm = "difference";  // printed beside chi2
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexClockBias>;
  static constexpr auto fields() { return std::array{field<&EdgeClockSet::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& clock) const {
    return Eigen::Matrix<T, 1, 1>(clock - T(measured));
  }
  double measured = 0;
};

/// Binary: the clock runs fast by a known rate, m/s. e = to - from - rate dt.
struct EdgeClockDrift {
  static constexpr std::string_view kTag = "EDGE_CLOCK_DRIFT";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexClockBias, VertexClockBias>;
  static constexpr auto fields() {
    return std::array{field<&EdgeClockDrift::rate>("rate"), field<&EdgeClockDrift::dt>("dt")};
  }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& from, const T& to) const {
    return Eigen::Matrix<T, 1, 1>(to - from - T(rate * dt));
  }
  double rate = 0, dt = 0;
};

/// Ternary, three types of vertices: a pose hears a beacon. e = |p_beacon - p| + clock - measured, m.
struct EdgePseudorange {
  static constexpr std::string_view kTag = "EDGE_PSEUDORANGE";
  static constexpr std::string_view kForm = "range";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexXy, VertexClockBias>;
  static constexpr bool kRelative = true;  // stays when pose and beacon undergo one rigid motion
  static constexpr auto fields() { return std::array{field<&EdgePseudorange::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& beacon, const T& clock) const {
    return Eigen::Matrix<T, 1, 1>(length(Vector2<T>(beacon - pose.position)) + clock - T(measured));
  }
  /// Derivatives by hand are optional, and checked: one Jacobian per vertex, by its tangent.
  void linearize(const Pose2<double>& pose, const Vector2<double>& beacon, double clock, ErrorVector<1>& e,
                 JacobianMatrix<1, 3>& by_pose, JacobianMatrix<1, 2>& by_beacon,
                 JacobianMatrix<1, 1>& by_clock) const {
    e = error(pose, beacon, clock);
    const Vector2<double> way = beacon - pose.position;
    const double range = length(way);
    const Vector2<double> direction = range > 0 ? Vector2<double>(way / range) : Vector2<double>(0, 0);
    by_pose << -direction[0], -direction[1], 0;
    by_beacon << direction[0], direction[1];
    by_clock << 1;
  }
  double measured = 0;
};

static void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexClockBias>();  // before the edges on it
  registry.add_edge<EdgeClockSet>();
  registry.add_edge<EdgeClockDrift>();
  registry.add_edge<EdgePseudorange>();
}
WAYMARK_PLUGIN(pseudorange, "1.0.0", register_types);

// Poses in space: vertex and edge of g2o's 3-D graphs, and an initial guess for them. Nothing of Waymark
// knows them; parsing, derivatives, optimisation, covariances and `check` follow from what stands here.
#include <map>
#include <queue>

#include <Eigen/Geometry>

#include <waymark/core/optimize/start.hpp>
#include <waymark/core/registry/plugin.hpp>

using namespace waymark;

template <typename T>
using Vector3of = Eigen::Matrix<T, 3, 1>;

/// A rotation as a unit quaternion (w, v), and a translation: x -> R x + t.
template <typename T>
struct Pose3 {
  Vector3of<T> translation;
  T w;
  Vector3of<T> v;
};

template <typename T>
Vector3of<T> turned(const T& w, const Vector3of<T>& v, const Vector3of<T>& x) {
  const Vector3of<T> cross = v.cross(x);
  return x + T(2.0) * (w * cross + v.cross(cross));
}

/// a b: b happens in the axes of a.
template <typename T>
Pose3<T> composed(const Pose3<T>& a, const Pose3<T>& b) {
  return {a.translation + turned(a.w, a.v, b.translation), T(a.w * b.w - a.v.dot(b.v)),
          Vector3of<T>(a.w * b.v + b.w * a.v + a.v.cross(b.v))};
}

/// a^-1 b: b as seen from a.
template <typename T>
Pose3<T> seen_from(const Pose3<T>& a, const Pose3<T>& b) {
  const Vector3of<T> back = -a.v;
  const Vector3of<T> way = b.translation - a.translation;
  return {turned(a.w, back, way), T(a.w * b.w + a.v.dot(b.v)),
          Vector3of<T>(a.w * b.v - b.w * a.v - a.v.cross(b.v))};
}

template <typename T>
Pose3<T> from_numbers(const double* n) {  // x y z qx qy qz qw, as in g2o
  return {Vector3of<T>(T(n[0]), T(n[1]), T(n[2])), T(n[6]), Vector3of<T>(T(n[3]), T(n[4]), T(n[5]))};
}

/// Normalises the quaternion; one of zeros becomes no rotation. A length that only rounding has changed stays,
/// so that numbers come back from a file, and from a step of 0, to the bit.
static void to_numbers(const Pose3<double>& pose, double* n) {
  const double length = Eigen::Vector4d(pose.w, pose.v[0], pose.v[1], pose.v[2]).stableNorm();
  const double norm = length > 0 && std::abs(length - 1) > 1e-15 ? length : 1;
  for (int i = 0; i < 3; ++i) {
    n[i] = pose.translation[i];
    n[3 + i] = pose.v[i] / norm;
  }
  n[6] = length > 0 ? pose.w / norm : 1;
}

/// Steps are in the axes of the pose: a translation, and twice the Gibbs vector of a rotation (its axis times
/// 2 tan(angle / 2)), which is smooth at 0 and needs no branch.
struct VertexSe3 {
  static constexpr std::string_view kTag = "VERTEX_SE3:QUAT";
  static constexpr int kValueSize = 7;
  static constexpr int kTangentSize = 6;
  static constexpr std::array<std::string_view, 7> value_names() {
    return {"x", "y", "z", "qx", "qy", "qz", "qw"};
  }

  template <typename T>
  static Pose3<T> at(const double* value, const T* delta) {
    const Vector3of<T> half = Vector3of<T>(delta[3], delta[4], delta[5]) * T(0.5);
    using std::sqrt;
    const T inverse = T(1.0) / sqrt(T(T(1.0) + half.squaredNorm()));
    return composed(from_numbers<T>(value), Pose3<T>{Vector3of<T>(delta[0], delta[1], delta[2]), inverse,
                                                     Vector3of<T>(half * inverse)});
  }
  static void retract(double* value, const double* delta) { to_numbers(at<double>(value, delta), value); }
  static void local(const double* from, const double* to, double* delta) {
    const Pose3<double> step = seen_from(from_numbers<double>(from), from_numbers<double>(to));
    for (int i = 0; i < 3; ++i) {
      delta[i] = step.translation[i];
      delta[3 + i] = 2 * step.v[i] / step.w;
    }
  }
};

/// The error of g2o: translation and vector part of Z^-1 (A^-1 B).
struct EdgeSe3 {
  static constexpr std::string_view kTag = "EDGE_SE3:QUAT";
  static constexpr int kErrorDimension = 6;
  static constexpr std::string_view kForm = "(t, vector part)";
  using Vertices = VertexList<VertexSe3, VertexSe3>;
  static constexpr auto fields() { return std::array{field<&EdgeSe3::measured>("measured")}; }

  void prepare() {  // files round their quaternions
    to_numbers(from_numbers<double>(measured.data()), measured.data());
  }
  template <typename T>
  Eigen::Matrix<T, 6, 1> error(const Pose3<T>& a, const Pose3<T>& b) const {
    const Pose3<T> off = seen_from(from_numbers<T>(measured.data()), seen_from(a, b));
    const T sign = off.w < T(0.0) ? T(-1.0) : T(1.0);  // q and -q are one rotation
    Eigen::Matrix<T, 6, 1> e;
    e << off.translation, Vector3of<T>(sign * off.v);
    return e;
  }
  Eigen::Matrix<double, 7, 1> measured = (Eigen::Matrix<double, 7, 1>() << 0, 0, 0, 0, 0, 0, 1).finished();
};

/// Chains the edges from the first vertex of each part, nearest first.
static InitialValues chained(const Graph& graph) {
  InitialValues start;
  start.values = graph.values();
  std::multimap<VertexIndex, std::pair<VertexIndex, Pose3<double>>> motions;
  std::vector<double> fields;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag != EdgeSe3::kTag) continue;
    for (std::size_t e = 0; e < graph.batch(b).size(); ++e) {
      fields.clear();
      graph.batch(b).fields(e, fields);
      const Pose3<double> motion = from_numbers<double>(fields.data());
      const auto vertices = graph.batch(b).vertices(e);
      motions.emplace(vertices[0], std::pair(vertices[1], motion));
      const Pose3<double> none{Eigen::Vector3d::Zero(), 1, Eigen::Vector3d::Zero()};
      motions.emplace(vertices[1], std::pair(vertices[0], seen_from(motion, none)));
    }
  }
  if (motions.empty()) return {.values = {}, .note = "no EDGE_SE3:QUAT is there"};
  std::vector<char> placed(graph.vertex_count(), 0);
  const auto numbers = [&](VertexIndex v) {
    return start.values.data() + graph.offsets()[static_cast<std::size_t>(v)];
  };
  for (const auto& [root, unused] : motions) {
    std::queue<VertexIndex> open;
    if (placed[static_cast<std::size_t>(root)]++ == 0) open.push(root);
    for (; !open.empty(); open.pop()) {
      const auto [first, last] = motions.equal_range(open.front());
      for (auto motion = first; motion != last; ++motion) {
        const VertexIndex to = motion->second.first;
        if (placed[static_cast<std::size_t>(to)]++ != 0) continue;
        if (!graph.fixed(to))
          to_numbers(composed(from_numbers<double>(numbers(open.front())), motion->second.second),
                     numbers(to));
        open.push(to);
      }
    }
  }
  return start;
}

static void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexSe3>();
  registry.add_edge<EdgeSe3>();
  registry.add_start({"chain_in_space", "EDGE_SE3:QUAT chained from the first vertex", chained});
}
WAYMARK_PLUGIN(se3, "1.0.0", register_types);

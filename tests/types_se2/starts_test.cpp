// Every registered start on graphs whose measurements are exact: whatever the values in the file,
// the start is the solution itself, up to the motion that the edges cannot see.
#include <random>

#include <catch2/catch.hpp>

#include <waymark/plugins/landmarks/landmarks.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace starts_test {

using namespace waymark;
using namespace waymark_test;

namespace {

using Pose = Pose2<double>;

/// The distance of a point from a sensor beside the pose, m.
struct EdgeTestRange {
  static constexpr std::string_view kTag = "EDGE_TEST_RANGE";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr auto fields() {
    return std::array{field<&EdgeTestRange::measured>("measured"), field<&EdgeTestRange::sensor>("sensor")};
  }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& point) const {
    using std::sqrt;
    const Vector2<T> d =
        rotate_back(pose.heading, Vector2<T>(point - pose.position)) - constant_vector<T>(sensor);
    return Eigen::Matrix<T, 1, 1>(sqrt(d.squaredNorm()) - T(measured));
  }
  [[nodiscard]] Sight sight() const { return Sight::of_range_alone(measured, sensor); }

  double measured = 0;
  Eigen::Vector2d sensor = Eigen::Vector2d::Zero();
};

/// A spiral of several turns, 1 m between poses.
std::vector<Pose> spiral(int poses) {
  std::vector<Pose> track{Pose(2, -1, 0.4)};
  for (int i = 1; i < poses; ++i) {
    track.push_back(compose(track.back(), se2_exp<double>(Eigen::Vector3d(1, 0, 0.6 - 0.004 * i))));
  }
  return track;
}

Eigen::Vector3d seen(const Pose& from, const Pose& to) {
  const Pose z = between(from, to);
  return {z.position[0], z.position[1], wrap_angle(z.heading)};
}

void add_wild_pose(Graph& graph, VertexId id, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = 1000 * uniform(random);
  const double y = 1000 * uniform(random);
  graph.add_vertex<VertexSe2>(id, {x, y, 3.14 * uniform(random)});
}

/// The chain of a track and, every seventh pose, an edge back to the pose ten before it.
template <typename EdgeType>
void join_track(Graph& graph, const std::vector<Pose>& track, VertexIndex first = 0) {
  const Eigen::Matrix3d information = pose_information(0.1, 0.01);
  const auto join = [&](std::size_t from, std::size_t to) {
    const VertexIndex a = first + static_cast<VertexIndex>(from);
    const VertexIndex b = first + static_cast<VertexIndex>(to);
    graph.add_edge(EdgeType{seen(track[from], track[to])}, {a, b}, information);
  };
  for (std::size_t i = 1; i < track.size(); ++i) join(i - 1, i);
  for (std::size_t i = 10; i < track.size(); i += 7) join(i, i - 10);
}

template <typename EdgeType = EdgeSe2>
Graph wild_track(const std::vector<Pose>& track) {
  Graph graph;
  std::mt19937_64 random(3);
  for (std::size_t i = 0; i < track.size(); ++i) add_wild_pose(graph, VertexId(i), random);
  join_track<EdgeType>(graph, track);
  return graph;
}

std::vector<std::string> start_names(const TypeRegistry& registry) {
  std::vector<std::string> names;
  for (const auto& [start, origin] : registry.starts()) names.push_back(start.name);
  return names;
}

Graph started(const Graph& graph, const TypeRegistry& registry, const std::string& name) {
  Graph result = graph;
  const InitialValues start = registry.make_start(name, graph);
  INFO(name << ": " << start.note);
  REQUIRE(start.values.size() == graph.values().size());
  result.set_values(start.values);
  return result;
}

double distance(const Graph& graph, VertexIndex v, const Pose& truth) {
  const auto value = graph.value(v);
  return std::hypot(value[0] - truth.position[0], value[1] - truth.position[1]) +
         std::abs(wrap_angle(value[2] - truth.heading));
}

}  // namespace

TEST_CASE("starts: exact loops of several turns are solved, and the first vertex stays") {
  const TypeRegistry registry = full_registry();
  const auto track = spiral(120);
  const Graph graphs[] = {wild_track<EdgeSe2>(track), wild_track<EdgeSe2Log>(track)};
  for (const Graph& graph : graphs) {
    CHECK(graph.chi2() > 1e6);
    for (const std::string& name : start_names(registry)) {
      const Graph start = started(graph, registry, name);
      INFO(name);
      CHECK(start.chi2() < 1e-12);
      for (std::size_t k = 0; k < 3; ++k) CHECK(start.value(0)[k] == graph.value(0)[k]);
    }
  }
}

TEST_CASE("starts: an edge type of a plugin is followed without knowing it") {
  // EDGE_SE2_ODOMETRY has no measured pose among its fields: speed, yaw rate and time imply it.
  const TypeRegistry registry = full_registry();
  Graph graph;
  std::mt19937_64 random(3);
  std::vector<VertexIndex> chain;
  std::vector<Interval> intervals;
  for (int i = 0; i < 200; ++i) {
    add_wild_pose(graph, VertexId{i}, random);
    chain.push_back(i);
    if (i > 0) intervals.push_back({.speed_mps = 8, .yaw_rate_radps = 3.0 + 0.02 * i, .dt_s = 0.4});
  }
  registry.make_odometry_model("constant_twist")->extend({{{}, chain, intervals}}, graph);
  REQUIRE(graph.edge_type(0).tag == "EDGE_SE2_ODOMETRY");
  for (const std::string& name : start_names(registry)) {
    INFO(name);
    CHECK(started(graph, registry, name).chi2() < 1e-12);
  }
}

TEST_CASE("starts: points are placed from the poses that saw them") {
  const TypeRegistry registry = full_registry();
  const auto track = spiral(40);
  Graph graph = wild_track(track);
  const Eigen::Vector2d point(7, 9);
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1000}, {-400, 500});
  for (const int from : {3, 20, 33}) {
    const Pose& pose = track[static_cast<std::size_t>(from)];
    const Eigen::Vector2d z = rotate_back(pose.heading, Eigen::Vector2d(point - pose.position));
    graph.add_edge(EdgeSe2Xy{z}, {from, landmark}, 25 * Eigen::Matrix2d::Identity());
  }
  for (const std::string& name : start_names(registry)) {
    INFO(name);
    CHECK(started(graph, registry, name).chi2() < 1e-12);
  }
}

TEST_CASE("starts: a point seen by range and bearing, or by bearings alone, is placed") {
  using plugins::landmarks::EdgeSe2XyRangeBearing;
  const TypeRegistry registry = full_registry();
  const auto track = spiral(40);
  const Eigen::Vector2d point(7, 9);
  const Eigen::Vector2d sensor(1.5, -0.5);
  Graph ranges = wild_track(track);
  Graph bearings = ranges;
  const VertexIndex by_range = ranges.add_vertex<VertexXy>(VertexId{1000}, {-400, 500});
  const VertexIndex by_bearing = bearings.add_vertex<VertexXy>(VertexId{1000}, {-400, 500});
  for (const int from : {3, 20, 27, 33}) {
    const Pose& pose = track[static_cast<std::size_t>(from)];
    const Eigen::Vector2d z = rotate_back(pose.heading, Eigen::Vector2d(point - pose.position));
    const Eigen::Vector2d d = z - sensor;
    const EdgeSe2XyRangeBearing seen{{d.norm(), std::atan2(d[1], d[0])}, sensor};
    ranges.add_edge(seen, {from, by_range}, 25 * Eigen::Matrix2d::Identity());
    bearings.add_edge(EdgeBearingSe2Xy{std::atan2(z[1], z[0])}, {from, by_bearing},
                      Eigen::Matrix<double, 1, 1>::Constant(2500));
  }
  for (const std::string& name : start_names(registry)) {
    INFO(name);
    CHECK(started(ranges, registry, name).chi2() < 1e-12);
    CHECK(started(bearings, registry, name).chi2() < 1e-12);
  }
}

TEST_CASE("starts: a point of ranges alone comes to where their circles meet, whatever some false ones say") {
  const TypeRegistry registry = full_registry();
  const auto track = spiral(40);
  const Eigen::Vector2d point(7, 9);
  const Eigen::Vector2d sensor(1.5, -0.5);
  const Graph poses = wild_track(track);
  const auto with_ranges = [&](std::initializer_list<int> from_poses, int false_ones) {
    Graph graph = poses;
    const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1000}, {-400, 500});
    for (const int from : from_poses) {
      const Pose& pose = track[static_cast<std::size_t>(from)];
      const Eigen::Vector2d d = rotate_back(pose.heading, Eigen::Vector2d(point - pose.position)) - sensor;
      const double wrong = false_ones-- > 0 ? 12 : 0;
      graph.add_edge(EdgeTestRange{d.norm() + wrong, sensor}, {from, landmark},
                     Eigen::Matrix<double, 1, 1>::Constant(25));
    }
    return graph;
  };
  for (const std::string& name : start_names(registry)) {
    INFO(name);
    CHECK(started(with_ranges({3, 20, 33}, 0), registry, name).chi2() < 1e-9);
    // Two false ranges of seven cost their own chi2, and nothing else.
    CHECK(started(with_ranges({30, 3, 8, 14, 20, 27, 33}, 2), registry, name).chi2() ==
          Approx(2 * 25 * 12 * 12).epsilon(1e-6));
  }
}

TEST_CASE("starts: false sightings of a point do not move it") {
  // The trees take the median; the linear start is one of least squares.
  const TypeRegistry registry = full_registry();
  const auto track = spiral(40);
  const Eigen::Vector2d point(7, 9);
  Graph graph = wild_track(track);
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1000}, {-400, 500});
  for (const int from : {3, 8, 20, 27, 33}) {
    const Pose& pose = track[static_cast<std::size_t>(from)];
    const Eigen::Vector2d z = rotate_back(pose.heading, Eigen::Vector2d(point - pose.position));
    const Eigen::Vector2d measured = from == 3 || from == 27 ? Eigen::Vector2d(-80, 30) : z;
    graph.add_edge(EdgeSe2Xy{measured}, {from, landmark}, Eigen::Matrix2d::Identity());
  }
  for (const std::string name : {"odometry", "spanning_tree"}) {
    const Graph start = started(graph, registry, name);
    const auto& root = start.value(0);
    const Pose moved =
        compose(Pose(root[0], root[1], root[2]), between(track[0], Pose(point[0], point[1], 0)));
    CHECK(start.value(landmark)[0] == Approx(moved.position[0]));
    CHECK(start.value(landmark)[1] == Approx(moved.position[1]));
  }
}

TEST_CASE("starts: where an edge type says that it sees a point, its error is zero") {
  const TypeRegistry registry = full_registry();
  std::size_t types = 0;
  for (const auto& [type, origin] : registry.edges()) {
    if (type.arity != 2 || type.vertex_tags[0] != VertexSe2::kTag || type.vertex_tags[1] != VertexXy::kTag)
      continue;
    Graph graph;
    graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
    graph.add_vertex<VertexXy>(VertexId{1}, {0, 0});
    const std::vector<double> fields(static_cast<std::size_t>(type.field_size()), 0.7);
    const std::array vertices{VertexIndex{0}, VertexIndex{1}};
    graph.add_edge(type, vertices, fields,
                   Eigen::MatrixXd::Identity(type.error_dimension, type.error_dimension));
    const auto sight = graph.batch(0).sight(0);
    INFO(type.tag);
    REQUIRE(sight);
    graph.set_value(1, std::array{sight->place()[0], sight->place()[1]});
    CHECK(graph.chi2() < 1e-20);
    ++types;
  }
  CHECK(types == 4);
}

TEST_CASE("starts: the linear start keeps the direction of a heading that contradictions shorten") {
  // Two edges turn by 0 and by nearly pi. The sum of their directions is 5e-9 long and lies halfway. If it is
  // exactly pi, nothing is halfway, and one of both edges decides.
  const TypeRegistry registry = full_registry();
  for (const double short_of_pi : {1e-8, 0.0}) {
    Graph graph;
    for (int id = 0; id < 3; ++id) graph.add_vertex<VertexSe2>(VertexId{id}, {0, 0, 0});
    const Eigen::Matrix3d information = pose_information(0.1, 0.1);
    const double turn = std::numbers::pi - short_of_pi;
    graph.add_edge(EdgeSe2{{1, 0, 0}}, {0, 1}, information);
    graph.add_edge(EdgeSe2{{1, 0, turn}}, {0, 1}, information);
    graph.add_edge(EdgeSe2{{1, 0, 0.25}}, {1, 2}, information);
    const Graph start = started(graph, registry, "linear");
    const double heading = start.value(1)[2];
    INFO(short_of_pi << ": " << heading);
    if (short_of_pi > 0)
      CHECK(heading == Approx(turn / 2).margin(1e-6));
    else
      CHECK((std::abs(heading) < 1e-9 || std::abs(wrap_angle(heading - turn)) < 1e-9));
    CHECK(wrap_angle(start.value(2)[2] - heading - 0.25) == Approx(0).margin(1e-6));
  }
}

TEST_CASE("starts: each part of a graph keeps the place of its first vertex") {
  const TypeRegistry registry = full_registry();
  const auto track = spiral(50);
  Graph graph = wild_track(track);
  std::mt19937_64 random(4);
  for (int id = 50; id < 100; ++id) add_wild_pose(graph, VertexId{id}, random);
  join_track<EdgeSe2>(graph, track, 50);
  for (const std::string& name : start_names(registry)) {
    const Graph start = started(graph, registry, name);
    INFO(name);
    CHECK(start.chi2() < 1e-12);
    for (std::size_t k = 0; k < 3; ++k) CHECK(start.value(50)[k] == graph.value(50)[k]);
  }
  CHECK(registry.make_start("odometry", graph).apart == 50);
  CHECK(registry.make_start("spanning_tree", graph).apart == 50);
}

TEST_CASE("starts: a fixed vertex anchors its part, wherever in the order it is") {
  const TypeRegistry registry = full_registry();
  const auto track = spiral(80);
  Graph graph = wild_track(track);
  const Pose& truth = track[37];
  graph.set_value(37, std::array{truth.position[0], truth.position[1], wrap_angle(truth.heading)});
  graph.set_fixed(37, true);
  for (const std::string& name : start_names(registry)) {
    const Graph start = started(graph, registry, name);
    INFO(name);
    for (VertexIndex v = 0; v < 80; ++v) CHECK(distance(start, v, track[static_cast<std::size_t>(v)]) < 1e-9);
  }
}

TEST_CASE("starts: the linear start takes a prior on a pose for what it says") {
  const TypeRegistry registry = full_registry();
  const auto track = spiral(80);
  Graph graph = wild_track(track);
  graph.add_edge(EdgePriorSe2{seen(Pose(), track[60])}, {60}, pose_information(0.5, 0.05));
  const Graph start = started(graph, registry, "linear");
  for (VertexIndex v = 0; v < 80; ++v) CHECK(distance(start, v, track[static_cast<std::size_t>(v)]) < 1e-7);
}

TEST_CASE("starts: the linear start finds a drive's headings from its fixes, under every modeling") {
  // Far from the frame's origin, as in UTM; antenna off the axle; the values in the graph are
  // nonsense.
  const TypeRegistry registry = full_registry();
  const Eigen::Vector2d far(670000, 5700000);
  const Eigen::Vector2d antenna(1.2, -0.4);
  auto track = spiral(300);
  for (Pose& pose : track) pose.position += far;
  std::vector<Fix> fixes;
  for (std::size_t i = 0; i < track.size(); i += 10) {
    Fix fix;
    fix.position = track[i].position + rotate(track[i].heading, antenna);
    fix.covariance = Eigen::Matrix2d::Identity() * 4;
    fix.vertex = VertexId(i);
    fixes.push_back(fix);
  }
  const std::vector<FixMoment> standing(fixes.size(), {antenna});  // the factor of a time offset
  for (const auto& [modeling, origin] : registry.gnss_modelings()) {
    Graph graph = wild_track(track);
    registry.make_gnss_modeling(modeling.name)->extend({fixes, standing, antenna}, graph);
    const Graph start = started(graph, registry, "linear");
    INFO(modeling.name);
    double worst = 0;
    for (VertexIndex v = 0; v < 300; ++v) {
      worst = std::max(worst, distance(start, v, track[static_cast<std::size_t>(v)]));
    }
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("starts: what the edges do not determine is refused with a reason") {
  const TypeRegistry registry = full_registry();
  Graph lonely;
  lonely.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 3});
  for (const std::string name : {"odometry", "spanning_tree"}) {
    const InitialValues start = registry.make_start(name, lonely);
    CHECK(start.values.empty());
    CHECK(start.note == "no edge gives the motion from one pose to another");
  }
  // One fix places a chain and leaves it free to turn.
  Graph turning = wild_track(spiral(10));
  const VertexIndex origin = turning.add_vertex<VertexSe2>(VertexId{100}, {0, 0, 0});
  turning.set_fixed(origin, true);
  turning.add_edge(EdgeGnssPosition{{5, 6}, {0, 0}}, {origin, 4}, Eigen::Matrix2d::Identity());
  const InitialValues start = registry.make_start("linear", turning);
  CHECK(start.values.empty());
  CHECK(start.note == "the edges do not determine all headings");
}

}  // namespace starts_test

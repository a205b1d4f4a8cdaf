// What vertex types, edge types and losses promise, and how a broken promise is found.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/graph/checks/finite_check.hpp>
#include <waymark/core/graph/checks/vertex_type_check.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace promises_test {

using namespace waymark;
using Catch::Matchers::Contains;
using waymark_test::full_registry;

namespace {

/// The difference of two positions in the frame changes if both vertices turn together.
template <bool kSays>
struct EdgeDifference {
  static constexpr std::string_view kTag = kSays ? "EDGE_SAYS_RELATIVE" : "EDGE_DIFFERENCE";
  static constexpr int kErrorDimension = 2;
  static constexpr bool kRelative = kSays;
  using Vertices = VertexList<VertexSe2, VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeDifference::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Pose2<T>& a, const Pose2<T>& b) const {
    return b.position - a.position - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured{0, 0};
};

/// The position of a pose in the frame.
struct EdgeFixSaysRelative {
  static constexpr std::string_view kTag = "EDGE_FIX_SAYS_RELATIVE";
  static constexpr int kErrorDimension = 2;
  static constexpr bool kRelative = true;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeFixSaysRelative::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Pose2<T>& pose) const {
    return pose.position - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured{0, 0};
};

/// A point from a pose, in the axes of the frame: only a turn shows that it is not relative.
struct EdgePointSaysRelative {
  static constexpr std::string_view kTag = "EDGE_POINT_SAYS_RELATIVE";
  static constexpr int kErrorDimension = 2;
  static constexpr bool kRelative = true;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgePointSaysRelative::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Pose2<T>& pose, const Vector2<T>& point) const {
    return point - pose.position - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured{0, 0};
};

/// The direction in which a pose sees a point, on its right hand where it says left.
template <bool kTells>
struct EdgeOfSight {
  static constexpr std::string_view kTag = kTells ? "EDGE_TRUE_SIGHT" : "EDGE_WRONG_SIGHT";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgeOfSight::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Pose2<T>& pose, const Vector2<T>& point) const {
    return rotate_back(pose.heading, Vector2<T>(point - pose.position)) - constant_vector<T>(measured);
  }
  [[nodiscard]] Sight sight() const {
    return Sight::of_place(kTells ? measured : Eigen::Vector2d(measured[0], -measured[1]));
  }
  Eigen::Vector2d measured{0, 0};
};

/// Its error has no derivative where both vertices are, and throws beyond a distance.
struct EdgeFragile {
  static constexpr std::string_view kTag = "EDGE_FRAGILE";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeFragile::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    using std::sqrt;
    if (pose.position[0] > T(100.0)) throw std::out_of_range("no such place");
    return Eigen::Matrix<T, 1, 1>(sqrt(pose.position.squaredNorm()) - T(measured));
  }
  double measured = 0;
};

/// A unit vector of the plane: two numbers with one degree of freedom.
struct VertexDirection {
  static constexpr std::string_view kTag = "VERTEX_TEST_DIRECTION";
  static constexpr int kValueSize = 2;
  static constexpr int kTangentSize = 1;
  static constexpr std::array<std::string_view, 2> value_names() { return {"cosine", "sine"}; }
  template <typename T>
  static Vector2<T> at(const double* value, const T* delta) {
    return rotate(delta[0], Vector2<T>(T(value[0]), T(value[1])));
  }
  static void retract(double* value, const double* delta) {
    const Eigen::Vector2d turned = at<double>(value, delta) / std::hypot(value[0], value[1]);
    std::copy_n(turned.data(), 2, value);
  }
  static void local(const double* from, const double* to, double* delta) {
    delta[0] = std::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
  }
};

/// Its error is not finite for a vector that is no direction.
struct EdgeDirection {
  static constexpr std::string_view kTag = "EDGE_TEST_DIRECTION";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexDirection, VertexDirection>;
  static constexpr auto fields() { return std::array{field<&EdgeDirection::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Vector2<T>& a, const Vector2<T>& b) const {
    const bool valid = is_unit(a) && is_unit(b);
    const T sine = a[0] * b[1] - a[1] * b[0];
    return Eigen::Matrix<T, 1, 1>(valid ? T(sine - measured) : T(std::nan("")));
  }
  template <typename T>
  static bool is_unit(const Vector2<T>& v) {
    using std::abs;
    return abs(T(v.squaredNorm() - T(1.0))) < T(1e-12);
  }
  double measured = 0;
};

VertexType of_angle() {
  VertexType type;
  type.tag = "VERTEX_TEST_ANGLE";
  type.value_size = type.tangent_size = 1;
  type.value_names = {"angle"};
  type.retract = [](double* value, const double* delta) {
    value[0] = std::remainder(value[0] + delta[0], 2 * M_PI);
  };
  type.local = [](const double* from, const double* to, double* delta) {
    delta[0] = std::remainder(to[0] - from[0], 2 * M_PI);
  };
  return type;
}

Graph poses_with(double x) {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{1}, {5, 5, 0});
  graph.add_vertex<VertexSe2>(VertexId{2}, {x, 0, 0});
  graph.set_fixed(0, true);
  graph.add_edge(EdgeFragile{4}, {0}, Eigen::Matrix<double, 1, 1>(1));
  graph.add_edge(EdgeFragile{4}, {1}, Eigen::Matrix<double, 1, 1>(1));
  return graph;
}

Summary optimise(Graph& graph) {
  const TypeRegistry registry = full_registry();
  return optimize(graph, *registry.make_algorithm("dogleg"), *registry.make_linear_solver("eigen"), {});
}

}  // namespace

TEST_CASE("promises: every registered type and loss keeps them") {
  const TypeRegistry registry = full_registry();
  for (const auto& [type, origin] : registry.vertices()) {
    INFO(type.tag);
    CHECK(broken_promises(type) == std::vector<std::string>());
  }
  for (const auto& [type, origin] : registry.losses()) {
    INFO(type.name);
    CHECK(broken_promises(type) == std::vector<std::string>());
  }
}

TEST_CASE("promises: kRelative of an error that is not relative is found, whatever vertices it joins") {
  TypeRegistry registry = full_registry();
  registry.add_edge<EdgeFixSaysRelative>();
  registry.add_edge<EdgePointSaysRelative>();
  registry.add_edge<EdgeDifference<true>>();
  for (const char* tag : {"EDGE_FIX_SAYS_RELATIVE", "EDGE_POINT_SAYS_RELATIVE", "EDGE_SAYS_RELATIVE"}) {
    INFO(tag);
    const EdgeTypeCheck liar = check_edge_type(registry, *registry.find_edge(tag));
    CHECK(liar.worst.error < kGradientTolerance);  // its Jacobians are right
    CHECK(liar.relative.error > 0.1);
    CHECK_FALSE(liar.sound());
  }
  int relative = 0;
  const TypeRegistry sound = full_registry();
  for (const auto& [type, origin] : sound.edges()) {
    INFO(type.tag);
    const EdgeTypeCheck check = check_edge_type(sound, type);
    relative += check.relative.edges > 0 ? 1 : 0;
    CHECK(check.relative.error < 1e-12);
  }
  CHECK(relative >= 6);
}

TEST_CASE("promises: an edge of a graph that is not relative is named, with the motion and by how much") {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{7}, {5, 5, 1});
  graph.add_vertex<VertexXy>(VertexId{9}, {8, 9});
  graph.add_edge(EdgeFixSaysRelative{}, {0}, Eigen::Matrix2d::Identity());
  graph.add_edge(EdgePointSaysRelative{}, {0, 1}, Eigen::Matrix2d::Identity());
  const RelativeCheck fix = check_relative(graph, 0, 50);
  CHECK(fix.edges == 1);
  CHECK_THAT(describe(graph, 0, fix),
             Contains("EDGE_FIX_SAYS_RELATIVE number 1 (vertex 7): it says kRelative, but row 0 of its error "
                      "changes by 1 per m if all its vertices move along x"));
  // A turn about the pose moves the point, 3 m and 4 m away, by (-4, 3) m per rad.
  const RelativeCheck point = check_relative(graph, 1, 50);
  CHECK(point.motion == 2);
  CHECK(std::abs(point.change) == Approx(4));
  CHECK_THAT(describe(graph, 1, point), Contains("(vertices 7 and 9)") && Contains("-4 per rad"));
}

TEST_CASE("promises: an edge that says kRelative and is not is found by its normal equations too") {
  TypeRegistry registry = full_registry();
  registry.add_edge<EdgeDifference<true>>();
  registry.add_edge<EdgeDifference<false>>();
  const EdgeTypeCheck liar = check_edge_type(registry, *registry.find_edge("EDGE_SAYS_RELATIVE"));
  CHECK(liar.worst.error < kGradientTolerance);  // its Jacobians are right
  CHECK(liar.normal_error > 0.01);
  CHECK_FALSE(liar.sound());
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_DIFFERENCE")).sound());
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_SE2")).normal_error < 1e-12);
}

TEST_CASE("promises: a sight at which the error is not zero is found") {
  TypeRegistry registry = full_registry();
  registry.add_edge<EdgeOfSight<true>>();
  registry.add_edge<EdgeOfSight<false>>();
  const EdgeTypeCheck liar = check_edge_type(registry, *registry.find_edge("EDGE_WRONG_SIGHT"));
  CHECK(liar.worst.error < kGradientTolerance);
  CHECK(liar.sight_error > 0.2);  // twice the least measurement
  CHECK_FALSE(liar.sound());
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_TRUE_SIGHT")).sound());
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_BEARING_SE2_XY")).sight_error < 1e-12);
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_SE2_XY_RANGE_BEARING")).sight_error < 1e-12);
}

TEST_CASE(
    "promises: edges are tried at valid values of vertices with fewer degrees of freedom than numbers") {
  TypeRegistry registry = full_registry();
  registry.add_vertex<VertexDirection>();
  registry.add_edge<EdgeDirection>();
  CHECK(broken_promises(*registry.find_vertex("VERTEX_TEST_DIRECTION")).empty());
  const EdgeTypeCheck check = check_edge_type(registry, *registry.find_edge("EDGE_TEST_DIRECTION"));
  CHECK(check.not_finite == 0);
  CHECK(check.sound());
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_GAUSSIAN_PRIOR")).sound());  // it joins all types
}

TEST_CASE("promises: vertices of such a type are as near to each other as the scenario says") {
  TypeRegistry registry = full_registry();
  registry.add_vertex<VertexDirection>();
  registry.add_edge<EdgeDirection>();
  for (const EdgeScenario& scenario : edge_scenarios()) {
    INFO(scenario.name);
    std::mt19937_64 random(3);
    const Graph graph = single_edge(registry, *registry.find_edge("EDGE_TEST_DIRECTION"), scenario, random);
    double angle = 0;
    VertexDirection::local(graph.value(0).data(), graph.value(1).data(), &angle);
    CHECK(std::abs(angle) <= 2 * scenario.place + 1e-15);
    CHECK(std::hypot(graph.value(0)[0], graph.value(0)[1]) == Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("promises: wrong charts are named") {
  CHECK(broken_promises(of_angle()).empty());
  VertexType linear = of_angle();
  linear.linear_chart = true;  // up to full turns, as for headings
  CHECK(broken_promises(linear).empty());
  linear.retract = [](double* value, const double* delta) { value[0] += std::sin(delta[0]); };
  linear.local = [](const double* from, const double* to, double* delta) {
    delta[0] = std::asin(to[0] - from[0]);
  };
  REQUIRE_FALSE(broken_promises(linear).empty());
  CHECK_THAT(broken_promises(linear).front(), Contains("kLinearChart"));
  VertexType turned = of_angle();
  turned.local = [](const double* from, const double* to, double* delta) { delta[0] = from[0] - to[0]; };
  CHECK_THAT(broken_promises(turned).front(), Contains("local is not the inverse of retract"));
  VertexType jumping = of_angle();
  jumping.retract = [](double* value, const double* delta) { value[0] += delta[0] + 0.1; };
  CHECK_THAT(broken_promises(jumping).front(), Contains("retract by 0 changes a value"));
}

TEST_CASE("promises: wrong losses are named") {
  const auto fair = [](double s, double c) {
    const double r = std::sqrt(s) / c;
    const double weight = 1 / (1 + r);
    const double curvature = s > 0 ? -weight * weight / (2 * c * std::sqrt(s)) : -1e9;
    return LossValue{2 * c * c * (r - std::log1p(r)), weight, curvature};
  };
  CHECK(broken_promises(LossType{"fair", fair, ""}).empty());
  const auto halved = [](double s, double c) { return LossValue{0.5 * s, 0.5, 0 * c}; };
  CHECK_THAT(broken_promises(LossType{"halved", halved, ""}).front(), Contains("rho'(0)"));
  const auto wrong_weight = [](double s, double c) { return LossValue{s, 1 / (1 + s / c), -1 / c}; };
  CHECK_THAT(broken_promises(LossType{"wrong", wrong_weight, ""}).front(), Contains("rho' by differences"));
  const auto nan_above_one = [](double s, double) { return LossValue{s > 1 ? std::nan("") : s, 1, 0}; };
  CHECK_THAT(broken_promises(LossType{"nan", nan_above_one, ""}).front(),
             Contains("rho is nan") && Contains("must be finite"));
  const auto throwing = [](double, double) -> LossValue { throw std::runtime_error("no table"); };
  CHECK_THROWS_MATCHES(broken_promises(LossType{"throwing", throwing, ""}), PluginError,
                       Catch::Matchers::Message("loss 'throwing': threw: no table"));
}

TEST_CASE("finite: a Jacobian that is not finite is no minimum, and its edge is named") {
  Graph graph = poses_with(0);  // the root has no derivative at the origin
  const Summary summary = optimise(graph);
  CHECK(summary.termination == Termination::non_finite);
  CHECK_THAT(summary.message, Contains("EDGE_FRAGILE number 2 (vertex 2): its Jacobian is not finite"));
}

TEST_CASE("finite: values, information and errors are examined too") {
  Graph graph = poses_with(1);
  CHECK_FALSE(find_not_finite(graph).has_value());
  graph.set_value(1, std::array{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  CHECK(find_not_finite(graph) == "VERTEX_SE2 2: its value is not finite");
  Graph heavy = poses_with(1);
  heavy.add_edge(EdgeFragile{4}, {1}, Eigen::Matrix<double, 1, 1>(std::numeric_limits<double>::infinity()));
  CHECK(find_not_finite(heavy) == "EDGE_FRAGILE number 3 (vertex 2): its information is not finite");
}

TEST_CASE("guard: an error that throws is told with its edge, on any number of threads") {
  Graph graph = poses_with(200);
  CHECK_THROWS_MATCHES(optimise(graph), PluginError,
                       Catch::Matchers::Message("EDGE_FRAGILE number 2: threw: no such place"));
  CHECK_THROWS_AS(graph.chi2(), PluginError);
  const TypeRegistry registry = full_registry();
  OptimizerOptions threads;
  threads.threads = 3;
  for (int i = 0; i < 3; ++i)
    CHECK_THROWS_AS(optimize(graph, *registry.make_algorithm("dogleg"),
                             *registry.make_linear_solver("block_cholesky"), threads),
                    PluginError);
}

TEST_CASE("guard: what a model of a plugin throws is told with plugin and model") {
  struct Throwing final : SensorModel {
    explicit Throwing(int what) : what_(what) {}
    void extend(const SensorInput&, Graph&) override {
      if (what_ == 0) throw std::runtime_error("no anchor 7");
      if (what_ == 1) throw 42;
      throw InputError("row 3 is impossible");
    }
    int what_;
  };
  TypeRegistry registry = full_registry();
  registry.set_origin("uwb");
  const std::vector<OptionInfo> options = {{"what", "0", "", OptionRange{0, 5}, "what is thrown"}};
  registry.add_sensor_model(
      {"ranges", "", {}, options, [](const CheckedOptions& given) -> std::unique_ptr<SensorModel> {
         if (given.number("what") > 3) throw std::bad_alloc();
         if (given.number("what") > 2) return nullptr;
         return std::make_unique<Throwing>(static_cast<int>(given.number("what")));
       }});
  Graph graph;
  const SensorTable readings;
  const auto extend = [&](const char* what) {
    registry.make_sensor_model("ranges", {{"what", what}})->extend({{}, {}, {0, 0}, readings}, graph);
  };
  CHECK_THROWS_MATCHES(extend("0"), PluginError,
                       Catch::Matchers::Message("plugin 'uwb': sensor model 'ranges': threw: no anchor 7"));
  CHECK_THROWS_MATCHES(extend("1"), PluginError,
                       Catch::Matchers::Message(
                           "plugin 'uwb': sensor model 'ranges': threw something that is no std::exception"));
  CHECK_THROWS_MATCHES(extend("2"), InputError, Catch::Matchers::Message("row 3 is impossible"));
  CHECK_THROWS_WITH(extend("3"), "plugin 'uwb': sensor model 'ranges': its factory returned nothing");
  CHECK_THROWS_WITH(extend("4"), Contains("plugin 'uwb': sensor model 'ranges': threw: "));
}

TEST_CASE("registration: names are words") {
  TypeRegistry registry;
  for (const char* name : {"", "two words", "tab\tbed", "#comment", "line\n"}) {
    CAPTURE(name);
    VertexType vertex = of_angle();
    vertex.tag = name;
    CHECK_THROWS_WITH(registry.add_vertex(vertex), Contains("cannot be registered"));
    CHECK_THROWS_WITH(registry.add_loss({name, nullptr, ""}), Contains("cannot be registered"));
  }
}

}  // namespace promises_test

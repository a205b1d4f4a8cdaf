// Calibration states: gyro bias, speed scale and time offset come out of a drive as they went in,
// with sigmas that say how far to trust them.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace calibration_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

namespace {

/// The errors of the sensors of a simulated drive.
struct Faults {
  double bias = 0;       ///< rad/s at the start
  double drift = 0;      ///< rad/s per s
  double scale = 0;      ///< true speed = (1 + scale) reading
  double offset = 0;     ///< s
  double per_speed = 0;  ///< rad/m: a yaw rate from wheels, which reads 0 at rest
  double yaw_scale = 0;  ///< true yaw rate = (1 + scale) (reading - bias)
};

constexpr double kDt = 0.1;
constexpr double kSigma = 1.5;           // m, of a fix, per axis
constexpr double kHeadingRate = 1.5e-6;  // rad^2/s, assumed by the odometry model and true for the gyro
constexpr double kSpeedNoise = 2e-3;     // m^2/m

double speed_at(double t) {
  return std::fmod(t, 120) < 20 ? 0 : 10 + 4 * std::sin(0.07 * t);
}
double yaw_rate_at(double t) {
  return speed_at(t) == 0 ? 0 : 0.15 * std::sin(0.05 * t) + 0.1 * std::sin(0.31 * t);
}

/// A winding drive with stops of 20 s every 2 minutes, its noise as the odometry model assumes it;
/// fixes at 1 Hz.
struct Simulated {
  Graph graph;
  std::vector<Fix> fixes;
  std::vector<Interval> intervals;
  std::vector<FixMoment> moments;
  std::vector<Stamp> stamps;
  std::vector<VertexIndex> poses;
  std::vector<Pose2<double>> truth;

  Simulated(const Faults& faults, double seconds, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> unit(0, 1);
    Pose2<double> pose(0, 0, 0.3);
    const auto n = static_cast<int>(std::lround(seconds / kDt));
    for (int i = 0; i <= n; ++i) {
      const double t = i * kDt;
      const double speed = speed_at(t);
      const double yaw_rate = yaw_rate_at(t);
      stamps.push_back(Stamp{std::int64_t{i} * 100'000'000});
      truth.push_back(pose);
      poses.push_back(
          graph.add_vertex<VertexSe2>(VertexId(i + 1), {pose.position[0], pose.position[1], pose.heading}));
      Interval reading{speed / (1 + faults.scale), yaw_rate / (1 + faults.yaw_scale), kDt, false};
      reading.yaw_rate_radps += faults.bias + faults.drift * t;
      reading.yaw_rate_radps += std::sqrt(kHeadingRate / kDt) * unit(random);
      reading.yaw_rate_radps += faults.per_speed * speed;
      if (faults.per_speed != 0 && speed == 0) reading.yaw_rate_radps = 0;
      if (speed > 0) reading.speed_mps += std::sqrt(kSpeedNoise * speed * kDt) / kDt * unit(random);
      if (i % 10 == 0) add_fix(i, pose, {speed, yaw_rate, 0, false}, faults.offset, random);
      if (i == n) break;
      intervals.push_back(reading);
      pose = compose(pose, se2_exp<double>(Eigen::Vector3d(speed * kDt, 0, yaw_rate * kDt)));
    }
  }

  void add_fix(int i, const Pose2<double>& pose, const Interval& moves, double offset,
               std::mt19937_64& random) {
    std::normal_distribution<double> unit(0, 1);
    const Eigen::Vector3d back(-offset * moves.speed_mps, 0, -offset * moves.yaw_rate_radps);
    const Pose2<double> then = compose(pose, se2_exp<double>(back));
    Fix fix;
    fix.stamp = stamps.back();
    fix.position = then.position + kSigma * Eigen::Vector2d(unit(random), unit(random));
    fix.covariance = kSigma * kSigma * Eigen::Matrix2d::Identity();
    fix.vertex = VertexId(i + 1);
    fixes.push_back(fix);
    moments.push_back({{0, 0}, {moves.speed_mps, 0}});
  }

  void solve(const Options& odometry, const Options& modeling, const std::string& name = "g1") {
    registry().make_odometry_model("constant_twist", odometry)->extend({{stamps, poses, intervals}}, graph);
    registry().make_gnss_modeling(name, modeling)->extend({fixes, moments, {0, 0}}, graph);
    const Summary summary =
        optimize(graph, *registry().make_algorithm("dogleg"), *registry().make_linear_solver("eigen"), {});
    INFO(summary.message);
    REQUIRE(summary.converged());
  }

  [[nodiscard]] std::vector<VertexIndex> states(std::string_view tag) const {
    std::vector<VertexIndex> found;
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
      if (graph.vertex_type(v).tag == tag && !graph.fixed(v)) found.push_back(v);
    }
    return found;
  }
  [[nodiscard]] double position_rms() const {
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto value = graph.value(poses[i]);
      sum += (Eigen::Vector2d(value[0], value[1]) - truth[i].position).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(truth.size()));
  }
};

/// The value of the only vertex of a type, and its sigma.
std::pair<double, double> estimate(const Simulated& drive, std::string_view tag) {
  const std::vector<VertexIndex> states = drive.states(tag);
  REQUIRE(states.size() == 1);
  const double variance = marginal_covariances(drive.graph, states)[0](0, 0);
  return {drive.graph.value(states[0])[0], std::sqrt(variance)};
}

const Options kConstant{{"gyro_bias", "constant"}, {"speed_scale", "constant"}};

}  // namespace

TEST_CASE(
    "calibration: constant bias, scale and time offset come out within their sigmas, in every modeling") {
  const Faults faults{4e-3, 0, -0.02, 0.35};
  for (const char* modeling : {"g1", "g2", "g3"}) {
    INFO(modeling);
    double squares = 0;  // normalised by the sigmas: chi-square with 12 degrees of freedom
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      Simulated drive(faults, 300, seed);
      drive.solve(kConstant, {{"time_offset", "constant"}}, modeling);
      const auto [bias, bias_sigma] = estimate(drive, "VERTEX_GYRO_BIAS");
      const auto [scale, scale_sigma] = estimate(drive, "VERTEX_SPEED_SCALE");
      const auto [offset, offset_sigma] = estimate(drive, "VERTEX_TIME_OFFSET");
      CHECK(bias == Approx(faults.bias).margin(4 * bias_sigma));
      CHECK(scale == Approx(faults.scale).margin(4 * scale_sigma));
      CHECK(offset == Approx(faults.offset).margin(4 * offset_sigma));
      // Far below the simulated errors: the estimates are informative.
      CHECK(bias_sigma < 0.05 * faults.bias);
      CHECK(scale_sigma < 0.1 * std::abs(faults.scale));
      CHECK(offset_sigma < 0.1 * faults.offset);
      squares += std::pow((bias - faults.bias) / bias_sigma, 2) +
                 std::pow((scale - faults.scale) / scale_sigma, 2) +
                 std::pow((offset - faults.offset) / offset_sigma, 2);
    }
    CHECK(squares > 1.6);  // 0.01 % and 99.99 % of chi-square with 12 degrees of freedom
    CHECK(squares < 39.2);
  }
}

TEST_CASE(
    "calibration: a late fix of an antenna with a lever arm is the same in every modeling, also in turns") {
  // Three poses of a turn; the node of G2 is the antenna, whose velocity has a part across the
  // vehicle.
  const Eigen::Vector2d antenna(2, -0.5);
  std::vector<double> chi2;
  for (const std::string_view name : {"g1", "g2", "g3"}) {
    Graph graph;
    std::vector<Fix> fixes;
    Pose2<double> pose(1, 2, 0.4);
    for (int i = 0; i < 3; ++i) {
      graph.add_vertex<VertexSe2>(VertexId(i + 1), {pose.position[0], pose.position[1], pose.heading});
      Fix fix;
      fix.position = pose.position + Eigen::Vector2d(0.3 * i, -0.2);
      fix.vertex = VertexId(i + 1);
      fixes.push_back(fix);
      pose = compose(pose, se2_exp<double>(Eigen::Vector3d(8, 0, 0.6)));
    }
    const std::vector<FixMoment> moments(3, {antenna, {8 + 0.6 * 0.5, 0.6 * 2}});
    registry()
        .make_gnss_modeling(name, {{"time_offset", "constant"}})
        ->extend({fixes, moments, antenna}, graph);
    VertexIndex nodes = 0;
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
      if (graph.vertex_type(v).tag == "VERTEX_TIME_OFFSET") graph.set_value(v, std::array{0.4});
      if (name != "g2" || v < 4 || graph.vertex_type(v).tag != "VERTEX_SE2") continue;  // the origin is 3
      // The free nodes onto the antenna, so that their identity edges say nothing.
      const auto body = graph.value(nodes++);
      const Eigen::Vector2d place = Eigen::Vector2d(body[0], body[1]) + rotate(body[2], antenna);
      graph.set_value(v, std::array{place[0], place[1], body[2]});
    }
    chi2.push_back(graph.chi2());
  }
  CHECK(chi2[1] == Approx(chi2[0]).epsilon(1e-9));
  CHECK(chi2[2] == Approx(chi2[0]).epsilon(1e-9));
}

TEST_CASE("calibration: it lowers the error of a drive with a biased gyro and a wrong wheel radius") {
  const Faults faults{4e-3, 0, -0.02, 0.35};
  Simulated plain(faults, 300, 1);
  Simulated calibrated = plain;
  plain.solve({}, {});
  calibrated.solve(kConstant, {{"time_offset", "constant"}});
  CHECK(calibrated.position_rms() < 0.5 * plain.position_rms());
}

TEST_CASE("calibration: a wandering bias is followed by a random walk, and missed by a constant") {
  const Faults faults{2e-3, 1e-5, 0, 0};  // from 0.11 to 0.46 deg/s in 10 minutes
  const Options walk{{"gyro_bias", "random_walk"}, {"gyro_bias_walk", "3e-5"}};
  Simulated drive(faults, 600, 3);
  drive.solve(walk, {});
  const std::vector<VertexIndex> states = drive.states("VERTEX_GYRO_BIAS");
  REQUIRE(states.size() == 60);  // one in 10 s
  const auto covariances = marginal_covariances(drive.graph, states);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double middle = 10 * static_cast<double>(i) + 5;
    const double sigma = std::sqrt(covariances[i](0, 0));
    CHECK(drive.graph.value(states[i])[0] ==
          Approx(faults.bias + faults.drift * middle).margin(4 * sigma + 10 * faults.drift));
  }
  Simulated constant(faults, 600, 3);
  constant.solve({{"gyro_bias", "constant"}}, {});
  CHECK(constant.graph.chi2() > 1.2 * drive.graph.chi2());
}

TEST_CASE("calibration: a standing gyro shows its bias to sqrt(q / T)") {
  Graph graph;
  std::vector<VertexIndex> poses;
  std::vector<Stamp> stamps;
  std::vector<Interval> intervals;
  for (int i = 0; i <= 400; ++i) {  // 40 s at rest; a reading alternates about its bias
    poses.push_back(graph.add_vertex<VertexSe2>(VertexId(i + 1), {0, 0, 0}));
    stamps.push_back(Stamp{std::int64_t{i} * 100'000'000});
    if (i < 400) intervals.push_back({0, 5e-3 + (i % 2 == 0 ? 1e-3 : -1e-3), kDt, false});
  }
  graph.set_fixed(poses[0], true);
  registry()
      .make_odometry_model("constant_twist", {{"gyro_bias", "constant"}, {"gyro_bias_sigma", "10"}})
      ->extend({{stamps, poses, intervals}}, graph);
  const Summary summary =
      optimize(graph, *registry().make_algorithm("dogleg"), *registry().make_linear_solver("eigen"), {});
  REQUIRE(summary.converged());
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag != "VERTEX_GYRO_BIAS") continue;
    CHECK(graph.value(v)[0] == Approx(5e-3));
    CHECK(std::sqrt(marginal_covariances(graph, std::array{v})[0](0, 0)) ==
          Approx(std::sqrt(kHeadingRate / 40)));
  }
}

TEST_CASE("calibration: off is the plain model, and a state that is off while the other is on is held at 0") {
  Simulated plain({}, 60, 5);
  Simulated off = plain;
  Simulated bias_only = plain;
  plain.solve({}, {});
  off.solve({{"gyro_bias", "off"}, {"speed_scale", "off"}}, {{"time_offset", "off"}});
  CHECK(off.graph.values() == plain.graph.values());
  bias_only.solve({{"gyro_bias", "constant"}}, {});
  CHECK(bias_only.states("VERTEX_GYRO_BIAS").size() == 1);
  CHECK(bias_only.states("VERTEX_SPEED_SCALE").empty());  // there, but fixed
}

TEST_CASE("calibration: wrong options are named, and what cannot be combined is refused") {
  CHECK_THROWS_WITH(registry().make_odometry_model("constant_twist", {{"gyro_bias", "wander"}}),
                    Contains("'off' or 'constant' or 'random_walk', got 'wander'"));
  CHECK_THROWS_WITH(registry().make_odometry_model("constant_twist", {{"speed_scale_sigma", "0"}}),
                    Contains("speed_scale_sigma") && Contains("must lie in"));
  CHECK_THROWS_WITH(registry().make_gnss_modeling("g1", {{"time_offset", "constant"}, {"error", "literal"}}),
                    Contains("literal error has no time offset"));
  Simulated drive({}, 10, 1);
  drive.moments.clear();
  const auto modeling = registry().make_gnss_modeling("g1", {{"time_offset", "constant"}});
  CHECK_THROWS_WITH(modeling->extend({drive.fixes, drive.moments, {0, 0}}, drive.graph),
                    Contains("GnssInput::moments"));
}

TEST_CASE(
    "calibration: a yaw rate from wheels gives its error per speed, and none of its zeros at rest count") {
  Faults faults;
  faults.per_speed = 2e-3;
  const Options states{
      {"gyro_bias", "constant"}, {"yaw_per_speed", "constant"}, {"gyro_at_rest_variance_per_s", "1"}};
  double squares = 0;  // chi-square with 4 degrees of freedom
  double without = 0;
  double with = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Simulated drive(faults, 300, seed);
    drive.solve(states, {});
    const auto [per_speed, sigma] = estimate(drive, "VERTEX_YAW_PER_SPEED");
    CHECK(sigma < 5e-4);
    squares += std::pow((per_speed - faults.per_speed) / sigma, 2);
    with += drive.position_rms() / 4;
    Simulated biased(faults, 300, seed);
    biased.solve(kConstant, {});
    without += biased.position_rms() / 4;
  }
  CHECK(squares < 13.3);  // 99 %
  CHECK(with < 0.7 * without);
}

TEST_CASE("calibration: the scale of a weak gyro comes out beside its bias") {
  Faults faults;
  faults.bias = 4e-3;
  faults.yaw_scale = 0.25;
  const Options states{{"gyro_bias", "constant"}, {"yaw_scale", "constant"}, {"yaw_scale_sigma", "0.25"}};
  double squares = 0;  // chi-square with 8 degrees of freedom
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Simulated drive(faults, 300, seed);
    drive.solve(states, {});
    const auto [scale, sigma] = estimate(drive, "VERTEX_YAW_SCALE");
    CHECK(sigma < 0.01);
    squares += std::pow((scale - faults.yaw_scale) / sigma, 2);
    const auto [bias, bias_sigma] = estimate(drive, "VERTEX_GYRO_BIAS");
    squares += std::pow((bias - faults.bias) / bias_sigma, 2);
    CHECK(drive.position_rms() < 1);
    Simulated without(faults, 300, seed);
    without.solve(kConstant, {});
    CHECK(without.graph.chi2() > 2 * drive.graph.chi2());
  }
  CHECK(squares < 20.1);  // 99 %
}

}  // namespace calibration_test

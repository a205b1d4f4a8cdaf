// Withheld fixes: their prediction by the fused poses, by odometry alone and by the past alone.
#include <cmath>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/plugins/odometry/calibration.hpp>
#include <waymark/plugins/odometry/edge_odometry.hpp>
#include <waymark/tools/drive/left_out/outages.hpp>
#include <waymark/tools/evaluation/numbers/withheld.hpp>

namespace evaluation_outages_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::evaluation;
using namespace waymark::formats;
using namespace waymark::plugins::odometry;

namespace {

constexpr double kSpeed = 10;

Fix fix_at(int second, FixStatus status) {
  Fix fix;
  fix.stamp = Stamp::from_seconds(second);
  fix.position = {kSpeed * second, 0};
  fix.covariance = 4 * Eigen::Matrix2d::Identity();
  fix.status = status;
  fix.epoch = second;
  fix.vertex = VertexId(second + 1);
  return fix;
}

/// One fix per second; 'a' accepted, 'r' rejected, 'w' withheld.
std::vector<Fix> fixes_of(const std::string& word) {
  std::vector<Fix> fixes;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const FixStatus status = word[i] == 'w'   ? FixStatus::withheld
                             : word[i] == 'r' ? FixStatus::rejected
                                              : FixStatus::accepted;
    fixes.push_back(fix_at(static_cast<int>(i), status));
  }
  return fixes;
}

/// Poses eastward on the x axis, a second apart; odometry edges whose gyro is off by `bias`, with
/// that bias estimated if `calibrated`.
GraphDocument straight_drive(const std::string& word, double bias, bool calibrated) {
  GraphDocument document;
  document.fixes = fixes_of(word);
  Graph& graph = document.graph;
  std::vector<VertexIndex> poses;
  for (const Fix& fix : document.fixes) {
    poses.push_back(graph.add_vertex<VertexSe2>(fix.vertex, {fix.position.x(), 0, 0}));
    graph.set_stamp(poses.back(), fix.stamp);
  }
  const VertexIndex scale = graph.add_vertex<VertexSpeedScale>(VertexId{1000}, {0.1});
  const VertexIndex gyro = graph.add_vertex<VertexGyroBias>(VertexId{1001}, {bias});
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    if (calibrated) {
      EdgeSe2OdometryCalibrated edge;
      edge.speed = kSpeed;
      edge.yaw_rate = bias;
      edge.dt = 1;
      graph.add_edge(edge, {poses[i], poses[i + 1], scale, gyro}, Eigen::Matrix3d::Identity());
    } else {
      EdgeSe2Odometry edge;
      edge.speed = kSpeed;
      edge.yaw_rate = bias;
      edge.dt = 1;
      graph.add_edge(edge, {poses[i], poses[i + 1]}, Eigen::Matrix3d::Identity());
    }
  }
  return document;
}

/// The end of a drive at constant speed and yaw rate from a pose at the origin, heading east.
Eigen::Vector2d on_arc(double seconds, double yaw_rate) {
  const double radius = kSpeed / yaw_rate;
  return {radius * std::sin(yaw_rate * seconds), radius * (1 - std::cos(yaw_rate * seconds))};
}

PreparedDrive prepared(const std::string& word) {
  PreparedDrive drive;
  drive.fixes = fixes_of(word);
  for (int i = 0; i <= 10 * static_cast<int>(word.size()); ++i)
    drive.odometry.push_back({Stamp{100'000'000LL * i + 30'000'000}, kSpeed, 0});
  drive.truth.push_back({});
  SensorTable sensor;
  sensor.columns = 2;
  for (int i = 0; i < static_cast<int>(word.size()); ++i) {
    sensor.stamps.push_back(Stamp::from_seconds(i));
    sensor.values.insert(sensor.values.end(), {1.0 * i, 2.0 * i});
  }
  drive.sensors.push_back({.name = "sensor", .readings = sensor});
  return drive;
}

}  // namespace

TEST_CASE("outages: dead reckoning starts at the last accepted fix and follows the gyro as it reads") {
  constexpr double kBias = 0.02;
  const bool calibrated = GENERATE(false, true);  // the estimated states must not help
  const auto result = dead_reckoned_at_withheld(straight_drive("waarwwwaw", kBias, calibrated));
  REQUIRE(result.poses.size() == 9);
  CHECK(result.position_covariances.empty());
  CHECK_FALSE(result.poses[0]);  // nothing was accepted before
  CHECK_FALSE(result.poses[1]);
  CHECK_FALSE(result.poses[3]);
  for (const int i : {4, 5, 6}) {  // from the fix at 2 s, past the rejected one
    const Eigen::Vector3d& pose = *result.poses[static_cast<std::size_t>(i)];
    CHECK((pose.head<2>() - Eigen::Vector2d(20, 0) - on_arc(i - 2, kBias)).norm() < 1e-9);
    CHECK(pose[2] == Approx(kBias * (i - 2)));
  }
  CHECK((result.poses[8]->head<2>() - Eigen::Vector2d(70, 0) - on_arc(1, kBias)).norm() < 1e-9);
}

TEST_CASE("outages: dead reckoning stands where the vehicle stood, and ends where the chain does") {
  GraphDocument document;
  document.fixes = fixes_of("awww");
  std::vector<VertexIndex> poses;
  for (const Fix& fix : document.fixes) {
    poses.push_back(document.graph.add_vertex<VertexSe2>(fix.vertex, {0, 0, 1.0}));
    document.graph.set_stamp(poses.back(), fix.stamp);
  }
  EdgeSe2Standstill standing;
  standing.yaw_rate = 0.5;
  standing.dt = 1;
  document.graph.add_edge(standing, {poses[0], poses[1]}, Eigen::Matrix3d::Identity());
  EdgeSe2Odometry leap;  // over a pose
  leap.speed = kSpeed;
  leap.dt = 2;
  document.graph.add_edge(leap, {poses[1], poses[3]}, Eigen::Matrix3d::Identity());
  const auto result = dead_reckoned_at_withheld(document);
  REQUIRE(result.poses[1]);
  CHECK(result.poses[1]->isApprox(Eigen::Vector3d(0, 0, 1)));
  CHECK_FALSE(result.poses[2]);
  REQUIRE(result.poses[3]);
  CHECK(result.poses[3]->isApprox(Eigen::Vector3d(20 * std::cos(1.0), 20 * std::sin(1.0), 1)));
}

TEST_CASE("outages: runs of withheld fixes are found") {
  const std::vector<Fix> fixes = fixes_of("wwaawwraww");
  const std::vector<WithheldRun> runs = withheld_runs(fixes);
  REQUIRE(runs.size() == 3);
  CHECK(runs[0].begin == 0);
  CHECK(runs[0].end == 2);
  CHECK(runs[1].begin == 4);
  CHECK(runs[1].end == 6);
  CHECK(runs[2].end == 10);
  CHECK(withheld_runs(fixes_of("ara")).empty());
}

TEST_CASE("outages: a drive as it was known ends with the fix and the odometry that closes its interval") {
  const PreparedDrive known = known_until(prepared("aaaawwaaww"), 6);
  CHECK(known.fixes.size() == 6);
  CHECK(known.truth.empty());
  CHECK(known.odometry.back().stamp == Stamp{5'030'000'000});  // samples at 0.03 s + k 0.1 s
  CHECK(known.sensors[0].readings.size() == 6);
  CHECK(known.sensors[0].readings.values.size() == 12);
}

TEST_CASE("outages: causal poses come from one fusion per outage that never sees what follows") {
  const PreparedDrive drive = prepared("waawwaaw");
  std::vector<std::size_t> seen;
  const PosesAtWithheld result = causal_at_withheld(drive, [&](const PreparedDrive& known) {
    seen.push_back(known.fixes.size());
    GraphDocument document;
    document.fixes = known.fixes;
    for (const Fix& fix : known.fixes) {
      const auto v = document.graph.add_vertex<VertexSe2>(
          fix.vertex, {static_cast<double>(known.fixes.size()), 0, 0});  // says which fusion it was
      document.graph.set_stamp(v, fix.stamp);
      if (fix.epoch == 4) document.covariances.push_back({v, 2 * Eigen::Matrix3d::Identity()});
    }
    return std::optional(document);
  });
  CHECK(seen == std::vector<std::size_t>{5, 8});
  CHECK_FALSE(result.poses[0]);  // nothing was known before it
  CHECK_FALSE(result.poses[2]);
  CHECK(result.poses[3]->x() == 5);
  CHECK(result.poses[4]->x() == 5);
  CHECK_FALSE(result.poses[6]);
  CHECK(result.poses[7]->x() == 8);
  CHECK_FALSE(result.position_covariances[3]);
  CHECK((*result.position_covariances[4])(0, 0) == 2);

  const auto nothing = causal_at_withheld(drive, [](const PreparedDrive&) { return std::nullopt; });
  CHECK_FALSE(nothing.poses[3]);
  const auto other = [](const PreparedDrive&) { return std::optional(GraphDocument()); };
  CHECK_THROWS_AS(causal_at_withheld(drive, other), UsageError);
}

TEST_CASE("outages: an outage is a run of withheld epochs") {
  CHECK(outage_ends(fixes_of("awwawarwww")) == std::vector<std::size_t>{2, 9});
  CHECK(outage_ends(fixes_of("awawr")).empty());
  std::vector<Fix> two_receivers = fixes_of("aww");
  two_receivers[2].stamp = two_receivers[1].stamp;
  CHECK(outage_ends(two_receivers).empty());
}

TEST_CASE("outages: errors at withheld fixes and at the end of each outage") {
  std::vector<Fix> fixes = fixes_of("awwaw");
  for (Fix& fix : fixes) fix.antenna_m = {1, 0};
  Prediction prediction{.label = "drifting", .poses = {}, .position_covariances = {}};
  for (const Fix& fix : fixes)  // off to the left by 2 m per second; heading north, the antenna 1 m ahead
    prediction.poses.emplace_back(
        Eigen::Vector3d(fix.position.x(), 2.0 * fix.epoch - 1, std::numbers::pi / 2));
  prediction.position_covariances.assign(5, Eigen::Matrix2d(12 * Eigen::Matrix2d::Identity()));
  prediction.position_covariances[4].reset();
  const WithheldMetrics w = withheld_metrics(prediction, fixes);
  CHECK(w.label == "drifting");
  CHECK(w.at_fixes.count == 3);
  CHECK(w.at_fixes.median_m == Approx(4));
  CHECK(w.at_fixes.max_m == Approx(8));
  CHECK(w.at_ends.count == 1);
  CHECK(w.at_ends.max_m == Approx(4));
  CHECK(w.innovation.count == 2);  // S = 12 + 4
  CHECK(w.innovation.mean == Approx((4.0 + 16.0) / 16 / 2));

  prediction.poses[1].reset();
  CHECK(withheld_metrics(prediction, fixes).at_fixes.count == 2);
  prediction.poses.pop_back();
  CHECK_THROWS_AS(withheld_metrics(prediction, fixes), UsageError);
}

}  // namespace evaluation_outages_test

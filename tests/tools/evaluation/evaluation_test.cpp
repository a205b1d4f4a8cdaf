#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>

namespace evaluation_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

constexpr double kNorth = std::numbers::pi / 2;

Fix fix_at(double t, double x, double y, FixStatus status = FixStatus::accepted) {
  Fix fix;
  fix.stamp = Stamp::from_seconds(t);
  fix.position = {x, y};
  fix.status = status;
  return fix;
}

StampedPose pose_at(double t, double x, double y, double heading) {
  return StampedPose{.stamp = Stamp::from_seconds(t), .pose = {x, y, heading}};
}

TruthPose truth_at(double t, double x, double y, std::optional<double> heading = {}) {
  return TruthPose{.stamp = Stamp::from_seconds(t), .position = {x, y}, .heading_rad = heading};
}

/// Four fixes on a drive northwards at 10 m/s: raw 2 m to the east, fused 1 m to the east, truth at 5 Hz.
EvaluationInput northwards(bool truth_heading) {
  EvaluationInput input;
  for (int i = 0; i < 4; ++i) {
    input.fixes.push_back(fix_at(i, 2, 10.0 * i));
    input.fused.push_back(pose_at(i, 1, 10.0 * i, kNorth + 0.01));
  }
  for (int i = 0; i <= 15; ++i)
    input.truth.push_back(
        truth_at(0.2 * i, 0, 2.0 * i, truth_heading ? std::optional<double>(kNorth) : std::nullopt));
  return input;
}

}  // namespace

TEST_CASE("evaluation: raw and fused are held against the truth") {
  const bool truth_heading = GENERATE(true, false);
  const Evaluation e = evaluate(northwards(truth_heading));
  CHECK(e.fixes() == 4);
  CHECK(e.accepted == 4);
  REQUIRE(e.truth);
  CHECK(e.truth->match.matched == 4);
  CHECK(e.truth->gnss.position.accuracy_m == Approx(2));
  CHECK(e.truth->fused.position.accuracy_m == Approx(1));
  CHECK(e.truth->fused.position.precision_m == Approx(0).margin(1e-12));
  CHECK(e.truth->improvement.max_percent == Approx(50));
  CHECK(e.truth->gnss.track.cross.mean == Approx(-2));  // east is to the right of north
  CHECK(e.truth->gnss.track.along.mean == Approx(0).margin(1e-9));
  CHECK(e.truth->fused.heading.count == (truth_heading ? 4u : 0u));
  if (truth_heading) CHECK(e.truth->fused.heading.rms == Approx(0.01));
  CHECK(e.truth->gnss.heading.count == 0);
  CHECK_FALSE(e.withheld_fixes);
}

TEST_CASE("evaluation: heights are held against the truth, and 3-D errors are those of both") {
  EvaluationInput input = northwards(false);
  CHECK_FALSE(evaluate(input).truth->space);
  CHECK(evaluate(input).truth->no_space == "the graph has no height state");
  input.heights_m = {52, 52, 52, 52};
  CHECK_FALSE(evaluate(input).truth->space);
  CHECK(evaluate(input).truth->no_space == "the truth has no heights");
  for (std::size_t i = 0; i < input.truth.size(); ++i)  // 50 m, and 1 m more for every second
    input.truth[i].height_m = 50 + 0.2 * static_cast<double>(i);
  const Evaluation e = evaluate(input);
  REQUIRE(e.truth->space);
  const SpaceMetrics& space = *e.truth->space;
  CHECK(space.height.count == 4);
  CHECK(space.height.mean == Approx(0.5));  // 2, 1, 0, -1
  CHECK(space.height.rms == Approx(std::sqrt(6 / 4.0)));
  CHECK(space.rmse_m == Approx(std::sqrt(1 + 6 / 4.0)));  // 1 m to the east
  CHECK(space.max_m == Approx(std::sqrt(1 + 4.0)));
  CHECK(*e.epochs[3].height_error_m == Approx(-1));
  CHECK(e.truth->no_space.empty());
  input.heights_m.pop_back();
  CHECK_THROWS_AS(evaluate(input), UsageError);
}

TEST_CASE("evaluation: raw and fused are compared at the same epochs, rejected and withheld ones too") {
  EvaluationInput input = northwards(true);
  input.fixes[1].status = FixStatus::rejected;
  input.fixes[1].position.x() = 50;
  input.fixes[2].status = FixStatus::withheld;
  input.fixes.push_back(fix_at(99, 0, 0));  // after the truth
  input.fused.push_back(pose_at(99, 0, 0, 0));
  const Evaluation e = evaluate(input);
  CHECK(e.accepted == 3);
  CHECK(e.rejected == 1);
  CHECK(e.withheld == 1);
  CHECK(e.truth->match.unmatched() == 1);
  CHECK(e.truth->gnss.position.count == 4);
  CHECK(e.truth->fused.position.count == 4);
  CHECK(e.truth->gnss_accepted.position.count == 2);
  CHECK(e.truth->gnss.position.max_m == Approx(50));
  CHECK(e.truth->gnss_accepted.position.max_m == Approx(2));
  REQUIRE(e.epochs.size() == 5);
  CHECK(e.epochs[1].status == FixStatus::rejected);
  CHECK(e.epochs[1].gnss_offset_m->isApprox(Eigen::Vector2d(50, 0)));
  CHECK_FALSE(e.epochs[4].gnss_offset_m);
}

TEST_CASE("evaluation: a fix is compared with the pose of the moment when it was measured") {
  // 20 m/s northwards, and fixes that are 0.35 s late: 7 m behind the poses of their stamps.
  EvaluationInput input;
  for (int i = 0; i < 3; ++i) {
    input.fixes.push_back(fix_at(i, 0, 20.0 * i - 7));
    input.fused.push_back(pose_at(i, 0, 20.0 * i, kNorth));
    input.when_measured.emplace_back(0, 20.0 * i - 7, kNorth);
  }
  for (const EpochResult& epoch : evaluate(input).epochs) {
    REQUIRE(epoch.fix_residual_m);
    CHECK(epoch.fix_residual_m->norm() == Approx(0).margin(1e-12));
  }
  input.when_measured.clear();
  CHECK(evaluate(input).epochs[1].fix_residual_m->isApprox(Eigen::Vector2d(0, -7)));
}

TEST_CASE("lever arms: everything is compared at the body point") {
  // Body at the origin heading north; antenna 1 m ahead and 0.5 m left, truth reference 2 m behind.
  const bool truth_heading = GENERATE(true, false);
  EvaluationInput input;
  input.truth_reference_m = {-2, 0};
  input.fixes = {fix_at(0, -0.5, 1), fix_at(1, -0.5, 11)};
  for (Fix& fix : input.fixes) fix.antenna_m = {1, 0.5};
  input.fused = {pose_at(0, 0, 0, kNorth), pose_at(1, 0, 10, kNorth + 4 * std::numbers::pi)};
  const auto heading = truth_heading ? std::optional<double>(kNorth) : std::nullopt;
  input.truth = {truth_at(0, 0, -2, heading), truth_at(1, 0, 8, heading)};
  const Evaluation e = evaluate(input);
  CHECK(e.truth->gnss.position.max_m == Approx(0).margin(1e-12));
  CHECK(e.truth->fused.position.max_m == Approx(0).margin(1e-12));
  CHECK(e.post_fit.mean == Approx(0).margin(1e-12));  // the predicted antenna is where the fix is
  if (truth_heading)
    CHECK(e.truth->fused.heading.max_abs == Approx(0).margin(1e-12));  // windings do not count
}

TEST_CASE("evaluation: the truth's heading moves the raw fix where both headings are known") {
  EvaluationInput input;
  input.fixes = {fix_at(0, 1, 0)};
  for (Fix& fix : input.fixes) fix.antenna_m = {1, 0};
  input.fused = {pose_at(0, 0, 0, kNorth)};  // wrong by 90 degrees
  input.truth = {truth_at(0, 0, 0, 0.0)};
  CHECK(evaluate(input).truth->gnss.position.max_m == Approx(0).margin(1e-12));
  input.truth[0].heading_rad.reset();  // now the fused heading has to do
  CHECK(evaluate(input).truth->gnss.position.max_m == Approx(std::sqrt(2.0)));
}

TEST_CASE("evaluation: error at withheld fixes, at the antenna") {
  EvaluationInput input;
  input.fixes = {fix_at(0, 2, 0), fix_at(1, 5, 0, FixStatus::withheld),
                 fix_at(2, 12, 4, FixStatus::withheld)};
  for (Fix& fix : input.fixes) fix.antenna_m = {2, 0};
  input.fused = {pose_at(0, 0, 0, 0), pose_at(1, 0, 0, 0), pose_at(2, 10, 0, 0)};
  const Evaluation e = evaluate(input);
  CHECK_FALSE(e.truth);
  REQUIRE(e.withheld_fixes);
  CHECK(e.withheld_fixes->position.count == 2);
  CHECK(e.withheld_fixes->position.max_m == Approx(4));
  CHECK(e.withheld_fixes->position.rmse_m == Approx(std::sqrt(12.5)));
  CHECK(e.withheld_fixes->position.median_m == Approx(3.5));
  CHECK(e.withheld_fixes->track.along.mean == Approx(-1.5));  // fused lies behind the first fix by 3 m
  CHECK(e.withheld_fixes->track.cross.mean == Approx(-2));
}

TEST_CASE("evaluation: innovations are kept apart by what became of the fix") {
  EvaluationInput input;
  input.fixes = {fix_at(0, 1, 0), fix_at(1, 10, 0, FixStatus::rejected),
                 fix_at(2, 0, 2, FixStatus::withheld)};
  for (Fix& fix : input.fixes) fix.covariance = 4 * Eigen::Matrix2d::Identity();
  input.fused = {pose_at(0, 0, 0, 0), pose_at(1, 0, 0, 0), pose_at(2, 0, 0, 0)};
  const Evaluation bare = evaluate(input);
  CHECK(bare.post_fit.mean == Approx(0.25));
  CHECK(bare.gated.mean == Approx(25));
  CHECK(bare.prediction.mean == Approx(1));
  CHECK(bare.post_fit.kind == ResidualKind::post_fit);
  CHECK(bare.gated.fraction_inside == 0);
  CHECK(bare.epochs[2].nu == Approx(1));

  input.position_covariances.assign(3, Eigen::Matrix2d::Identity());
  const Evaluation with_pose = evaluate(input);
  CHECK(with_pose.post_fit.mean == Approx(1.0 / 3.0));  // R - P
  CHECK(with_pose.gated.mean == Approx(20));            // R + P
  CHECK(with_pose.prediction.mean == Approx(0.8));
}

TEST_CASE("evaluation: a simulated drive: consistent covariances give mean nu 2 at withheld fixes") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  EvaluationInput input;
  constexpr int kFixes = 5000;
  for (int i = 0; i < kFixes; ++i) {
    Fix fix = fix_at(i, 5.0 * i + 3 * normal(random), 2 * normal(random), FixStatus::withheld);
    fix.covariance = Eigen::Vector2d(9, 4).asDiagonal();
    input.fixes.push_back(fix);
    input.fused.push_back(pose_at(i, 5.0 * i, 0, 0));
  }
  const Evaluation e = evaluate(input);
  CHECK(std::abs(e.prediction.mean - 2) < 4 * e.prediction.expected_deviation);
  CHECK(e.prediction.fraction_inside == Approx(0.95).margin(0.015));
  CHECK(e.withheld_fixes->track.along.deviation == Approx(3).epsilon(0.05));
  CHECK(e.withheld_fixes->track.cross.deviation == Approx(2).epsilon(0.05));
}

TEST_CASE("evaluation: no fixes: everything undefined, nothing thrown") {
  EvaluationInput input;
  CHECK(evaluate(input).fixes() == 0);
  input.truth = {truth_at(0, 0, 0)};
  const Evaluation e = evaluate(input);
  REQUIRE(e.truth);
  CHECK(std::isnan(e.truth->gnss.position.max_m));
  CHECK(std::isnan(e.truth->improvement.max_percent));
}

TEST_CASE("evaluation: inputs that do not belong together are refused") {
  using Catch::Matchers::Contains;
  EvaluationInput input = northwards(true);
  SECTION("one pose short") {
    input.fused.pop_back();
    CHECK_THROWS_AS(evaluate(input), UsageError);
    CHECK_THROWS_WITH(evaluate(input), Contains("3 fused poses for 4 fixes"));
  }
  SECTION("poses of another time") {
    input.fused[2].stamp.nanoseconds += 2'000'000;
    CHECK_THROWS_WITH(evaluate(input), Contains("does not belong to the fix at 2.000000000 s"));
    input.max_stamp_offset_s = 0.005;
    CHECK_NOTHROW(evaluate(input));
  }
  SECTION("covariances of another number") {
    input.position_covariances.resize(1);
    CHECK_THROWS_AS(evaluate(input), UsageError);
  }
  SECTION("a pose that is not finite") {
    input.fused[1].pose[2] = std::nan("");
    CHECK_THROWS_AS(evaluate(input), InputError);
  }
  SECTION("truth of another day") {
    for (TruthPose& pose : input.truth) pose.stamp.nanoseconds += 86'400'000'000'000;
    CHECK_THROWS_AS(evaluate(input), InputError);
    CHECK_THROWS_WITH(evaluate(input), Contains("does not overlap"));
  }
}

TEST_CASE("evaluation: an epoch says what was stated of it, and which way the truth went") {
  EvaluationInput input = northwards(true);
  input.fixes[1].status = FixStatus::rejected;
  input.fixes[1].reason = "displacement";
  for (Fix& fix : input.fixes) fix.covariance = Eigen::Vector2d(4, 9).asDiagonal();
  input.position_covariances.assign(4, Eigen::Vector2d(0.25, 1).asDiagonal());
  const Evaluation e = evaluate(input);
  double sum = 0;
  for (const EpochResult& epoch : e.epochs) {
    CHECK(epoch.fix_sigma_m.isApprox(Eigen::Vector2d(2, 3)));
    CHECK(*epoch.speed_mps == Approx(10));
    CHECK(*epoch.direction_rad == Approx(kNorth));
    CHECK(epoch.nees == Approx(4));  // 1 m to the east, 0.5 m is stated
    sum += epoch.nees;
  }
  CHECK(e.truth->consistency->nees_mean == Approx(sum / 4));
  CHECK(e.epochs[1].reason == "displacement");
}

TEST_CASE("evaluation: an epoch without truth or covariance leaves them open") {
  EvaluationInput input = northwards(false);
  input.truth.clear();
  const Evaluation e = evaluate(input);
  CHECK_FALSE(e.epochs[0].direction_rad);
  CHECK_FALSE(e.epochs[0].position_covariance);
  CHECK(std::isnan(e.epochs[0].nees));
  CHECK(e.epochs[0].speed_mps);
}

TEST_CASE("evaluation: speed of fused poses: chords, reverse, gaps, poses at one stamp") {
  const std::vector<StampedPose> poses = {pose_at(0, 0, 0, 0), pose_at(1, 4, 0, 0), pose_at(1, 4, 0, 0),
                                          pose_at(2, 2, 0, 0), pose_at(3, 1, 0, 0), pose_at(60, 9, 0, 0)};
  const auto speeds = fused_speeds(poses);
  CHECK(*speeds[0] == Approx(4));
  CHECK(*speeds[1] == Approx(1));  // the chord from 0 s to 2 s
  CHECK(*speeds[2] == Approx(1));
  CHECK(*speeds[3] == Approx(-1.5));
  CHECK(*speeds[4] == Approx(-1));
  CHECK_FALSE(speeds[5]);  // 57 s from its neighbour
  CHECK(fused_speeds({}).empty());
}

}  // namespace evaluation_test

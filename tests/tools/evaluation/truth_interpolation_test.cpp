#include <cmath>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/numbers/truth_interpolation.hpp>

namespace truth_interpolation_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

TruthPose truth_pose(double t, double x, double y, std::optional<double> heading = {}) {
  return TruthPose{.stamp = Stamp::from_seconds(t), .position = {x, y}, .heading_rad = heading};
}

/// 5 Hz truth along x at 10 m/s over [0, seconds].
std::vector<TruthPose> straight(double seconds) {
  std::vector<TruthPose> truth;
  for (int i = 0; i <= static_cast<int>(std::lround(5 * seconds)); ++i)
    truth.push_back(truth_pose(0.2 * i, 2.0 * i, 0));
  return truth;
}

std::vector<Stamp> stamps(std::initializer_list<double> seconds) {
  std::vector<Stamp> out;
  for (const double s : seconds) out.push_back(Stamp::from_seconds(s));
  return out;
}

}  // namespace

TEST_CASE("truth: position is linear between two truth poses") {
  const std::vector<TruthPose> truth{truth_pose(0, 0, 0), truth_pose(1, 10, -4)};
  const TruthMatch match = interpolate_truth(truth, stamps({0, 0.25, 1}));
  REQUIRE(match.matched == 3);
  CHECK(match.at[0]->pose.position == Eigen::Vector2d(0, 0));
  CHECK(match.at[1]->pose.position.isApprox(Eigen::Vector2d(2.5, -1)));
  CHECK(match.at[1]->pose.stamp == Stamp{250'000'000});
  CHECK(match.at[2]->pose.position == Eigen::Vector2d(10, -4));
  CHECK(match.median_interval_s == Approx(1));
}

TEST_CASE("truth: height is linear between two poses that both have one") {
  std::vector<TruthPose> truth{truth_pose(0, 0, 0), truth_pose(1, 10, 0), truth_pose(2, 20, 0)};
  truth[0].height_m = 40;
  truth[1].height_m = 44;
  const TruthMatch match = interpolate_truth(truth, stamps({0.25, 1, 1.5}));
  CHECK(match.at[0]->pose.height_m == Approx(41));
  CHECK(match.at[1]->pose.height_m == 44);
  CHECK(std::isnan(match.at[2]->pose.height_m));
}

TEST_CASE("truth: heading goes along the shorter arc, across +-pi") {
  const std::vector<TruthPose> truth{truth_pose(0, 0, 0, 170 * kDegree), truth_pose(1, 0, 0, -170 * kDegree)};
  const TruthMatch match = interpolate_truth(truth, stamps({0.25, 0.75}));
  CHECK(*match.at[0]->pose.heading_rad == Approx(175 * kDegree));
  CHECK(*match.at[1]->pose.heading_rad == Approx(-175 * kDegree));
}

TEST_CASE("truth: heading needs both neighbours") {
  const std::vector<TruthPose> truth{truth_pose(0, 0, 0, 0.5), truth_pose(1, 0, 0)};
  const TruthMatch match = interpolate_truth(truth, stamps({0, 0.5, 1}));
  CHECK(match.at[0]->pose.heading_rad == 0.5);
  CHECK_FALSE(match.at[1]->pose.heading_rad);
  CHECK_FALSE(match.at[2]->pose.heading_rad);
}

TEST_CASE("truth: truth is never extrapolated") {
  const TruthMatch match = interpolate_truth(straight(2), stamps({-0.001, 0, 2, 2.001, 99}));
  CHECK(match.matched == 2);
  CHECK(match.before_truth == 1);
  CHECK(match.after_truth == 2);
  CHECK(match.in_gap == 0);
  CHECK(match.unmatched() == 3);
  CHECK_FALSE(match.at[0]);
  CHECK(match.at[1]);
  CHECK(match.at[2]);
}

TEST_CASE("truth: a gap of 1.5 median intervals is crossed, a longer one is not") {
  std::vector<TruthPose> truth = straight(2);
  truth.push_back(truth_pose(2.3, 23, 0));  // 0.3 s = 1.5 x 0.2 s
  truth.push_back(truth_pose(2.7, 27, 0));  // 0.4 s
  const auto epochs = stamps({2.15, 2.3, 2.5, 2.7});
  const TruthMatch match = interpolate_truth(truth, epochs);
  REQUIRE(match.at[0]);
  CHECK(match.at[0]->pose.position.x() == Approx(21.5));
  CHECK(match.at[1]);        // on a truth pose: nothing is interpolated
  CHECK_FALSE(match.at[2]);  // in the gap
  CHECK(match.at[3]);
  CHECK(match.in_gap == 1);
  CHECK(interpolate_truth(truth, epochs, {.max_gap_factor = 2}).matched == 4);
}

TEST_CASE("truth: direction of motion from the truth's chord") {
  const TruthMatch match = interpolate_truth(straight(4), stamps({0, 1.9, 2, 4}));
  for (const auto& at : match.at) {
    REQUIRE(at->direction_rad);
    CHECK(*at->direction_rad == Approx(0).margin(1e-12));
  }
  const std::vector<TruthPose> parked{truth_pose(0, 5, 5), truth_pose(1, 5.01, 5), truth_pose(2, 5, 5.01)};
  CHECK_FALSE(interpolate_truth(parked, stamps({0.5})).at[0]->direction_rad);
  const std::vector<TruthPose> northwards{truth_pose(0, 0, 0), truth_pose(1, 0, 3)};
  CHECK(*interpolate_truth(northwards, stamps({0.5})).at[0]->direction_rad == Approx(std::numbers::pi / 2));
}

TEST_CASE("truth: noise of a fast truth does not turn the direction of motion") {
  std::vector<TruthPose> truth;  // 100 Hz, 1 m/s along x, +-1 cm across: neighbours lie 63 degrees off
  for (int i = 0; i <= 400; ++i) truth.push_back(truth_pose(0.01 * i, 0.01 * i, i % 2 == 0 ? 0.01 : -0.01));
  const TruthMatch match = interpolate_truth(truth, stamps({2.0, 2.005}));
  CHECK(std::abs(*match.at[0]->direction_rad) < 2 * kDegree);
  CHECK(std::abs(*match.at[1]->direction_rad) < 2 * kDegree);
}

TEST_CASE("truth: repeated truth stamps are tolerated, the last one counts") {
  const std::vector<TruthPose> truth{truth_pose(0, 0, 0), truth_pose(1, 1, 0), truth_pose(1, 2, 0),
                                     truth_pose(2, 4, 0)};
  const TruthMatch match = interpolate_truth(truth, stamps({1, 1.5}));
  CHECK(match.at[0]->pose.position.x() == 2);
  CHECK(match.at[1]->pose.position.x() == Approx(3));
}

TEST_CASE("truth: truth that does not overlap is an error with both time spans") {
  using Catch::Matchers::Contains;
  CHECK_THROWS_AS(interpolate_truth(straight(2), stamps({20, 30})), InputError);
  CHECK_THROWS_WITH(interpolate_truth(straight(2), stamps({30, 20.5})),
                    Contains("does not overlap") && Contains("0.000000000 .. 2.000000000") &&
                        Contains("20.500000000 .. 30.000000000"));
}

TEST_CASE("truth: fixes that all lie in gaps of the truth are an error") {
  std::vector<TruthPose> truth = straight(1);
  truth.push_back(truth_pose(9, 90, 0));
  CHECK_THROWS_WITH(interpolate_truth(truth, stamps({3, 4})),
                    Catch::Matchers::Contains("2 of 2 are in gaps of the truth longer than 0.300 s"));
}

TEST_CASE("truth: truth out of order, empty or not finite is an error") {
  const std::vector<TruthPose> backwards{truth_pose(1, 0, 0), truth_pose(0.5, 0, 0)};
  CHECK_THROWS_WITH(interpolate_truth(backwards, stamps({1})), Catch::Matchers::Contains("pose 2 at 0.5"));
  CHECK_THROWS_AS(interpolate_truth({}, stamps({1})), InputError);
  const std::vector<TruthPose> nan{truth_pose(0, std::nan(""), 0), truth_pose(1, 0, 0)};
  CHECK_THROWS_AS(interpolate_truth(nan, stamps({0.5})), InputError);
}

TEST_CASE("truth: no epochs and a single truth pose are no errors") {
  CHECK(interpolate_truth(straight(2), {}).matched == 0);
  const std::vector<TruthPose> one{truth_pose(1, 7, 8)};
  const TruthMatch match = interpolate_truth(one, stamps({1, 1.5}));
  CHECK(match.matched == 1);
  CHECK(match.after_truth == 1);
  CHECK(std::isnan(match.median_interval_s));
  CHECK_FALSE(match.at[0]->direction_rad);
}

TEST_CASE("truth: truth options are checked") {
  CHECK_THROWS_AS(interpolate_truth(straight(2), stamps({1}), {.max_gap_factor = 0.5}), UsageError);
  CHECK_THROWS_AS(interpolate_truth(straight(2), stamps({1}), {.direction_span_s = -1}), UsageError);
  CHECK_THROWS_AS(interpolate_truth(straight(2), stamps({1}), {.min_direction_speed_mps = 0}), UsageError);
}

TEST_CASE("truth: poses become truth with headings") {
  const std::vector<StampedPose> poses{{.stamp = Stamp{5}, .pose = {1, 2, 3}}};
  const std::vector<TruthPose> truth = truth_from_poses(poses);
  REQUIRE(truth.size() == 1);
  CHECK(truth[0].stamp == Stamp{5});
  CHECK(truth[0].position == Eigen::Vector2d(1, 2));
  CHECK(truth[0].heading_rad == 3.0);
}

}  // namespace truth_interpolation_test

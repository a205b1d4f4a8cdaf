// The clock of the odometry beside that of GNSS: what is late, or drifts, is put on time and told.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/clocks/late_quantity.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/trials/antenna_place.hpp>
#include <waymark/tools/drive/trials/lag_left.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"

namespace odometry_clock_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

/// Five minutes of bends at 10 Hz and 8 to 16 m/s, with fixes of 2 cm at 1 Hz.
/// @param drift seconds by which the odometry's clock hurries in a second
/// @param truth receives the positions at the fixes @param antenna_m where it is; nobody states it
PreparedDrive bends(double odometry_late_s, double drift = 0, std::vector<Eigen::Vector2d>* truth = nullptr,
                    const Eigen::Vector2d& antenna_m = {0, 0}) {
  constexpr double kStep_s = 0.1;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 1);
  PreparedDrive drive;
  drive.receivers = {{"gnss"}};
  Pose2<double> pose(0, 0, 0.7);
  const auto speed_at = [](double t) { return 12 + 4 * std::sin(t / 7); };
  const auto turn_at = [](double t) { return 0.15 * std::sin(t / 11) + 0.1 * std::sin(t / 4); };
  for (int i = 0; i <= 3000; ++i) {
    const double t = i * kStep_s;
    drive.odometry.push_back({.stamp = Stamp::from_seconds(1000 + t * (1 + drift) + odometry_late_s),
                              .speed_mps = speed_at(t) + 0.03 * normal(random),
                              .yaw_rate_radps = turn_at(t) + 0.002 * normal(random)});
    if (i % 10 == 0 && i >= 10 && i <= 2990) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(1000 + t);
      fix.epoch = i / 10 - 1;
      fix.position = pose.position + rotate(pose.heading, antenna_m) +
                     0.02 * Eigen::Vector2d(normal(random), normal(random));
      fix.covariance = 4e-4 * Eigen::Matrix2d::Identity();
      drive.fixes.push_back(fix);
      if (truth != nullptr) truth->push_back(pose.position);
    }
    const double middle = t + 0.5 * kStep_s;
    pose = compose(
        pose, se2_exp<double>(Eigen::Vector3d(speed_at(middle) * kStep_s, 0, turn_at(middle) * kStep_s)));
  }
  return drive;
}

/// Returns what is said about a late odometry; empty: nothing.
std::string told(const PreparedDrive& drive) {
  for (const std::string& warning : fuse(drive, {}, registry()).model.warnings())
    if (warning.find("the odometry is probably late") != std::string::npos) return warning;
  return {};
}

double rms_at_fixes(const FusedDrive& fused, std::span<const Eigen::Vector2d> truth) {
  const Graph& graph = fused.model.document.graph;
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const VertexId vertex = fused.model.placed.fixes[i].vertex;
    sum += (Eigen::Vector2d(graph.value(graph.find(vertex).value()).data()) - truth[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

}  // namespace

TEST_CASE("late odometry: it is told by how much, with what to state") {
  CHECK_THAT(told(bends(0.1)), Catch::Contains("add -0.10") || Catch::Contains("add -0.09"));
  CHECK_THAT(told(bends(0.4)), Catch::Contains("add -0.40") || Catch::Contains("add -0.39"));
}

TEST_CASE("late odometry: poses at the fixes are where the vehicle was then, not a tenth of a second later") {
  for (const double late_s : {0.1, 0.4}) {
    std::vector<Eigen::Vector2d> truth;
    const PreparedDrive drive = bends(late_s, 0, &truth);  // at 12 m/s: 1.2 and 4.8 m
    CHECK(rms_at_fixes(fuse(drive, {}, registry()), truth) < 0.03);
  }
}

TEST_CASE("late odometry: beside an antenna that nobody states it is put on time as well") {
  std::vector<Eigen::Vector2d> truth;
  const FusedDrive fused = fuse(bends(0.2, 0, &truth, {1.5, 0}), {}, registry());
  std::string told;
  for (const std::string& warning : fused.model.warnings()) told += warning + '\n';
  CHECK_THAT(told,
             Catch::Contains("state 'antenna: [1.") && Catch::Contains("the odometry is probably late"));
  CHECK_FALSE(told.find("for each m/s^2") != std::string::npos);
  CHECK(rms_at_fixes(fused, truth) < 1.6);  // poses are where the antenna is; 0.2 s are 2.4 m
}

TEST_CASE("late odometry: what fuses the drive again has the readings that were moved") {
  const PreparedDrive drive = bends(0.1);
  const ModeledDrive modeled = fuse(drive, {}, registry()).model;
  REQUIRE(modeled.other_readings);
  CHECK(seconds_between(modeled.other_readings->odometry[100].stamp, drive.odometry[100].stamp) ==
        Approx(0.1).margin(0.005));
  CHECK(modeled.placed.time_offsets_s.front() == 0);
  CHECK_FALSE(fuse(bends(0), {}, registry()).model.other_readings);
}

TEST_CASE(
    "late odometry: it is put on time with stated noise as well, and beside a receiver that tells nothing") {
  FusionSettings settings;
  settings.estimates_noise = false;
  PreparedDrive drive = bends(0.1);
  CHECK(fuse(drive, settings, registry()).model.other_readings);
  drive.receivers.push_back({"reference"});
  for (std::size_t i = 0; i < drive.fixes.size(); i += 2) {
    drive.fixes[i].source = 1;
    drive.fixes[i].status = FixStatus::withheld;
  }
  CHECK(fuse(drive, {}, registry()).model.other_readings);
}

TEST_CASE("late odometry: stamps that are moved earlier leave no gap at the end") {
  const PreparedDrive drive = bends(0);
  const PreparedDrive moved = with_stamps_later(drive, [](Stamp) { return -0.75; });
  CHECK(moved.odometry.back().stamp == drive.odometry.back().stamp);
  for (std::size_t i = 1; i < moved.odometry.size(); ++i)
    CHECK(seconds_between(moved.odometry[i - 1].stamp, moved.odometry[i].stamp) < 0.11);
}

TEST_CASE(
    "late odometry: nothing is said where clocks agree, where fixes may be late, or a delay is stated") {
  CHECK(told(bends(0)).empty());
  CHECK(told(bends(-0.1)).empty());
  PreparedDrive stated = bends(0.1);
  stated.receivers.front().delay_is_stated = true;
  CHECK(told(stated).empty());
}

TEST_CASE("late fixes: a delay is known no better than how far a late quantity was moved") {
  PreparedDrive drive = bends(-0.02);
  const auto delay_s = [&] { return fuse(drive, {}, registry()).model.placed.time_offsets_s.front(); };
  CHECK(delay_s() == Approx(0.02).margin(0.01));
  drive.report.moved_quantity = {OdometryQuantity::speed, 0.4, 0.03};
  CHECK(delay_s() == 0);
}

TEST_CASE(
    "late speed: one that was moved too far, or not far enough, is moved to a few thousandths of a second") {
  for (const double left_s : {0.04, -0.05}) {
    PreparedDrive drive = bends(0);
    const LateQuantity read_late{OdometryQuantity::speed, -left_s, 0};
    drive.odometry = without_lateness(drive.odometry, read_late);
    drive.report.moved_quantity = {OdometryQuantity::speed, 0.4, 0.05};
    const ModeledDrive modeled = fuse(drive, {}, registry()).model;
    const auto left =
        find_lag_left(drive.report.moved_quantity->kind, modeled.placed, {}, modeled.settings, registry());
    REQUIRE(left);
    CHECK_FALSE(left->is_probable());  // it was taken out
    double told_s = 0;
    for (const std::string& warning : modeled.warnings()) {
      CHECK_THAT(warning, !Catch::Contains("antenna") && !Catch::Contains("clock"));
      const auto advice = warning.find("state 'speed_delay: ");
      if (advice != std::string::npos)
        REQUIRE(std::sscanf(warning.c_str() + advice, "state 'speed_delay: %lf'", &told_s) == 1);
    }
    CHECK(told_s == Approx(0.4 + left_s).margin(0.006));
  }
}

TEST_CASE("late speed: what is left is found with its sigma, and nothing where the speed was moved rightly") {
  for (const double left_s : {0.0, 0.03, -0.11}) {
    PreparedDrive drive = bends(0);
    drive.odometry = without_lateness(drive.odometry, {OdometryQuantity::speed, -left_s, 0});
    const ModeledDrive modeled = Fusion(drive, registry()).estimated({});
    const auto left =
        find_lag_left(OdometryQuantity::speed, modeled.placed, {}, modeled.settings, registry());
    REQUIRE(left);
    CHECK(left->sigma_s < 0.02);
    CHECK(std::abs(left->late_s - left_s) < 4 * left->sigma_s);
    CHECK(left->is_probable() == (left_s != 0));
  }
}

TEST_CASE("late speed: nothing is said of what is beyond the reach of the search") {
  PreparedDrive drive = bends(0);
  drive.odometry = without_lateness(drive.odometry, {OdometryQuantity::speed, -0.3, 0});
  const ModeledDrive modeled = Fusion(drive, registry()).estimated({});
  CHECK_FALSE(find_lag_left(OdometryQuantity::speed, modeled.placed, {}, modeled.settings, registry()));
}

TEST_CASE("late yaw rate: one that was not moved far enough is moved on, and the readings at the end stay") {
  PreparedDrive drive = bends(0);
  drive.report.moved_quantity = {OdometryQuantity::yaw_rate, 0.3, 0.05};
  const PreparedDrive moved = without_lag_left(drive, {0.2, 0.004});
  REQUIRE(moved.odometry.size() == drive.odometry.size());
  CHECK(moved.odometry[100].yaw_rate_radps == Approx(drive.odometry[102].yaw_rate_radps));
  CHECK(moved.odometry[100].speed_mps == drive.odometry[100].speed_mps);
  CHECK(moved.odometry.back().yaw_rate_radps == drive.odometry.back().yaw_rate_radps);
  CHECK(moved.report.moved_quantity->earlier_s == Approx(0.5));
  CHECK_THAT(warning_of(*moved.report.moved_quantity), Catch::Contains("state 'yaw_rate_delay: 0.500'"));
}

TEST_CASE("antenna: one that is not stated is told with its place, and is no clock that is wrong") {
  for (const Eigen::Vector2d& antenna : {Eigen::Vector2d(1.5, 0.4), Eigen::Vector2d(-0.8, -0.6)}) {
    const PreparedDrive drive = bends(0, 0, nullptr, antenna);
    const ModeledDrive modeled = fuse(drive, {}, registry()).model;
    const auto found = find_antenna_place(modeled.placed, {}, modeled.settings, registry());
    REQUIRE(found);
    CHECK(found->sigma_m.maxCoeff() < 0.4);
    CHECK(std::abs(found->place_m.x() - antenna.x()) < 4 * found->sigma_m.x());
    CHECK(std::abs(found->place_m.y() - antenna.y()) < 4 * found->sigma_m.y());
    const std::vector<std::string> warnings = modeled.warnings();
    const auto says = [&](const char* words) {
      return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
        return warning.find(words) != std::string::npos;
      });
    };
    CHECK(says("state 'antenna: ["));
    CHECK_FALSE(says("the odometry is probably late"));
    CHECK(modeled.clock_drift.rate == 0);
  }
}

TEST_CASE("antenna: nothing is said where it is at the point of the odometry, or is stated") {
  for (const double late_s : {0.0, 0.1}) {
    const ModeledDrive modeled = fuse(bends(late_s), {}, registry()).model;
    CHECK_FALSE(find_antenna_place(modeled.placed, {}, modeled.settings, registry()));
  }
  PreparedDrive stated = bends(0, 0, nullptr, {1.5, 0.4});
  for (Fix& fix : stated.fixes) fix.antenna_m = {1.5, 0.4};
  const ModeledDrive modeled = fuse(stated, {}, registry()).model;
  CHECK_FALSE(find_antenna_place(modeled.placed, {}, modeled.settings, registry()));
}

TEST_CASE("antenna: none is told at the bound of the search, beyond which the place may be") {
  const ModeledDrive modeled = fuse(bends(0, 0, nullptr, {12, 0.4}), {}, registry()).model;
  CHECK_FALSE(find_antenna_place(modeled.placed, {}, modeled.settings, registry()));
}

TEST_CASE("antenna: one that is stated on the wrong side is told, with where it is") {
  PreparedDrive drive = bends(0, 0, nullptr, {1.5, 0.4});
  drive.receivers.front().antenna_is_stated = true;
  drive.receivers.front().antenna_m = {-1.5, -0.4};
  for (Fix& fix : drive.fixes) fix.antenna_m = {-1.5, -0.4};
  std::optional<Eigen::Vector2d> told_m;
  for (const std::string& warning : fuse(drive, {}, registry()).model.warnings()) {
    const auto advice = warning.find("or state 'antenna: [");
    Eigen::Vector2d place_m;
    if (warning.find("is stated at [-1.50, -0.40]") != std::string::npos && advice != std::string::npos &&
        std::sscanf(warning.c_str() + advice, "or state 'antenna: [%lf, %lf]'", &place_m[0], &place_m[1]) ==
            2)
      told_m = place_m;
  }
  REQUIRE(told_m);
  // Stated 3.1 m off; the noise that was found with that makes the place less certain.
  CHECK((*told_m - Eigen::Vector2d(1.5, 0.4)).norm() < 1);
}

TEST_CASE("antenna: one that is stated to be at the point of the odometry is believed to be there") {
  PreparedDrive drive = bends(0, 0, nullptr, {1.5, 0.4});
  drive.receivers.front().antenna_is_stated = true;
  for (const std::string& warning : fuse(drive, {}, registry()).model.warnings())
    CHECK_THAT(warning, !Catch::Contains("state 'antenna: ["));
}

TEST_CASE("clock drift: poses are at the times of the fixes, and the drift is told") {
  for (const double drift : {60e-6, -100e-6}) {  // 18 and 30 ms in all: 0.2 and 0.4 m at 12 m/s
    std::vector<Eigen::Vector2d> truth;
    const PreparedDrive drive = bends(0, drift, &truth);
    const FusedDrive fused = fuse(drive, {}, registry());
    const ClockDrift& found = fused.model.clock_drift;
    CHECK(found.rate == Approx(-drift).margin(4 * found.sigma));
    CHECK(found.sigma < 30e-6);
    CHECK(rms_at_fixes(fused, truth) < 0.04);
    CHECK(std::any_of(fused.model.placed.warnings.begin(), fused.model.placed.warnings.end(),
                      [](const std::string& warning) { return warning.find("ppm") != std::string::npos; }));
  }
}

TEST_CASE("clock drift: there is none where clocks agree, nor where fixes know too little") {
  CHECK(fuse(bends(0), {}, registry()).model.clock_drift.rate == 0);
  PreparedDrive rough = bends(0, 60e-6);
  for (Fix& fix : rough.fixes) fix.covariance = 100 * Eigen::Matrix2d::Identity();
  CHECK(fuse(rough, {}, registry()).model.clock_drift.rate == 0);
}

TEST_CASE("clock drift: the readings move, both clocks agree at the first fix, and the end stays covered") {
  const PreparedDrive drive = bends(0);
  const PreparedDrive moved = without_drift(drive, {.rate = -1e-3});
  const Stamp first = drive.fixes.front().stamp;
  REQUIRE(moved.odometry.size() == drive.odometry.size() + 3);  // of 0.3 s at 10 Hz
  CHECK(moved.odometry.back().stamp == drive.odometry.back().stamp);
  for (std::size_t i = 0; i < drive.odometry.size(); i += 500)
    CHECK(seconds_between(first, moved.odometry[i].stamp) ==
          Approx(0.999 * seconds_between(first, drive.odometry[i].stamp)).margin(1e-8));
}

}  // namespace odometry_clock_test

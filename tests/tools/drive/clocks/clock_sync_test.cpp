// Offsets between clocks: the simulated ones are found.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/tools/drive/clocks/clock_check.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/clocks/offset_names.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/clock_offsets.hpp>

#include "support/paths.hpp"
#include "support/skip.hpp"

namespace clock_sync_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark::drive;

namespace {

double speed_of(double t) {
  return 10 + 6 * std::sin(0.13 * t) + 3 * std::sin(0.41 * t);
}

double yaw_rate_of(double t) {
  return 0.15 * std::sin(0.19 * t) + 0.2 * std::sin(0.53 * t);
}

/// Ten minutes of winding road: odometry at 10 Hz, its speed and yaw rate stamped late; fixes at 1 Hz with
/// noise.
PreparedDrive winding_drive(double speed_late_s, double yaw_late_s, double noise_m, bool with_velocity) {
  PreparedDrive drive;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, noise_m > 0 ? noise_m : 1);
  Eigen::Vector2d position(0, 0);
  double heading = 0;
  constexpr double kStep = 0.01;
  for (int i = 0; i <= 60'000; ++i) {
    const double t = kStep * i;
    const Stamp stamp{static_cast<std::int64_t>(i) * 10'000'000};
    if (i % 10 == 0)
      drive.odometry.push_back({stamp, speed_of(t - speed_late_s), yaw_rate_of(t - yaw_late_s)});
    if (i % 100 == 0) {
      Fix fix;
      fix.stamp = stamp;
      fix.position = position;
      if (noise_m > 0) fix.position += Eigen::Vector2d(noise(random), noise(random));
      if (with_velocity) {
        fix.speed_mps = speed_of(t);
        fix.heading_rad = heading;
      }
      drive.fixes.push_back(fix);
    }
    position += kStep * speed_of(t + kStep / 2) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    heading += kStep * yaw_rate_of(t + kStep / 2);
  }
  return drive;
}

SyncReport offsets_of(const PreparedDrive& drive) {
  return estimate_clock_offsets(drive.odometry, drive.fixes, {});
}

}  // namespace

TEST_CASE("sync: speed and yaw rate are each found as late as they were made, by positions alone") {
  const SyncReport report = offsets_of(winding_drive(0.4, -0.15, 0, false));
  REQUIRE(report.speed);
  CHECK(report.speed->against == "distance between fixes");
  CHECK(report.speed->late_s == Approx(0.4).margin(0.01));
  CHECK(report.speed->correlation > 0.999);
  REQUIRE(report.yaw_rate);
  CHECK(report.yaw_rate->against == "angle between fixes");
  CHECK(report.yaw_rate->late_s == Approx(-0.15).margin(0.02));
}

TEST_CASE("sync: the receiver's speed and course are used where it gives them") {
  const SyncReport report = offsets_of(winding_drive(1.25, 1.25, 2, true));
  REQUIRE(report.speed);
  CHECK(report.speed->against == "receiver's speed");
  CHECK(report.speed->late_s == Approx(1.25).margin(0.005));
  REQUIRE(report.yaw_rate);
  CHECK(report.yaw_rate->against == "receiver's course");
  CHECK(report.yaw_rate->late_s == Approx(1.25).margin(0.005));
}

TEST_CASE("sync: sigma says how far off the offset is, with fixes of 1 m") {
  const SyncReport report = offsets_of(winding_drive(0.4, 0.4, 1, false));
  REQUIRE(report.speed);
  CHECK(report.speed->sigma_s < 0.1);
  CHECK(std::abs(report.speed->late_s - 0.4) < 3 * report.speed->sigma_s);
  REQUIRE(report.yaw_rate);
  CHECK(report.yaw_rate->sigma_s < 0.3);
  CHECK(std::abs(report.yaw_rate->late_s - 0.4) < 3 * report.yaw_rate->sigma_s);
}

TEST_CASE("sync: a missing leap second correction of 18 s is found") {
  const SyncReport report = offsets_of(winding_drive(18, 18, 0, false));
  REQUIRE(report.speed);
  CHECK(report.speed->late_s == Approx(18).margin(0.02));
}

TEST_CASE("sync: the name of an offset is what it usually is") {
  CHECK(name_of_offset(18, 0.5) == "18 leap seconds (GPS time against UTC)");
  CHECK(name_of_offset(-17.8, 0.5) == "18 leap seconds (GPS time against UTC)");
  CHECK(name_of_offset(15, 0.5) == "15 leap seconds (GPS time against UTC)");
  CHECK(name_of_offset(7200.1, 0.5) == "2 h of a time zone");
  CHECK(name_of_offset(-19'800, 0.5) == "5.5 h of a time zone");
  CHECK(name_of_offset(3618, 0.5) == "1 h of a time zone and 18 leap seconds (GPS time against UTC)");
  CHECK(name_of_offset(604'800, 0.5) == "a GPS week");
  CHECK(name_of_offset(-1'209'600, 0.5) == "2 GPS weeks");
  CHECK(name_of_offset(619'315'200, 0.5) == "1024 GPS weeks (a rollover of the week number)");
  CHECK(name_of_offset(-619'315'195, 0.5) ==
        "1024 GPS weeks (a rollover of the week number) and 5 leap seconds");
  CHECK(name_of_offset(315'964'782, 0.5) ==
        "the GPS epoch against the Unix epoch and 18 leap seconds (GPS time against UTC)");
  CHECK(name_of_offset(0, 0.5).empty());
  CHECK(name_of_offset(7, 0.5).empty());
  CHECK(name_of_offset(300, 0.5).empty());
}

TEST_CASE("sync: a minute of driving, and a clock of unknown zero, are enough") {
  PreparedDrive drive = winding_drive(0.4, 0.4, 0.5, true);
  std::erase_if(drive.odometry, [](const OdometrySample& sample) {
    return sample.stamp.seconds() < 200 || sample.stamp.seconds() > 260;
  });
  for (OdometrySample& sample : drive.odometry) sample.stamp = sample.stamp.later(-1e6);
  const SyncReport report = offsets_of(drive);
  REQUIRE(report.speed);
  CHECK(report.speed->late_s == Approx(-1e6 + 0.4).margin(0.05).epsilon(0));
  REQUIRE(report.yaw_rate);
  CHECK(report.yaw_rate->late_s == Approx(-1e6 + 0.4).margin(0.1).epsilon(0));
}

TEST_CASE("sync: jumps of the receiver do not decide") {
  PreparedDrive drive = winding_drive(0.4, 0.4, 0.5, false);
  for (std::size_t i = 50; i < drive.fixes.size(); i += 40)
    drive.fixes[i].position += Eigen::Vector2d(25, -15);
  const SyncReport report = offsets_of(drive);
  REQUIRE(report.speed);
  CHECK(std::abs(report.speed->late_s - 0.4) < 0.05);
}

TEST_CASE("sync: without motion there is nothing to compare, and nothing is claimed") {
  PreparedDrive drive = winding_drive(0, 0, 0, false);
  for (OdometrySample& sample : drive.odometry) sample.speed_mps = sample.yaw_rate_radps = 0;
  const SyncReport report = offsets_of(drive);
  CHECK_FALSE(report.speed.has_value());
  CHECK_FALSE(report.yaw_rate.has_value());
}

TEST_CASE("sync: odometry is moved by its delays, each quantity by its own") {
  const auto [speed_late, yaw_late] =
      GENERATE(std::pair(0.4, -0.15), std::pair(3.2, 4.1), std::pair(-2.0, -2.0));
  const PreparedDrive drive = winding_drive(speed_late, yaw_late, 0, false);
  const std::vector<OdometrySample> moved = without_delays(drive.odometry, speed_late, yaw_late);
  REQUIRE(moved.size() + 10 >=
          drive.odometry.size());  // readings beyond the ends are lost: 0.9 s at most here
  REQUIRE(moved.size() <= drive.odometry.size());
  for (std::size_t i = 0; i < moved.size(); i += 97) {
    const double t = moved[i].stamp.seconds();
    CHECK(moved[i].speed_mps == Approx(speed_of(t)).epsilon(1e-3));
    CHECK(moved[i].yaw_rate_radps == Approx(yaw_rate_of(t)).margin(1e-3));
  }
}

TEST_CASE("sync: a logger's clock is told by the GNSS time in its messages") {
  DriveLogs::Log log;
  log.file = "can.log";
  CHECK_FALSE(clock_of(log).has_value());
  for (const double late : {0.01, 0.0, 0.3, 0.02, 0.01})  // one message came late
    log.data.clocks.push_back({Stamp::from_seconds(1000 + 4.4 + late), Stamp::from_seconds(1000)});
  CHECK(clock_of(log)->ahead_s == Approx(4.41));
  CHECK(clock_of(log)->spread_s == Approx(0.01));
  CHECK(clock_of(log)->messages == 5);
}

TEST_CASE("sync: Aarhus' fixes lag the speed of its OBD by 0.4 s") {
  const auto data = waymark_test::shared_data("drives/aarhus_horsens");
  if (!data) return;
  DriveDescription description =
      load_drive_file(waymark_test::source_dir() + "/examples/drives/aarhus_horsens.yaml", *data).description;
  description.gnss.front().delay_s = 0;
  TypeRegistry registry;
  register_log_readers(registry);
  const SyncReport report = offsets_of(load_drive(description, registry));
  // Both on the logger's clock: the odometry is early by the delay of the fixes. 0.36 s by the receiver's
  // own speeds (gnss_speed_heading.csv against obd_speed.csv by a script of its own), 0.4 s to one digit.
  REQUIRE(report.speed);
  CHECK(report.speed->late_s == Approx(-0.36).margin(0.05));
  CHECK(report.speed->sigma_s < 0.05);
  CHECK(report.speed->correlation > 0.998);
  REQUIRE(report.yaw_rate);
  CHECK(report.yaw_rate->late_s == Approx(-0.28).margin(0.05));
}

}  // namespace clock_sync_test

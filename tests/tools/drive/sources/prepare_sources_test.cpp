// Logs of several receivers and odometries on one clock: who gives the nodes, and who is left out.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace prepare_sources_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

namespace {

constexpr double kMetresPerDegree = 111'226;  ///< of latitude, at 50 degrees; 0.1 % is enough here

/// A vehicle that drives north at 10 m/s.
GeodeticFix fix_at(double t, int source) {
  GeodeticFix fix;
  fix.stamp = Stamp::from_seconds(t);
  fix.latitude_deg = 50 + 10 * (t - 100) / kMetresPerDegree;
  fix.longitude_deg = 15;
  fix.source = source;
  return fix;
}

/// Its odometry. No two readings are the same, as those of a live sensor.
std::vector<OdometrySample> samples_at(double rate_hz, double first_s, double last_s) {
  std::vector<OdometrySample> samples;
  for (int i = 0; first_s + i / rate_hz <= last_s + 1e-9; ++i)
    samples.push_back({Stamp::from_seconds(first_s + i / rate_hz), 10 + 0.01 * (i % 7), 1e-4 * (i % 5)});
  return samples;
}

struct Drive {
  DriveLogs logs;
  DriveDescription description;

  Drive() {
    description.path = "drive.yaml";
    description.time_scale = TimeScale::gps;
  }
  void add_odometry(const std::string& name, std::vector<OdometrySample> samples) {
    DriveLogs::Log log;
    log.file = name + ".csv";
    log.data.odometry = std::move(samples);
    logs.odometry.push_back({log});
    description.odometry.emplace_back().name = name;
  }
  GnssConfig& add_receiver(const std::string& name, double rate_hz, double first_s, double last_s) {
    DriveLogs::Log log;
    log.file = name + ".csv";
    const int source = static_cast<int>(logs.gnss.size());
    for (int i = 0; first_s + i / rate_hz <= last_s + 1e-9; ++i)
      log.data.fixes.push_back(fix_at(first_s + i / rate_hz, source));
    logs.gnss.push_back(log);
    description.gnss.emplace_back();
    description.gnss.back().name = name;
    return description.gnss.back();
  }
  [[nodiscard]] PreparedDrive prepared() const { return prepare_drive(logs, description); }
};

std::string warnings_of(const PreparedDrive& drive) {
  std::string all;
  for (const std::string& warning : drive.report.warnings) all += warning + "\n";
  return all;
}

/// Every sample from a time on repeats the reading of that time.
std::vector<OdometrySample> frozen_between(std::vector<OdometrySample> samples, double from_s, double to_s) {
  for (OdometrySample& sample : samples) {
    if (sample.stamp.seconds() < from_s || sample.stamp.seconds() > to_s) continue;
    sample.speed_mps = 3;
    sample.yaw_rate_radps = 0.01;
  }
  return samples;
}

std::vector<Stamp> stamps_between(const PreparedDrive& drive, double from_s, double to_s) {
  std::vector<Stamp> stamps;
  for (const OdometrySample& sample : drive.odometry)
    if (sample.stamp.seconds() > from_s && sample.stamp.seconds() < to_s) stamps.push_back(sample.stamp);
  return stamps;
}

}  // namespace

TEST_CASE("prepare sources: every receiver has its own delay, period and antenna") {
  Drive drive;
  drive.add_odometry("wheels", samples_at(10, 100, 160));
  GnssConfig& front = drive.add_receiver("front", 1, 101, 159);
  front.delay_s = 0.25;
  front.antenna_m = {2.6, 0};
  GnssConfig& rear = drive.add_receiver("rear", 10, 100.1, 159.9);
  rear.period_s = 0.5;
  rear.antenna_m = {-0.8, 0.3};
  const PreparedDrive prepared = drive.prepared();
  REQUIRE(prepared.receivers.size() == 2);
  CHECK(prepared.receivers[0].name == "front");
  CHECK(prepared.receivers[1].antenna_m == Eigen::Vector2d(-0.8, 0.3));
  std::size_t of_front = 0;
  std::size_t of_rear = 0;
  for (const Fix& fix : prepared.fixes) {
    const double t = fix.stamp.seconds();
    if (fix.source == 0) {
      ++of_front;
      CHECK(fix.antenna_m == Eigen::Vector2d(2.6, 0));
      CHECK(t - std::floor(t) == Approx(0.75));
    } else {
      ++of_rear;
      CHECK(fix.antenna_m == Eigen::Vector2d(-0.8, 0.3));
    }
  }
  CHECK(of_front == 59);
  // One of each half second from 100 to 160; at the ends the nearest are 0.1 s away.
  CHECK(of_rear == 121);
  CHECK(prepared.report.fixes_thinned == 599 - 121);
}

TEST_CASE("prepare sources: each receiver counts its own fixes that are withheld") {
  Drive drive;
  drive.add_odometry("wheels", samples_at(10, 100, 160));
  drive.add_receiver("front", 1, 101, 159).withhold_every = 2;
  drive.add_receiver("rear", 1, 101.5, 158.5).withhold_every = 5;
  drive.add_receiver("roof", 1, 101.2, 150.2).withheld = true;
  const PreparedDrive prepared = drive.prepared();
  std::array<int, 3> withheld{};
  for (const Fix& fix : prepared.fixes)
    if (fix.status == FixStatus::withheld) ++withheld.at(static_cast<std::size_t>(fix.source));
  CHECK(withheld == std::array<int, 3>{59 / 2, 58 / 5, 50});
}

TEST_CASE("prepare sources: the densest odometry gives the nodes, unless another one is stated") {
  Drive drive;
  drive.add_odometry("visual", samples_at(5, 100.05, 160));
  drive.add_odometry("wheels", samples_at(10, 100, 160));
  drive.add_receiver("front", 1, 101, 159);
  const PreparedDrive dense = drive.prepared();
  CHECK(dense.odometry_name == "wheels");
  CHECK(dense.odometry.size() == 601);
  REQUIRE(dense.relative.size() == 2);
  CHECK(dense.relative[0].name == "wheels");
  CHECK(dense.relative[1].name == "visual");
  drive.description.odometry[0].gives_nodes = true;
  const PreparedDrive stated = drive.prepared();
  CHECK(stated.odometry_name == "visual");
  // Only what the wheels say before 100.05 s and after 159.85 s is added.
  CHECK(stated.odometry.size() == 300 + 1 + 2);
}

TEST_CASE(
    "prepare sources: where the odometry of the nodes is silent, the samples of another one are nodes") {
  Drive drive;
  std::vector<OdometrySample> wheels = samples_at(10, 100, 160);
  std::erase_if(wheels, [](const OdometrySample& s) {
    return s.stamp.seconds() > 120.05 && s.stamp.seconds() < 129.95;
  });
  drive.add_odometry("wheels", wheels);
  drive.add_odometry("visual", samples_at(5, 100.06, 160));
  drive.add_receiver("front", 1, 101, 159);
  const PreparedDrive prepared = drive.prepared();
  CHECK(prepared.odometry_name == "wheels");
  const std::vector<Stamp> there = stamps_between(prepared, 120.01, 129.99);
  REQUIRE(there.size() == 50);
  for (std::size_t i = 0; i < there.size(); ++i)
    CHECK(there[i] == Stamp::from_seconds(120.06 + 0.2 * static_cast<double>(i)));
  for (const OdometrySample& sample : prepared.odometry) CHECK_FALSE(sample.assumed);
}

TEST_CASE("prepare sources: an odometry without a usable sample is left out with a warning") {
  Drive drive;
  std::vector<OdometrySample> broken = samples_at(20, 100, 160);
  for (OdometrySample& sample : broken) sample.speed_mps = std::numeric_limits<double>::quiet_NaN();
  drive.add_odometry("visual", broken);
  drive.add_odometry("wheels", samples_at(10, 100, 160));
  drive.add_receiver("front", 1, 101, 159);
  const PreparedDrive prepared = drive.prepared();
  CHECK(prepared.odometry_name == "wheels");
  CHECK(prepared.relative.empty());
  CHECK(prepared.odometry.size() == 601);
  CHECK_THAT(warnings_of(prepared), Contains("visual is left out: visual.csv: 0 usable odometry samples"));
}

TEST_CASE("prepare sources: an odometry outside the window of the drive is left out with a warning") {
  Drive drive;
  drive.add_odometry("wheels", samples_at(10, 100, 160));
  drive.add_odometry("visual", samples_at(20, 150, 160));
  drive.add_receiver("front", 1, 101, 159);
  drive.description.to_s = 40;
  const PreparedDrive prepared = drive.prepared();
  CHECK(prepared.odometry_name == "wheels");
  CHECK_THAT(warnings_of(prepared), Contains("visual is left out"));
  drive.logs.odometry.erase(drive.logs.odometry.begin());
  drive.description.odometry.erase(drive.description.odometry.begin());
  drive.description.from_s = 20;
  CHECK_THROWS_AS(drive.prepared(), InputError);
}

TEST_CASE("prepare sources: a frozen odometry is left out for that time, and the others measure the motion") {
  Drive drive;
  drive.add_odometry("wheels", frozen_between(samples_at(10, 100, 220), 140, 180));
  drive.add_odometry("visual", samples_at(5, 100.06, 220));
  drive.add_receiver("front", 1, 101, 219);
  const PreparedDrive prepared = drive.prepared();
  CHECK_THAT(warnings_of(prepared), Contains("wheels: "));
  REQUIRE(prepared.relative.size() == 2);
  for (const OdometrySample& sample : prepared.relative[0].samples) CHECK(sample.speed_mps > 9);
  for (const OdometrySample& sample : prepared.odometry) {
    CHECK(sample.speed_mps > 9);
    CHECK_FALSE(sample.assumed);
  }
}

TEST_CASE(
    "prepare sources: an odometry that is frozen from end to end is left out, with two others beside it") {
  Drive drive;
  drive.add_odometry("wheels", frozen_between(samples_at(10, 100, 220), 0, 1e9));
  drive.add_odometry("visual", samples_at(5, 100.06, 220));
  drive.add_odometry("lidar", samples_at(4, 100.01, 220));
  drive.add_receiver("front", 1, 101, 219);
  const PreparedDrive prepared = drive.prepared();
  CHECK(prepared.odometry_name == "visual");
  REQUIRE(prepared.relative.size() == 2);
  CHECK(prepared.relative[1].name == "lidar");
  CHECK_THAT(warnings_of(prepared), Contains("wheels: nothing of it is usable, so it is left out"));
}

TEST_CASE("prepare sources: fixes before the first usable odometry are dropped, and the drive is placed") {
  Drive drive;
  drive.add_odometry("wheels", frozen_between(samples_at(10, 100, 220), 0, 140));
  drive.add_odometry("visual", samples_at(5, 135.06, 220));
  drive.add_receiver("front", 1, 101, 219);
  const PreparedDrive prepared = drive.prepared();
  CHECK(prepared.fixes.front().stamp >= prepared.odometry.front().stamp);
  CHECK(prepared.fixes.front().epoch == 0);
  CHECK(prepared.report.fixes_outside_odometry > 30);
  CHECK_NOTHROW(timeline_of(prepared));
}

}  // namespace prepare_sources_test

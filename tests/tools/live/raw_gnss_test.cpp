// Live fusion of a vehicle without a receiver of positions: pseudoranges alone.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <waymark/tools/drive/coordinates/projection.hpp>

#include "live_drive.hpp"
#include "support/registry.hpp"

namespace live_raw_gnss_test {

using namespace waymark;
using namespace waymark::live;
using namespace waymark_test;

namespace {

constexpr int kSatellites = 9;
constexpr double kSigma_m = 2;  // of the white and the slow part, as gnss_raw assumes
constexpr double kHeight_m = 40;

/// The frame that the helpers of live drives compare in.
Frame frame_of(const LiveDrive& drive) {
  const GeodeticFix& first = drive.simulated.fixes.front().fix;
  return drive::choose_frame({first.latitude_deg, first.longitude_deg}, std::nullopt, std::nullopt);
}

drive::DriveDescription raw_description(const LiveDrive& drive) {
  drive::DriveDescription description = live_description({});
  const Frame frame = frame_of(drive);
  description.utm_zone = frame.north ? frame.zone : -frame.zone;
  description.utm_origin = Eigen::Vector2d(frame.origin_easting_m, frame.origin_northing_m);
  drive::SensorConfig& sensor = description.sensors.emplace_back();
  sensor.name = "gnss_raw";
  sensor.options = {{"satellites_at", "reception"}, {"multipath_sigma", "0"}, {"tails", "gaussian"}};
  sensor.log.emplace();
  sensor.log->request.readings = registry().sensor_model("gnss_raw").columns;
  return description;
}

/// Odometry, and instead of each fix an epoch of pseudoranges of satellites that stand still.
Arrivals raw_arrivals(const LiveDrive& drive, std::uint64_t seed) {
  const drive::Projection projection(frame_of(drive));
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  const auto ecef = [&](const GeodeticTruth& truth) {
    const Eigen::Vector2d at = projection.to_grid({truth.latitude_deg, truth.longitude_deg}).position;
    return projection.to_ecef({.position = at, .height_m = kHeight_m});
  };
  const Eigen::Vector3d origin = ecef(drive.simulated.truth.front());
  const Eigen::Vector3d up = origin.normalized();
  const Eigen::Vector3d east = Eigen::Vector3d::UnitZ().cross(up).normalized();
  std::vector<Eigen::Vector3d> satellites;
  std::vector<double> slow_m;
  for (int i = 0; i < kSatellites; ++i) {
    const double azimuth = 0.7 * i;
    const double elevation = 0.3 + 0.4 * (i % 3);
    const Eigen::Vector3d level = std::cos(azimuth) * up.cross(east) + std::sin(azimuth) * east;
    satellites.push_back(origin + 2.2e7 * (std::cos(elevation) * level + std::sin(elevation) * up));
    slow_m.push_back(kSigma_m * normal(engine));
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Arrivals arrivals;
  auto truth = drive.simulated.truth.begin();
  for (const Sample& sample : drive.arrivals) {
    if (!std::holds_alternative<GeodeticFix>(sample)) {
      arrivals.push_back(sample);
      continue;
    }
    while (truth + 1 != drive.simulated.truth.end() && truth->stamp < stamp_of(sample)) ++truth;
    const double clock_m = 3e4 - 50 * seconds_between(drive.simulated.truth.front().stamp, truth->stamp);
    for (std::size_t i = 0; i < satellites.size(); ++i) {
      const double range =
          (satellites[i] - ecef(*truth)).norm() + clock_m + slow_m[i] + kSigma_m * normal(engine);
      arrivals.emplace_back(
          SensorReading{truth->stamp,
                        0,
                        {1, static_cast<double>(i + 1), range, kNone, satellites[i].x(), satellites[i].y(),
                         satellites[i].z(), kNone, kNone, kNone, kNone, kNone}});
    }
  }
  return arrivals;
}

}  // namespace

TEST_CASE("pseudoranges alone place a vehicle while it drives, and their regions hold it", "[live]") {
  double squares = 0;
  double poses = 0;
  double coverage = 0;
  constexpr int kDrives = 4;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const LiveDrive drive = live_drive("mixed", 200, seed);
    const Said said = listen(raw_description(drive), raw_arrivals(drive, seed));
    CHECK(said.counts.failures == 0);
    CHECK(said.counts.resets == 0);
    CHECK(said.counts.refused.empty());
    CHECK(said.state == State::tracking);
    for (const double error : errors_m(said, drive)) {
      squares += error * error;
      ++poses;
    }
    coverage += coverage95(said, drive) / kDrives;
  }
  // Nine satellites with a lasting error of 2 m each leave about 2 m.
  CHECK(poses > kDrives * 150 * 10);
  CHECK(std::sqrt(squares / poses) < 3);
  CHECK(coverage > 0.9);
}

TEST_CASE("all rows of an epoch count, and the same row twice is a duplicate", "[live]") {
  const LiveDrive drive = live_drive("mixed", 60);
  Arrivals arrivals = raw_arrivals(drive, 1);
  const auto rows =
      static_cast<std::size_t>(std::count_if(arrivals.begin(), arrivals.end(), [](const Sample& s) {
        return std::holds_alternative<SensorReading>(s);
      }));
  LiveSettings settings;
  settings.reorder_s = 0.5;
  const auto first = std::find_if(arrivals.begin() + 500, arrivals.end(),
                                  [](const Sample& s) { return std::holds_alternative<SensorReading>(s); });
  arrivals.insert(first, *first);
  const Said said = listen(raw_description(drive), arrivals, settings);
  CHECK(said.counts.taken.at("gnss_raw") == rows);
  CHECK(said.counts.refused.at("gnss_raw: duplicate") == 1);
}

TEST_CASE("a satellite that is no satellite is refused, and the drive goes on", "[live]") {
  const LiveDrive drive = live_drive("mixed", 60);
  Arrivals arrivals = raw_arrivals(drive, 1);
  auto bad = std::find_if(arrivals.begin() + 500, arrivals.end(),
                          [](const Sample& s) { return std::holds_alternative<SensorReading>(s); });
  constexpr std::size_t kX = 4;
  for (std::size_t axis = 0; axis < 3; ++axis) std::get<SensorReading>(*bad).values[kX + axis] = 1000;
  const Said said = listen(raw_description(drive), arrivals);
  CHECK(said.counts.refused == std::map<std::string, std::size_t>{{"gnss_raw: impossible", 1}});
  CHECK(said.count("impossible") == 1);
  CHECK(said.state == State::tracking);
}

TEST_CASE("without a receiver and without sensors there is nothing to fuse", "[live]") {
  CHECK_THROWS_WITH(listen(live_description({}), {}),
                    "live fusion needs a receiver, or a sensor that places the vehicle");
}

}  // namespace live_raw_gnss_test

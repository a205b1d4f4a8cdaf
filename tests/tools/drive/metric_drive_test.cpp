// A drive whose logs give positions in metres is the drive that its latitudes and longitudes describe.
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/csv/csv_log.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>

#include "support/registry.hpp"

namespace metric_drive_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;

namespace {

const Frame kFrame{17, true, 280'000, 4'685'000};  // 2.7 degrees west of the zone's meridian
constexpr double kSpeed = 8;                       // m/s along a circle ...
constexpr double kYawRate = 0.1;                   // ... in 63 s
constexpr int kSeconds = 60;

/// A place on the circle, with an error of a metre that no sum takes away.
Eigen::Vector2d fix_on_grid(int second) {
  const double angle = kYawRate * second;
  const Eigen::Vector2d place(std::sin(angle), 1 - std::cos(angle));
  return kSpeed / kYawRate * place + Eigen::Vector2d(std::sin(3.0 * second), std::cos(5.0 * second));
}

LogData read_fixes(const std::string& table) {
  LogRequest request;
  request.metric_frame = kFrame;
  return CsvLogReader().read(table, "gnss.csv", request);
}

std::ostringstream exact_table(const std::string& header) {
  std::ostringstream table;
  table.precision(std::numeric_limits<double>::max_digits10);
  table << header << '\n';
  return table;
}

/// The same fixes on the grid, and in degrees with the covariance turned to true axes.
std::string table_in_metres() {
  std::ostringstream table = exact_table("time,easting,northing,sigma_east,sigma_north");
  for (int t = 0; t <= kSeconds; ++t)
    table << t << ',' << fix_on_grid(t).x() << ',' << fix_on_grid(t).y() << ",1,2\n";
  return table.str();
}

std::string table_in_degrees() {
  std::ostringstream table =
      exact_table("time,latitude,longitude,sigma_east,sigma_north,covariance_en_signed_root");
  for (int t = 0; t <= kSeconds; ++t) {
    const GeodeticPoint point = Projection(kFrame).to_geodetic(fix_on_grid(t));
    const GridPoint grid = Projection(kFrame).to_grid(point);
    const double c = std::cos(grid.convergence_rad);
    const double s = std::sin(grid.convergence_rad);
    const double k = grid.scale;
    // Errors of 1 m along (c, -s) and of 2 m along (s, c), the grid's axes by their true east and north.
    const double east = std::sqrt(c * c + 4 * s * s) / k;
    const double north = std::sqrt(s * s + 4 * c * c) / k;
    const double common = 3 * s * c / (k * k);
    table << t << ',' << point.latitude_deg << ',' << point.longitude_deg << ',' << east << ',' << north
          << ',' << std::copysign(std::sqrt(std::abs(common)), common) << '\n';
  }
  return table.str();
}

PreparedDrive drive_of(const std::string& table) {
  DriveDescription description;
  description.path = "drive.yaml";
  description.utm_zone = kFrame.zone;
  description.utm_origin = {kFrame.origin_easting_m, kFrame.origin_northing_m};
  DriveLogs logs;
  logs.odometry.assign(1, std::vector<DriveLogs::Log>(1));
  for (int i = 0; i <= 10 * kSeconds; ++i)
    logs.odometry[0][0].data.odometry.push_back({Stamp::from_seconds(0.1 * i), kSpeed, kYawRate});
  logs.gnss.emplace_back();
  logs.gnss[0].data = read_fixes(table);
  return prepare_drive(logs, description);
}

std::vector<StampedPose> fused_poses(const PreparedDrive& drive) {
  FusionSettings settings;
  settings.modeling = "g1";
  return poses_at_fixes(fuse(drive, settings, waymark_test::registry()).model.document);
}

DriveFile parse(const std::string& frame) {
  return parse_drive_file("odometry: {file: o.csv}\ngnss: {file: g.csv}\ntruth: {file: t.csv}\n" + frame,
                          "drive.yaml", "");
}

}  // namespace

TEST_CASE("metric drive: a fix in metres comes back in the frame where it was, with its covariance") {
  const LogData data = read_fixes(
      "time,easting,northing,sigma_east,sigma_north,covariance_en_signed_root\n"
      "1,1234.5678901,-987.6543210,1.5,4,-2\n2,-150000,20000,1,1,0.5\n");
  REQUIRE(data.fixes.size() == 2);
  const Fix near = Projection(kFrame).project(data.fixes[0]);
  CHECK(near.position.x() == Approx(1234.5678901).margin(1e-7));
  CHECK(near.position.y() == Approx(-987.6543210).margin(1e-7));
  Eigen::Matrix2d given;
  given << 2.25, -4, -4, 16;
  CHECK((near.covariance - given).norm() < 1e-12);
  const Fix far = Projection(kFrame).project(data.fixes[1]);
  CHECK((far.position - Eigen::Vector2d(-150'000, 20'000)).norm() < 1e-7);
  given << 1, 0.25, 0.25, 1;
  CHECK((far.covariance - given).norm() < 1e-12);
}

TEST_CASE("metric drive: metres and degrees of one drive give the same fixes and the same poses") {
  const PreparedDrive metres = drive_of(table_in_metres());
  const PreparedDrive degrees = drive_of(table_in_degrees());
  CHECK(metres.frame == kFrame);
  REQUIRE(metres.fixes.size() == kSeconds + 1);
  REQUIRE(degrees.fixes.size() == metres.fixes.size());
  for (std::size_t i = 0; i < metres.fixes.size(); ++i) {
    CHECK((metres.fixes[i].position - fix_on_grid(static_cast<int>(i))).norm() < 1e-7);
    CHECK((metres.fixes[i].position - degrees.fixes[i].position).norm() < 1e-7);
    CHECK((metres.fixes[i].covariance - degrees.fixes[i].covariance).norm() < 1e-9);
  }
  const std::vector<StampedPose> by_metres = fused_poses(metres);
  const std::vector<StampedPose> by_degrees = fused_poses(degrees);
  REQUIRE(by_metres.size() == kSeconds + 1);
  REQUIRE(by_degrees.size() == by_metres.size());
  for (std::size_t i = 0; i < by_metres.size(); ++i)
    CHECK((by_metres[i].pose - by_degrees[i].pose).norm() < 1e-5);
}

TEST_CASE("metric drive: a stated frame reaches the logs of fixes and truth") {
  const DriveDescription stated = parse("frame: {utm_zone: 56S, origin: [300000, 6250000]}\n").description;
  CHECK(stated.gnss[0].request.metric_frame == Frame{56, false, 300'000, 6'250'000});
  CHECK(stated.truth->request.metric_frame == Frame{56, false, 300'000, 6'250'000});
  CHECK_FALSE(stated.odometry[0].logs[0].request.metric_frame);
  // The origin that the drive chooses later is not that of its logs: they have plain UTM coordinates.
  CHECK(parse("frame: {utm_zone: 17N}\n").description.gnss[0].request.metric_frame == Frame{17, true, 0, 0});
  CHECK_FALSE(parse("").description.gnss[0].request.metric_frame);
}

}  // namespace metric_drive_test

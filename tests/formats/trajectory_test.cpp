#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Contains;

namespace {

TrajectoryPoint point(std::int64_t nanoseconds, double x, double y, double heading) {
  TrajectoryPoint p;
  p.stamp = Stamp{nanoseconds};
  p.pose = {x, y, heading};
  return p;
}

std::string tum_error(const std::string& text) {
  try {
    static_cast<void>(read_tum(text, "truth.tum"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("trajectory: stamps as decimal seconds are exact") {
  CHECK(decimal_seconds(Stamp{1149206567040000001}) == "1149206567.040000001");
  CHECK(decimal_seconds(Stamp{0}) == "0.000000000");
  CHECK(decimal_seconds(Stamp{-1}) == "-0.000000001");
  CHECK(decimal_seconds(Stamp{-1500000000}) == "-1.500000000");
  CHECK(decimal_seconds(Stamp{std::numeric_limits<std::int64_t>::min()}) == "-9223372036.854775808");
  for (const std::int64_t ns : {1149206567040000001LL, -7LL, 0LL, 9223372036854775807LL})
    CHECK(stamp_from_decimal_seconds(decimal_seconds(Stamp{ns})) == Stamp{ns});
}

TEST_CASE("trajectory: decimal seconds are read in every usual spelling") {
  CHECK(stamp_from_decimal_seconds("12") == Stamp{12'000'000'000});
  CHECK(stamp_from_decimal_seconds("+.5") == Stamp{500'000'000});
  CHECK(stamp_from_decimal_seconds("5.") == Stamp{5'000'000'000});
  CHECK(stamp_from_decimal_seconds("1.305031102175303936e+09") == Stamp{1305031102175303936});  // numpy
  CHECK(stamp_from_decimal_seconds("25E-3") == Stamp{25'000'000});
  CHECK(stamp_from_decimal_seconds("0.0000000004") == Stamp{0});
  CHECK(stamp_from_decimal_seconds("0.0000000005") == Stamp{1});
  CHECK(stamp_from_decimal_seconds("1.9999999996") == Stamp{2'000'000'000});
  CHECK(stamp_from_decimal_seconds("-12.25") == Stamp{-12'250'000'000});
  CHECK(stamp_from_decimal_seconds("9223372036.854775807") ==
        Stamp{std::numeric_limits<std::int64_t>::max()});
  CHECK(stamp_from_decimal_seconds("-9223372035.999999999") == Stamp{-9'223'372'035'999'999'999});
  CHECK(stamp_from_decimal_seconds("00000000001.5") == Stamp{1'500'000'000});
  CHECK(stamp_from_decimal_seconds("1e-300") == Stamp{0});
  CHECK(stamp_from_decimal_seconds("0e400") == Stamp{0});
  for (const char* bad : {"", "-", ".", "abc", "1.2.3", "1e", "1e+", "1e+-3", "1 ", " 1", "nan", "0x10",
                          "1,5", "1e300", "9223372037", "--1"})
    CHECK_FALSE(stamp_from_decimal_seconds(bad));
}

TEST_CASE("CSV: shortest exact numbers, empty fields where nothing is known") {
  TrajectoryPoint full = point(1149206567040000000, 0.1, 5701234.567, -1.0 / 3.0);
  full.latitude_deg = 52.5;
  full.longitude_deg = 13.25;
  full.covariance = Eigen::Vector3d(1, 2.5 * 2.5, 0.001 * 0.001).asDiagonal();
  full.status = "rejected";
  full.reason = "angle";
  full.utc = Stamp{1149149767040000000};
  const std::vector<TrajectoryPoint> points{full, point(-5, 1, 2, 0)};
  CHECK(trajectory_csv(points) ==
        "stamp_ns,x_m,y_m,heading_rad,latitude_deg,longitude_deg,sigma_x_m,sigma_y_m,sigma_heading_rad,"
        "status,reason,unix_s,utc\n"
        "1149206567040000000,0.1,5701234.567,-0.3333333333333333,52.5,13.25,1,2.5,0.001,rejected,angle,"
        "1149149767.040000000,2006-06-01T08:16:07.04Z\n"
        "-5,1,2,0,,,,,,,,,\n");
}

TEST_CASE("CSV: text with separators is quoted") {
  TrajectoryPoint p = point(0, 0, 0, 0);
  p.reason = "15 m, \"far\"";
  CHECK_THAT(trajectory_csv(std::vector{p}), Contains(",\"15 m, \"\"far\"\"\",,\n"));
}

TEST_CASE("TUM: stamps exact, heading as a quaternion") {
  const std::vector<TrajectoryPoint> points{point(1149206567040000001, 1.5, -2, 0),
                                            point(2'000'000'000, 0, 0, std::numbers::pi)};
  const std::string text = trajectory_tum(points);
  CHECK_THAT(text, Catch::StartsWith("# t x y z qx qy qz qw\n1149206567.040000001 1.5 -2 0 0 0 0 1\n"
                                     "2.000000000 0 0 0 0 0 1 "));
}

TEST_CASE("TUM: single blanks, none at the end, as evo's reader demands") {
  const std::string text = trajectory_tum(std::vector{point(1, -0.5, 1e-7, 3), point(2, 1e6, 0, -3)});
  CHECK_THAT(text, !Contains("  ") && !Contains(" \n") && !Contains("\t") && !Contains("\r"));
  const std::string data = text.substr(text.find('\n') + 1);
  CHECK(std::count(data.begin(), data.end(), '\n') == 2);
  CHECK(std::count(data.begin(), data.end(), ' ') == 2 * 7);
}

TEST_CASE("TUM: a written file reads back") {
  std::vector<TrajectoryPoint> points;
  for (int i = -20; i <= 20; ++i)
    points.push_back(point(1'700'000'000'123'456'789 + i, 1e5 + i / 7.0, -i / 3.0, 0.157 * i));
  const std::vector<StampedPose> poses = read_tum(trajectory_tum(points), "t");
  REQUIRE(poses.size() == points.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CHECK(poses[i].stamp == points[i].stamp);
    CHECK(poses[i].pose.head<2>() == points[i].pose.head<2>());  // the same doubles
    CHECK(poses[i].pose[2] == Approx(points[i].pose[2]).margin(1e-15));
  }
}

TEST_CASE("TUM: comments, blank lines, CRLF, BOM, tabs, no final line end") {
  const auto poses =
      read_tum("\xEF\xBB\xBF# made by hand\r\n\r\n  \n1 2 3 0 0 0 0 1\r\n\t2\t4 +5 9  0 0 1 0", "t");
  REQUIRE(poses.size() == 2);
  CHECK(poses[0].pose == Eigen::Vector3d(2, 3, 0));
  CHECK(poses[1].stamp == Stamp{2'000'000'000});
  CHECK(poses[1].pose[2] == Approx(std::numbers::pi));
}

TEST_CASE("TUM: heading is the yaw of a full rotation") {
  // yaw 0.5 after pitch 0.1: q = q_z(0.5) q_y(0.1)
  const double cy = std::cos(0.25), sy = std::sin(0.25), cp = std::cos(0.05), sp = std::sin(0.05);
  const std::string line = "0 0 0 0 " + std::to_string(-sy * sp) + " " + std::to_string(cy * sp) + " " +
                           std::to_string(sy * cp) + " " + std::to_string(cy * cp);
  CHECK(read_tum(line, "t")[0].pose[2] == Approx(0.5).epsilon(1e-5));
  CHECK(read_tum("0 0 0 0 0 0 -1 0", "t")[0].pose[2] == std::numbers::pi);  // (-pi, pi]
}

TEST_CASE("TUM: errors name file, line, column, found and expected") {
  CHECK(tum_error("# c\n1 2 abc 0 0 0 0 1\n") == "truth.tum:2:5: TUM: expected a number for 'y', got 'abc'");
  CHECK(tum_error("x 2 3 0 0 0 0 1") == "truth.tum:1:1: TUM: expected a number for 't', got 'x'");
  CHECK(tum_error("1 2 nan 0 0 0 0 1") == "truth.tum:1:5: TUM: expected a finite number for 'y', got 'nan'");
  CHECK(tum_error("1 2 3 0 0 0 0\n") ==
        "truth.tum:1:14: TUM: expected a number for 'qw', got the end of the line");
  CHECK(tum_error("1 2 3 0 0 0 0 1 7") == "truth.tum:1:17: TUM: expected the end of the line, got '7'");
  CHECK(tum_error("1 2 3 0 0 0 0 0") == "truth.tum:1:15: TUM: expected a unit quaternion, got norm 0");
  CHECK(tum_error("") == "truth.tum: TUM: no pose in it");
  CHECK(tum_error("# only a comment") == "truth.tum: TUM: no pose in it");
}

TEST_CASE("trajectory: what cannot be written is an error that names the point") {
  const std::vector<TrajectoryPoint> nan{point(0, 0, 0, 0), point(1'000'000'000, std::nan(""), 0, 0)};
  CHECK_THROWS_AS(trajectory_csv(nan), OutputError);
  CHECK_THROWS_WITH(trajectory_tum(nan), Contains("pose 2 at 1.000000000 s: not finite"));
}

TEST_CASE("trajectory: a text that a spreadsheet would compute is made harmless") {
  TrajectoryPoint p = point(0, 1, 2, 0);
  p.status = "-12.5e3";
  p.reason = "=HYPERLINK(\"http://x\")";
  CHECK_THAT(trajectory_csv(std::vector{p}), Contains(",-12.5e3,\"'=HYPERLINK(\"\"http://x\"\")\",,\n"));
  for (const char* formula : {"=1", "+a", "-1+2", "@SUM(1)", "\t=1"}) {
    p.reason = formula;
    CHECK_THAT(trajectory_csv(std::vector{p}), Contains(",'" + std::string(formula) + ",,\n"));
  }
}

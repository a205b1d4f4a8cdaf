// Tables of positions in metres. The numbers of UTM come from published coordinates and from the
// symmetry of the map, never from the reader.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>

#include "logs/csv/csv_text.hpp"
#include "logs/log_pieces.hpp"

namespace metric_positions_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
using waymark_test::read_csv;

namespace {

/// Zone 38 with an origin near Baghdad.
LogRequest gnss(double default_sigma_m = 3) {
  LogRequest request;
  request.default_sigma_m = default_sigma_m;
  request.metric_frame = Frame{38, true, 444'000, 3'684'000};
  return request;
}

}  // namespace

TEST_CASE("metric positions: easting and northing in the frame are a place on the ellipsoid") {
  // 33.3 N 44.4 E = 38SMB 44140 84706 (the example of GeographicLib's MGRS documentation).
  const LogData data = read_csv("time,easting,northing\n1,140.5,706.5\n", gnss());
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].latitude_deg == Approx(33.3).margin(1e-5));
  CHECK(data.fixes[0].longitude_deg == Approx(44.4).margin(1e-5));
  CHECK(data.notes[0] == "log.csv:1:1: columns by their default names: time, easting, northing");
}

TEST_CASE("metric positions: columns, units and hemisphere are as stated, for truth too") {
  LogRequest request;
  request.stream = StreamKind::truth;
  request.metric_frame = Frame{32, false};  // plain UTM coordinates of the south
  request.columns = {{"easting", {"x", "cm", ""}}, {"northing", {"y", "mm", ""}}};
  const LogData data = read_csv("time,y,x,latitude,heading\n1,10000000000,50000000,7,0.5\n", request);
  REQUIRE(data.truth.size() == 1);
  CHECK(data.truth[0].latitude_deg == Approx(0).margin(1e-12));  // the equator on the central meridian
  CHECK(data.truth[0].longitude_deg == Approx(9));
  CHECK(*data.truth[0].heading_rad == 0.5);  // true, as its convention says: not turned
}

TEST_CASE("metric positions: accuracies are those of the grid's axes, the covariance that of true axes") {
  // East of the central meridian grid north points east of true north, by the convergence g with
  // tan g = sin(latitude) tan(longitude - 45), up to 2e-6. An error along grid north alone has
  // therefore a part to the true east, and one along grid east a part to the true south.
  LogRequest request = gnss(0);
  request.metric_frame->origin_easting_m = 0;
  request.metric_frame->origin_northing_m = 0;
  const LogData data =
      read_csv("time,easting,northing,sigma_east,sigma_north\n1,750000,3684706,1,3\n", request);
  const GeodeticFix& fix = data.fixes.at(0);
  const double degree = std::numbers::pi / 180;
  const double g =
      std::atan(std::sin(fix.latitude_deg * degree) * std::tan((fix.longitude_deg - 45) * degree));
  REQUIRE(g > 0.02);
  const double x = 250'000 / 6.37e6;
  const double scale = 0.9996 * (1 + x * x / 2);
  const Eigen::Matrix2d grid = scale * scale * fix.covariance_en;
  CHECK(grid(0, 0) == Approx(std::pow(std::cos(g), 2) + 9 * std::pow(std::sin(g), 2)).epsilon(2e-5));
  CHECK(grid(0, 1) == Approx((9 - 1) * std::sin(g) * std::cos(g)).epsilon(2e-4));
  CHECK(grid(1, 1) == Approx(9 * std::pow(std::cos(g), 2) + std::pow(std::sin(g), 2)).epsilon(2e-5));
}

TEST_CASE("metric positions: a stated sigma is one of metres on the ground") {
  const LogData data = read_csv("time,easting,northing\n1,0,0\n", gnss(3));
  CHECK(data.fixes.at(0).covariance_en == Eigen::Matrix2d(9 * Eigen::Matrix2d::Identity()));
}

TEST_CASE("metric positions: a row without a position is a row without a fix") {
  const LogData data =
      read_csv("time,easting,northing\n1,,\n2,nan,NaN\n3,5,6\n4,5,\n5,x,6\n6,9e6,0\n", gnss());
  CHECK(data.fixes.size() == 1);
  CHECK(data.without_fix == 2);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            "log.csv:5:5: northing: no value", "log.csv:6:3: easting: expected a number, got 'x'",
            "log.csv:7:3: easting: UTM easting 9444000, northing 3684000 are outside zone 38"});
  CHECK(data.notes.back() == "log.csv: 2 of 6 records are marked as without a fix");
  // The same rule holds for degrees.
  CHECK(read_csv("time,latitude,longitude\n1,,\n2,50,8\n", gnss()).without_fix == 1);
  CHECK(read_csv("time,latitude,longitude\n1,50,\n2,50,8\n", gnss()).corrupt == 1);
}

TEST_CASE("metric positions: without a frame they are no place, and the error says what is needed") {
  LogRequest request = gnss();
  request.metric_frame.reset();
  CHECK_THROWS_MATCHES(
      read_csv("time,easting,northing\n1,5,6\n", request), InputError,
      Message("log.csv:1:1: easting and northing are coordinates of a stated frame: the log needs "
              "'frame: {utm_zone: 32N}' or 'frame: {enu_origin: [LATITUDE, LONGITUDE]}'"));
  // A table that has degrees, too, needs no frame.
  CHECK(
      read_csv("time,easting,northing,latitude,longitude\n1,5,6,50,8\n", request).fixes.at(0).latitude_deg ==
      50);
}

TEST_CASE("metric positions: columns name one kind of position") {
  LogRequest request = gnss();
  request.columns = {{"easting", {"x", "", ""}}, {"latitude", {"y", "", ""}}};
  CHECK_THROWS_MATCHES(read_csv("time,x,y\n1,5,6\n", request), InputError,
                       Message("log.csv:1:1: columns name two kinds of position: keep latitude and "
                               "longitude, easting and northing, or ecef_x, ecef_y and ecef_z"));
  request.columns.erase("latitude");
  CHECK_THROWS_MATCHES(
      read_csv("time,x,y\n1,5,6\n", request), InputError,
      Message("log.csv:1:1: no column for northing (neither 'northing' nor 'northing_m'): name it "
              "under columns; columns present: time, x, y"));
}

TEST_CASE("metric positions: pieces of any length give the same") {
  const LogData data = waymark_test::check_pieces(
      CsvLogReader(), "time;easting_m;northing_m;accuracy\n1;5;6;2\n2;;;1\n3;6;7;0", "log.csv", gnss());
  CHECK(data.fixes.size() == 2);
}

}  // namespace metric_positions_test

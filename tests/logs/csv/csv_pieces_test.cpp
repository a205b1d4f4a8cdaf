// Quantities that a table has in pieces. Values follow from plain trigonometry and from the radius of the Earth.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>

#include "logs/csv/csv_text.hpp"

namespace csv_pieces_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
using std::numbers::pi;
using waymark_test::csv_request;
using waymark_test::read_csv;

namespace {

/// A column that a request names for a quantity.
struct Named {
  std::string quantity;
  std::string column;
  std::string unit = {};
  std::string convention = {};
};

LogRequest named(StreamKind stream, const std::vector<Named>& columns) {
  LogRequest request = csv_request(stream);
  if (stream == StreamKind::odometry) request.readings = odometry_channels();
  for (const Named& one : columns) request.columns[one.quantity] = {one.column, one.unit, one.convention};
  return request;
}

/// The value of a channel in a row.
double channel(const LogData& data, std::size_t row, const std::string& name) {
  const auto& channels = odometry_channels();
  for (std::size_t c = 0; c < channels.size(); ++c)
    if (channels[c].name == name) return data.readings.at(row, c);
  FAIL("no channel " << name);
  return 0;
}

double heading_of(const LogRequest& request, const std::string& names, const std::string& values) {
  const LogData data = read_csv("time,latitude,longitude," + names + "\n1,48,11," + values + "\n", request);
  REQUIRE(data.truth.size() == 1);
  return data.truth[0].heading_rad.value_or(99);
}

}  // namespace

TEST_CASE("csv pieces: a velocity to the east and north is speed and course of a fix") {
  const LogRequest request =
      named(StreamKind::gnss, {{"velocity_east", "ve", "km/h"}, {"velocity_north", "vn", "km/h"}});
  const LogData data =
      read_csv("time,latitude,longitude,ve,vn\n1,48,11,-10.8,14.4\n2,48,11,0,0\n3,48,11,,1\n", request);
  REQUIRE(data.fixes.size() == 3);
  CHECK(data.fixes[0].speed_mps == Approx(5));                   // 3, 4, 5
  CHECK(data.fixes[0].course_rad == Approx(-std::atan2(3, 4)));  // clockwise from north
  CHECK(data.fixes[1].speed_mps == 0);
  CHECK_FALSE(data.fixes[1].course_rad);  // at rest there is no direction
  CHECK_FALSE(data.fixes[2].speed_mps);
}

TEST_CASE("csv pieces: a velocity is speed and course of an odometry, beside a column of its own") {
  const LogRequest request = named(StreamKind::odometry, {{"velocity_east", "ve"}, {"velocity_north", "vn"}});
  const LogData data = read_csv("time,ve,vn\n1,-3,4\n", request);
  CHECK(channel(data, 0, "speed") == Approx(5));
  CHECK(channel(data, 0, "course") == Approx(pi / 2 + std::atan2(3, 4)));  // counter-clockwise from east
  LogRequest both = request;
  both.columns["speed"] = {"v", "", ""};
  CHECK(channel(read_csv("time,ve,vn,v\n1,-3,4,-5\n", both), 0, "speed") == -5);
}

TEST_CASE("csv pieces: one component of a velocity is no speed where the table has both") {
  const LogRequest request = named(StreamKind::odometry, {{"speed", "VelEast (km/h)"}});
  CHECK_THROWS_MATCHES(
      read_csv("time,VelNorth (km/h),VelEast (km/h)\n1,2,3\n", request), InputError,
      Message(
          "log.csv:1:1: 'VelEast (km/h)' is a component of a velocity and no speed, and the table has the other "
          "one: state 'velocity_east: VelEast (km/h)' and 'velocity_north: VelNorth (km/h)' in place of 'speed' "
          "(and of 'course')"));
  for (const std::string pair : {"ve,vn", "v_n,v_e", "vel_east,vel_north", "north_vel,east_vel"}) {
    INFO(pair);
    LogRequest first = csv_request(StreamKind::gnss);
    first.columns["speed"] = {pair.substr(0, pair.find(',')), "", ""};
    CHECK_THROWS_AS(read_csv("time,latitude,longitude," + pair + "\n1,48,11,2,3\n", first), InputError);
  }
  // A name that only looks like one, and a component that is alone.
  LogRequest alone = csv_request(StreamKind::gnss);
  alone.columns["speed"] = {"vel_e", "", ""};
  CHECK(read_csv("time,latitude,longitude,vel_e\n1,48,11,2\n", alone).fixes.size() == 1);
}

TEST_CASE("csv pieces: a forward axis and a quaternion are headings") {
  const double heading = 2.5;
  const LogRequest axis = named(StreamKind::truth, {{"heading_east", "r11"}, {"heading_north", "r21"}});
  const auto text = [](double a, double b) { return std::to_string(a) + "," + std::to_string(b); };
  CHECK(heading_of(axis, "r11,r21", text(3 * std::cos(heading), 3 * std::sin(heading))) ==
        Approx(heading).margin(1e-6));
  CHECK(heading_of(axis, "r11,r21", "0,0") == 99);
  const LogRequest quaternion =
      named(StreamKind::truth,
            {{"quaternion_x", "qx"}, {"quaternion_y", "qy"}, {"quaternion_z", "qz"}, {"quaternion_w", "qw"}});
  const auto about_z = [&](double angle) { return "0,0," + text(std::sin(angle / 2), std::cos(angle / 2)); };
  CHECK(heading_of(quaternion, "qx,qy,qz,qw", about_z(heading)) == Approx(heading).margin(1e-5));
  CHECK(heading_of(quaternion, "qx,qy,qz,qw", about_z(heading + 2 * pi)) == Approx(heading).margin(1e-5));
  // A vehicle that rolls by half a turn about its x axis goes on east.
  CHECK(heading_of(quaternion, "qx,qy,qz,qw", "1,0,0,0") == Approx(0).margin(1e-12));
  LogRequest part = quaternion;
  part.columns.erase("quaternion_w");
  CHECK_THROWS_MATCHES(
      heading_of(part, "qx,qy,qz,qw", "0,0,0,1"), InputError,
      Message("log.csv: the heading has only a part of its columns: quaternion_x, quaternion_y, "
              "quaternion_z, quaternion_w belong together"));
}

TEST_CASE("csv pieces: steps from row to row add up to a distance and a heading") {
  const LogRequest request =
      named(StreamKind::odometry, {{"distance_step", "ds", "cm"}, {"heading_step", "turn", "deg", "cw"}});
  const LogData data = read_csv("time,ds,turn\n1,50,9\n2,100,18\n3,,\n4,100,-9\n", request);
  REQUIRE(data.readings.size() == 4);
  CHECK(channel(data, 1, "distance") - channel(data, 0, "distance") == Approx(1));
  CHECK(channel(data, 1, "heading") - channel(data, 0, "heading") == Approx(-pi / 10));
  CHECK(std::isnan(channel(data, 2, "distance")));
  CHECK(channel(data, 3, "heading") - channel(data, 1, "heading") == Approx(pi / 20));
}

TEST_CASE("csv pieces: Earth-centred coordinates are a position with its height") {
  const LogRequest request = named(StreamKind::gnss, {{"ecef_x", "x"}, {"ecef_y", "y"}, {"ecef_z", "z"}});
  // On the equator at 90 degrees east, 100 m above the ellipsoid; at the north pole; nothing; on the moon.
  const LogData data =
      read_csv("time,x,y,z\n1,0,6378237,0\n2,0,0,6356752.3142\n3,0,0,0\n4,3e8,0,0\n", request);
  REQUIRE(data.fixes.size() == 2);
  CHECK(data.fixes[0].latitude_deg == Approx(0).margin(1e-9));
  CHECK(data.fixes[0].longitude_deg == Approx(90));
  CHECK(data.fixes[0].height_m == Approx(100).margin(1e-6));
  CHECK(data.fixes[1].latitude_deg == Approx(90));
  CHECK(data.fixes[1].height_m == Approx(0).margin(1e-3));
  CHECK(data.without_fix == 1);
  CHECK(data.corrupt == 1);
  LogRequest two = request;
  two.columns["latitude"] = {"x", "", ""};
  CHECK_THROWS_AS(read_csv("time,x,y,z\n1,0,6378237,0\n", two), InputError);
}

TEST_CASE("csv pieces: the fraction of a second has a column of its own, exact to the nanosecond") {
  const LogRequest request =
      named(StreamKind::odometry, {{"time", "secs"}, {"time_fraction", "nsecs", "ns"}, {"speed", "v"}});
  const LogData data =
      read_csv("secs,nsecs,v\n1706702400,5,1\n1706702400,999999999,2\n1706702401,,3\n", request);
  REQUIRE(data.readings.size() == 2);
  CHECK(data.readings.stamps[0].nanoseconds == 1'706'702'400'000'000'005);
  CHECK(data.readings.stamps[1].nanoseconds == 1'706'702'400'999'999'999);
  CHECK(data.corrupt == 1);
}

}  // namespace csv_pieces_test

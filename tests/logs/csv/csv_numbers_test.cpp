// The numbers of a table: a scale beside or instead of a unit, and numbers that mean "no value".
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>

#include "logs/csv/csv_text.hpp"

namespace csv_numbers_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
using waymark_test::csv_request;
using waymark_test::read_csv;

namespace {

ColumnRequest scaled(const std::string& column, double scale, const std::string& unit = "",
                     const std::string& convention = "") {
  return {column, unit, convention, scale, std::nullopt};
}

ColumnRequest marked(const std::string& column, double missing) {
  return {column, "", "", 1, missing};
}

std::string error_of(const std::string& quantity, const ColumnRequest& column) {
  LogRequest fixes = csv_request(StreamKind::gnss);
  fixes.columns[quantity] = column;
  try {
    (void)read_csv("time,latitude,longitude,x\n1,50,15,2\n", fixes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("csv: the scaled number is in the unit, with the sense of the convention") {
  LogRequest odometry = csv_request(StreamKind::odometry);
  odometry.columns["speed"] = scaled("wheel", 0.3);  // rad/s of a wheel with a radius of 0.3 m
  odometry.columns["yaw_rate"] = scaled("gyro", 0.01, "deg/s", "cw");
  const LogData data = read_csv("time,wheel,gyro\n0,50,1000\n", odometry);
  CHECK(data.odometry.at(0).speed_mps == Approx(15).epsilon(1e-15));
  CHECK(data.odometry.at(0).yaw_rate_radps == Approx(-10 * std::numbers::pi / 180).epsilon(1e-15));
}

TEST_CASE("csv: a scale comes before the zero of a convention and before the root of a variance") {
  LogRequest fixes = csv_request(StreamKind::gnss);
  fixes.columns["course"] = scaled("c", 0.1, "deg", "ccw_from_east");
  fixes.columns["sigma_east"] = scaled("e", 1e-4, "m^2");  // cm^2
  fixes.columns["sigma_north"] = scaled("n", 0.01);
  const LogData data = read_csv("time,latitude,longitude,c,e,n\n0,50,15,300,90000,400\n", fixes);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].course_rad.value() == Approx(std::numbers::pi / 3));  // 60 degrees from north
  CHECK(data.fixes[0].covariance_en(0, 0) == Approx(9));
  CHECK(data.fixes[0].covariance_en(1, 1) == Approx(16));
}

TEST_CASE("csv: the range of a quantity is that of the scaled number") {
  LogRequest odometry = csv_request(StreamKind::odometry);
  odometry.columns["speed"] = scaled("rpm", 0.03);
  const LogData data = read_csv("time,rpm,yaw_rate\n0,1000,0\n1,9000,0\n", odometry);
  CHECK(data.odometry.at(0).speed_mps == Approx(30));
  CHECK(data.corrupt == 1);  // 270 m/s
}

TEST_CASE("csv: a scale alone gives the default unit, and a unit of the header needs a word") {
  LogRequest odometry = csv_request(StreamKind::odometry);
  odometry.columns["speed"] = scaled("v [rpm]", 0.03);
  CHECK(read_csv("time,v [rpm],yaw_rate\n0,100,0\n", odometry).odometry.at(0).speed_mps == Approx(3));
  CHECK(read_csv("time,v [rpm],yaw_rate\ns,rpm,rad/s\n0,100,0\n", odometry).odometry.at(0).speed_mps ==
        Approx(3));
  odometry.columns["speed"] = scaled("v [km/h]", 1.02);
  CHECK_THROWS_MATCHES(
      read_csv("time,v [km/h],yaw_rate\n0,36,0\n", odometry), InputError,
      Message("log.csv:1:1: speed has a scale, and the header has km/h: state the unit of the scaled "
              "number under columns, m/s or another"));
  odometry.columns["speed"].unit = "km/h";
  CHECK(read_csv("time,v [km/h],yaw_rate\n0,36,0\n", odometry).odometry.at(0).speed_mps == Approx(10.2));
}

TEST_CASE("csv: a scale of 0, none, and one of what has no size are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(error_of("speed", scaled("x", 0)) ==
        "log.csv: the scale of speed is 0; expected a number other than 0");
  CHECK(error_of("speed", scaled("x", nan)) ==
        "log.csv: the scale of speed is nan; expected a number other than 0");
  CHECK(error_of("speed", marked("x", nan)) == "log.csv: 'missing' of speed is nan; expected a number");
  for (const char* quantity : {"time", "date", "gnss_time", "quality", "valid", "latitude_hemisphere"}) {
    CHECK(error_of(quantity, scaled("x", 2)) ==
          "log.csv: " + std::string(quantity) +
              " is no number that a scale could multiply; leave out 'scale'");
    CHECK(error_of(quantity, marked("x", -1)) ==
          "log.csv: " + std::string(quantity) +
              " is no number of which one could mean no value; leave out 'missing'");
  }
  CHECK(error_of("latitude", scaled("x", 2, "ddmm")) ==
        "log.csv: latitude in ddmm is no number that a scale could multiply; leave out 'scale'");
}

TEST_CASE("csv: a number that is stated to mean no value is none, whatever its unit and scale") {
  LogRequest parts = csv_request(StreamKind::odometry);
  parts.readings = {{"speed", "m/s", "", false, ""}, {"gyro_z", "rad/s", "ccw", false, ""}};
  parts.columns["speed"] = {"v", "km/h", "", 10, -1.0};
  parts.columns["gyro_z"] = marked("w", 655.35);
  const LogData data = read_csv("time,v,w\n0,-1,0.5\n1,-1.0,655.35\n2,3.6,0\n3,-10,1\n", parts);
  REQUIRE(data.readings.size() == 4);
  CHECK(std::isnan(data.readings.at(0, 0)));
  CHECK(data.readings.at(0, 1) == 0.5);
  CHECK(std::isnan(data.readings.at(1, 0)));
  CHECK(std::isnan(data.readings.at(1, 1)));
  CHECK(data.readings.at(2, 0) == Approx(10));
  CHECK(data.readings.at(3, 0) == Approx(-100 / 3.6));
  LogRequest fixes = csv_request(StreamKind::gnss);
  fixes.columns["latitude"] = marked("latitude", 0);
  fixes.columns["longitude"] = marked("longitude", 0);
  const LogData places = read_csv("time,latitude,longitude\n0,0,0\n1,50,15\n", fixes);
  CHECK(places.fixes.size() == 1);
  CHECK(places.without_fix == 1);
}

TEST_CASE("csv: an accuracy that is stated comes before sigmas that only have default names") {
  const std::string table = "time,latitude,longitude,sigma_east,sigma_north,h\n0,50,15,7,7,2\n";
  LogRequest fixes = csv_request(StreamKind::gnss);
  CHECK(read_csv(table, fixes).fixes.at(0).covariance_en(0, 0) == Approx(49));
  fixes.columns["accuracy"].column = "h";
  CHECK(read_csv(table, fixes).fixes.at(0).covariance_en(0, 0) == Approx(2));  // drms: h / sqrt 2
  fixes.columns.clear();
  fixes.columns["sigma_north"].column = "h";  // the other axis keeps its default column
  const LogData sigmas = read_csv(table, fixes);
  CHECK(sigmas.fixes.at(0).covariance_en(0, 0) == Approx(49));
  CHECK(sigmas.fixes.at(0).covariance_en(1, 1) == Approx(4));
}

}  // namespace csv_numbers_test

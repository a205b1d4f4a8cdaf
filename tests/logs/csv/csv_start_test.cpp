// Tables below lines that are none of theirs, and logs of several kinds of rows.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include <waymark/formats/logs/channels.hpp>

#include "logs/csv/csv_text.hpp"
#include "logs/log_pieces.hpp"

namespace csv_start_test {

using namespace waymark;
using namespace waymark::formats;
using waymark_test::csv_request;
using waymark_test::read_csv;

namespace {

const std::string kRows = "time,speed,yaw_rate\n1,5,0.1\n2,6,0.2\n3,7,0.3\n";

std::vector<double> speeds_of(const LogData& data) {
  std::vector<double> speeds;
  for (const OdometrySample& sample : data.odometry) speeds.push_back(sample.speed_mps);
  return speeds;
}

std::vector<double> speeds_in(const std::string& text) {
  return speeds_of(read_csv(text, csv_request(StreamKind::odometry)));
}

const std::vector<double> kSpeeds{5, 6, 7};

}  // namespace

TEST_CASE("csv start: titles and settings above the table are left out and counted") {
  const std::string above =
      "This file is created by a logger ( http://example.org/ ).\nFormat,3\nDriver,\n\n";
  const LogData data = read_csv(above + kRows, csv_request(StreamKind::odometry));
  CHECK(speeds_of(data) == kSpeeds);
  CHECK(data.corrupt == 0);
  CHECK(data.records == 3);
  CHECK(data.notes.front() == "log.csv: the table begins in line 5: 3 lines above it are left out");
  CHECK(CsvLogReader().recognise(above + kRows).certainty == 0.5);
}

TEST_CASE("csv start: rows of units and of sources between names and values are no rows") {
  const LogData data = read_csv(
      "Session,Town\nLaps,3\ntime,speed,yaw_rate\nunix time,km/h,deg/s\n,100: gps,102: gyro\n1,18,9\n2,36,9\n",
      csv_request(StreamKind::odometry));
  REQUIRE(speeds_of(data) == std::vector<double>{5, 10});
  CHECK(data.odometry[0].yaw_rate_radps == Approx(0.15708).epsilon(1e-5));
  CHECK(data.corrupt == 0);
}

TEST_CASE("csv start: names that several columns have are left alone where nothing needs them") {
  const LogData data = read_csv("time,latitude,longitude,speed,speed\n1,48,11,5,6\n2,48,11,5,6\n",
                                csv_request(StreamKind::gnss));
  REQUIRE(data.fixes.size() == 2);
  CHECK_FALSE(data.fixes[0].speed_mps);
  CHECK(data.notes.at(1) ==
        "log.csv:1:1: the header has 'speed' several times: none is read unless its number is named");
}

TEST_CASE("csv start: the separator that a first line states is used") {
  CHECK(speeds_in("sep=;\ntime;speed;yaw_rate\n1;5;0,1\n2;6;0,2\n3;7;0,3\n") == kSpeeds);
  CHECK(speeds_in("\"sep=|\"\ntime|speed|yaw_rate\n1|5|0.1\n2|6|0.2\n3|7|0.3\n") == kSpeeds);
}

TEST_CASE("csv start: a first row that is damaged does not cost the header") {
  CHECK(speeds_in("time,speed,yaw_rate\n1,5\n1,5,0.1\n2,6,0.2\n3,7,0.3\n") == kSpeeds);
  CHECK(speeds_in("time,speed,yaw_rate\n1,5,0.1\n2,6\n2,6,0.2\n3,7,0.3\n") == kSpeeds);
}

TEST_CASE("csv start: short tables, and tables in pieces of any size, are read as whole ones") {
  CHECK(speeds_in("time,speed,yaw_rate\n1,5,0.1\n") == std::vector<double>{5});
  const std::string text = "Title\nA,B\n" + kRows;
  const LogData whole = read_csv(text, csv_request(StreamKind::odometry));
  for (const std::size_t length : {1U, 7U, 40U}) {
    const LogData pieces = waymark_test::read_in_pieces_of(length, CsvLogReader(), text, "log.csv",
                                                           csv_request(StreamKind::odometry));
    CHECK(speeds_of(pieces) == speeds_of(whole));
    CHECK(pieces.notes == whole.notes);
  }
}

TEST_CASE("csv start: 'where' reads one of several kinds of rows that differ in width") {
  const std::string log =
      "FMT, 128, 89, FMT, Type,Length,Name\nFMT, 129, 51, GPS, QB, TimeUS,I\n"
      "GPS, 1000000, 48.1, 11.5, 3\nTHR, 1000000, 5.5\nGPS, 2000000, 48.2, 11.6, 3\nGPS, 3000000, 48.3\nTHR, 2000000, 6.5\n";
  LogRequest fixes = csv_request(StreamKind::gnss);
  fixes.where = RowFilter{"1", "GPS", true};
  fixes.columns = {{"time", {"2", "us", ""}}, {"latitude", {"3", "", ""}}, {"longitude", {"4", "", ""}}};
  const LogData gps = read_csv(log, fixes);
  REQUIRE(gps.fixes.size() == 2);
  CHECK(gps.fixes[1].latitude_deg == 48.2);
  CHECK(gps.corrupt == 1);  // the cut one
  LogRequest motion = csv_request(StreamKind::odometry);
  motion.readings = odometry_channels();
  motion.where = RowFilter{"1", "THR", true};
  motion.columns = {{"time", {"2", "us", ""}}, {"speed", {"3", "", ""}}};
  const LogData throttle = read_csv(log, motion);
  REQUIRE(throttle.readings.size() == 2);
  CHECK(throttle.readings.at(1, 0) == 6.5);
}

TEST_CASE("csv start: the units of a header count where columns and kinds of rows are given by number") {
  LogRequest motion = csv_request(StreamKind::odometry);
  motion.readings = odometry_channels();
  motion.where = RowFilter{"1", "ODO", true};
  motion.columns = {{"time", {"2", "", ""}}, {"speed", {"3", "", ""}}};
  const LogData read =
      read_csv("kind,time [ms],speed [km/h]\nODO,1000,36\nFIX,1500,1\nODO,2000,72\n", motion);
  REQUIRE(read.readings.size() == 2);
  CHECK(read.readings.at(1, 0) == 20);
  CHECK(seconds_between(read.readings.stamps[0], read.readings.stamps[1]) == Approx(1));
}

}  // namespace csv_start_test

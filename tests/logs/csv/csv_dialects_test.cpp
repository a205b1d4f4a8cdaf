// Tables of many programs: forms of times, of angles and of units. One instant, 2024-01-31T12:00:00Z, is
// 1706702400 s in POSIX time by `date -u +%s`; as GPS time it is 1390737618 s.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

#include "logs/csv/csv_text.hpp"
#include "logs/log_pieces.hpp"

namespace csv_dialects_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
using waymark_test::read_csv;

namespace {

constexpr std::int64_t kNoon = 1'706'702'400'000'000'000;
constexpr std::int64_t kNoonGps = 1'390'737'618'000'000'000;

LogRequest truth(TimeScale scale = TimeScale::utc) {
  LogRequest request;
  request.stream = StreamKind::truth;
  request.time_scale = scale;
  return request;
}

LogRequest odometry() {
  LogRequest request;
  request.stream = StreamKind::odometry;
  return request;
}

/// The stamp of a row with this text in the column `t`, in nanoseconds.
std::int64_t stamp_of(const std::string& field, const std::string& unit, TimeScale scale = TimeScale::utc) {
  LogRequest request = truth(scale);
  request.columns["time"] = {"t", unit, ""};
  return read_csv(fmt::format("t;latitude;longitude\n{};48;11\n", field), request)
      .truth.at(0)
      .stamp.nanoseconds;
}

double latitude_of(const std::string& field, const std::string& unit) {
  LogRequest request = truth();
  request.columns["latitude"] = {"lat", unit, ""};
  const LogData data = read_csv(fmt::format("time;lat;longitude\n1;{};11\n", field), request);
  REQUIRE(data.truth.size() == 1);
  return data.truth[0].latitude_deg;
}

}  // namespace

TEST_CASE("csv dialects: an instant in every form of time") {
  CHECK(stamp_of("2024-01-31T12:00:00Z", "iso8601") == kNoon);
  CHECK(stamp_of("2024/1/31 12:00", "iso8601") == kNoon);
  CHECK(stamp_of("20240131T120000.5", "iso8601") == kNoon + 500'000'000);
  CHECK(stamp_of("31.01.2024 12:00:00", "dmy") == kNoon);
  CHECK(stamp_of("31/1/24 12:00:00,25", "dmy") == kNoon + 250'000'000);
  CHECK(stamp_of("31-Jan-2024 12:00:00", "dmy") == kNoon);
  CHECK(stamp_of("1/31/2024 12:00:00 PM", "mdy") == kNoon);
  CHECK(stamp_of("Jan 31, 2024 1:00 pm +01:00", "mdy") == kNoon);
  CHECK(stamp_of("45322.5", "excel") == kNoon);
  CHECK(stamp_of("45322,5", "excel") == kNoon);
  CHECK(stamp_of("739282.5", "matlab") == kNoon);
  CHECK(stamp_of("133511760000000000", "filetime") == kNoon);
  CHECK(stamp_of("1706702400000", "ms") == kNoon);
  // A date names UTC; the samples are on the scale of the log.
  CHECK(stamp_of("31.01.2024 12:00:00", "dmy", TimeScale::gps) == kNoonGps);
  CHECK(stamp_of("45322.5", "excel", TimeScale::gps) == kNoonGps);
  CHECK(stamp_of("1390737618", "s", TimeScale::gps) == kNoonGps);  // GPS seconds since 1980: no leap seconds
}

TEST_CASE("csv dialects: days of a spreadsheet are right to 13 decimals, 9 ns") {
  // 1 ms is 1.1574074074e-8 of a day
  CHECK(std::abs(stamp_of("45322.50000001157407", "excel") - (kNoon + 1'000'000)) <= 5);
}

TEST_CASE("csv dialects: a date that is none is a corrupt row, in its own words") {
  LogRequest request = truth();
  request.columns["time"] = {"t", "dmy", ""};
  const LogData data = read_csv(
      "t,latitude,longitude\n31.1.2024 12:00,48,11\n31.2.2024 12:00,48,11\n12.31.2024 1:00,48,11\n"
      "31.1.2024 25:00,48,11\n31.1.2024,48,11\n",
      request);
  CHECK(data.truth.size() == 1);
  CHECK(data.corrupt_examples.at(0) ==
        "log.csv:3:1: time: expected a date such as 31.1.2024, got '31.2.2024 12:00'");
  CHECK(data.corrupt == 4);
}

TEST_CASE("csv dialects: instants that 64 bits of nanoseconds do not hold are corrupt rows") {
  // The years 1678 to 2262; the rows in between are those of kNoon.
  for (const auto& [unit, fields] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"excel", {"457462944", "132500", "45322.5"}},
           {"matlab", {"1", "9999999", "739282.5"}},
           {"filetime", {"1", "300000000000000000", "133511760000000000"}}}) {
    INFO(unit);
    LogRequest request = truth();
    request.columns["time"] = {"t", unit, ""};
    std::string text = "t,latitude,longitude\n";
    for (const std::string& field : fields) text += field + ",48,11\n";
    const LogData data = read_csv(text, request);
    CHECK(data.corrupt == 2);
    REQUIRE(data.truth.size() == 1);
    CHECK(data.truth[0].stamp.nanoseconds == kNoon);
  }
}

TEST_CASE("csv dialects: date and time of day stand in two columns") {
  LogRequest request = truth();
  request.columns["date"] = {"day", "dmy", ""};
  request.columns["time"] = {"clock", "hms", ""};
  CHECK(read_csv("day,clock,latitude,longitude\n31.1.2024,12:00:00,48,11\n", request)
            .truth.at(0)
            .stamp.nanoseconds == kNoon);
  CHECK(read_csv("day,clock,latitude,longitude\n310124,120000.00,48,11\n", request)
            .truth.at(0)
            .stamp.nanoseconds == kNoon);
  request.columns["time"] = {"clock", "s", ""};
  CHECK(read_csv("day,clock,latitude,longitude\n31.1.2024,43200,48,11\n", request)
            .truth.at(0)
            .stamp.nanoseconds == kNoon);
  request.columns["date"] = {"day", "gps_week", ""};
  // 1390737618 s are 2299 weeks and 302418 s
  CHECK(
      read_csv("day,clock,latitude,longitude\n2299,302418,48,11\n", request).truth.at(0).stamp.nanoseconds ==
      kNoon);
  const LogData wrong =
      read_csv("day,clock,latitude,longitude\n2299,302418,48,11\n2299,700000,48,11\n", request);
  CHECK(wrong.corrupt_examples.at(0) ==
        "log.csv:3:6: time: '700000' is no time of the day or week that the date begins");
}

TEST_CASE("csv dialects: a time of day alone goes on over midnight, from the date that is stated") {
  LogRequest request = truth();
  request.columns["time"] = {"t", "hms", ""};
  CHECK_THROWS_MATCHES(
      read_csv("t,latitude,longitude\n23:59:59,48,11\n", request), InputError,
      Message("log.csv: time is a time of day: name the column of the date under columns, or "
              "state that of the first row, 'time: {date: 2024-01-31}'"));
  request.date = Stamp{kNoon - 43'200'000'000'000};
  const LogData data =
      read_csv("t,latitude,longitude\n23:59:59,48,11\n00:00:01,48,11\n00:00:02,48,11\n", request);
  REQUIRE(data.truth.size() == 3);
  CHECK(data.truth[0].stamp.nanoseconds == kNoon + 43'199'000'000'000);
  CHECK(data.truth[1].stamp.nanoseconds == kNoon + 43'201'000'000'000);
  CHECK(data.truth[2].stamp.nanoseconds == kNoon + 43'202'000'000'000);
}

TEST_CASE("csv dialects: a latitude in degrees and minutes, with letters and signs") {
  const double given = 48 + 7.038 / 60;
  CHECK(latitude_of("4807.038", "ddmm") == Approx(given).epsilon(1e-14));
  CHECK(latitude_of("4807.038S", "ddmm") == Approx(-given).epsilon(1e-14));
  CHECK(latitude_of("48°07.038'N", "dms") == Approx(given).epsilon(1e-14));
  CHECK(latitude_of("48 7 2.28 S", "dms") == Approx(-given).epsilon(1e-14));
  CHECK(latitude_of("-48:07:02.28", "dms") == Approx(-given).epsilon(1e-14));
  CHECK(latitude_of("N48.1173", "deg") == 48.1173);
  CHECK(latitude_of("48.1173°", "deg") == 48.1173);
}

TEST_CASE("csv dialects: minutes of 60 and a sign beside a letter are no angle") {
  LogRequest request = truth();
  request.columns["latitude"] = {"lat", "ddmm", ""};
  const LogData data =
      read_csv("time,lat,longitude\n1,4807.038,11\n2,4860.0,11\n3,-4807.0S,11\n4,4807.0X,11\n", request);
  CHECK(data.truth.size() == 1);
  CHECK(data.corrupt == 3);
}

TEST_CASE("csv dialects: the hemisphere has a column of its own") {
  LogRequest request = truth();
  request.columns = {{"latitude", {"lat", "ddmm", ""}},
                     {"longitude", {"lon", "ddmm", ""}},
                     {"latitude_hemisphere", {"ns", "", ""}},
                     {"longitude_hemisphere", {"ew", "", ""}}};
  const LogData data = read_csv(
      "time,lat,ns,lon,ew\n1,4807.038,N,01131.000,W\n2,4807.038,S,01131.000,E\n3,4807,Q,1131,E\n", request);
  REQUIRE(data.truth.size() == 2);
  CHECK(data.truth[0].longitude_deg == Approx(-(11 + 31.0 / 60)));
  CHECK(data.truth[1].latitude_deg == Approx(-(48 + 7.038 / 60)));
  CHECK(data.corrupt_examples.at(0) == "log.csv:4:8: latitude_hemisphere: expected N, S, E or W, got 'Q'");
}

TEST_CASE("csv dialects: units in brackets and in a row of their own are obeyed") {
  const LogData brackets = read_csv("Time (ms);Speed [km/h];Yaw_rate (°/s)\n1500;36;90\n", odometry());
  REQUIRE(brackets.odometry.size() == 1);
  CHECK(brackets.odometry[0].stamp.nanoseconds == 1'500'000'000);
  CHECK(brackets.odometry[0].speed_mps == Approx(10));
  CHECK(brackets.odometry[0].yaw_rate_radps == Approx(std::numbers::pi / 2));
  const LogData row = read_csv("time,speed,yaw_rate\nms,kph,deg/s\n1500,36,90\n", odometry());
  REQUIRE(row.odometry.size() == 1);
  CHECK(row.records == 1);
  CHECK(row.odometry[0].speed_mps == Approx(10));
  CHECK(row.notes.at(1) == "log.csv:1:1: time is in ms by the header");
}

TEST_CASE("csv dialects: a stated unit wins over the header's, and a strange one is asked for") {
  LogRequest request = odometry();
  request.columns["speed"] = {"speed", "m/s", ""};
  const LogData data = read_csv("time,speed,yaw_rate\ns,km/h,rad/s\n1,10,0\n", request);
  CHECK(data.odometry.at(0).speed_mps == 10);
  CHECK(data.notes.at(1) == "log.csv:1:1: speed is read in m/s, though the header has km/h");
  CHECK_THROWS_MATCHES(
      read_csv("time,speed,yaw_rate\ns,furlong/h,rad/s\n1,10,0\n", odometry()), InputError,
      Message("log.csv:1:1: the row of units has 'furlong/h' for speed; state its unit under "
              "columns: m/s, km/h, mph, kn, mm/s"));
}

TEST_CASE("csv dialects: names of rostopic, its variances and its status") {
  LogRequest request;
  request.time_scale = TimeScale::unix_time;
  request.columns = {{"time", {"%time", "ns", ""}},
                     {"sigma_east", {"field.position_covariance0", "m^2", ""}},
                     {"sigma_north", {"field.position_covariance4", "m^2", ""}},
                     {"covariance_en_signed_root", {"field.position_covariance1", "m^2", ""}},
                     {"quality", {"field.status.status", "ros", ""}}};
  const LogData data = read_csv(
      "%time,field.status.status,field.latitude,field.longitude,field.position_covariance0,"
      "field.position_covariance1,field.position_covariance4\n"
      "1706702400000000000,2,48,11,4,-1,9\n",
      request);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].stamp.nanoseconds == kNoon);
  CHECK(data.fixes[0].covariance_en(0, 0) == Approx(4));
  CHECK(data.fixes[0].covariance_en(0, 1) == Approx(-1));
  CHECK(data.fixes[0].covariance_en(1, 1) == Approx(9));
  CHECK(data.fixes[0].told.quality == FixQuality::differential);
}

TEST_CASE("csv dialects: names that differ only in letters or units are told apart by the user") {
  CHECK_THROWS_MATCHES(read_csv("time,Speed (m/s),SPEED [km/h],yaw_rate\n1,1,3.6,0\n", odometry()),
                       InputError,
                       Message("log.csv:1:1: 'Speed (m/s)' and 'SPEED [km/h]' may both be speed; name the "
                               "column under columns"));
}

TEST_CASE("csv dialects: metres on the plane of an origin are places, with its axes") {
  LogRequest request;
  request.local_origin = LocalOrigin{60, 11, 500};
  const LogData data = read_csv(
      "time,easting,northing,sigma_east,sigma_north\n1,100,0,1,3\n2,0,100,1,3\n3,50000,0,1,3\n", request);
  REQUIRE(data.fixes.size() == 3);
  // Radii of curvature of WGS84 at 60 degrees, at a height of 500 m.
  const double a = 6378137;
  const double e2 = 0.00669437999014;
  const double s2 = 0.75;  // sin^2 60
  const double across = a / std::sqrt(1 - e2 * s2) + 500;
  const double along = a * (1 - e2) / std::pow(1 - e2 * s2, 1.5) + 500;
  const double degree = std::numbers::pi / 180;
  CHECK((data.fixes[0].longitude_deg - 11) * degree == Approx(100 / (across * 0.5)).epsilon(1e-6));
  CHECK((data.fixes[1].latitude_deg - 60) * degree == Approx(100 / along).epsilon(1e-4));
  // At 50 km east the plane's north points east of true north by the convergence, east/R tan(latitude).
  const double g = 50000 / across * std::tan(60 * degree);
  CHECK(data.fixes[2].covariance_en(0, 1) == Approx((9 - 1) * std::sin(g) * std::cos(g)).epsilon(0.01));
}

TEST_CASE("csv dialects: pieces of any length give the same") {
  LogRequest request = truth();
  request.columns["time"] = {"t", "dmy", ""};
  const LogData data = waymark_test::check_pieces(
      CsvLogReader(),
      "t;Latitude (°);Longitude (°)\n-;deg;deg\n31.1.2024 12:00;48,5;11\n31.1.2024 12:01;48;11", "log.csv",
      request);
  CHECK(data.truth.size() == 2);
}

}  // namespace csv_dialects_test

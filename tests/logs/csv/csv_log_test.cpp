#include <catch2/catch.hpp>

#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "logs/csv/csv_text.hpp"
#include "logs/log_pieces.hpp"

namespace csv_log_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
using std::numbers::pi;
using waymark_test::read_csv;

namespace {

LogRequest odometry() {
  LogRequest request;
  request.stream = StreamKind::odometry;
  return request;
}

LogRequest gnss(double default_sigma_m = 3) {
  LogRequest request;
  request.stream = StreamKind::gnss;
  request.default_sigma_m = default_sigma_m;
  return request;
}

constexpr const char* kTwo = "time,speed,yaw_rate\n1.5,10,0.25\n1.54,-2,0\n";

}  // namespace

TEST_CASE("csv: a plain odometry table with default column names") {
  const LogData data = read_csv(kTwo, odometry());
  REQUIRE(data.odometry.size() == 2);
  CHECK(data.odometry[0].stamp.nanoseconds == 1'500'000'000);
  CHECK(data.odometry[0].speed_mps == 10);
  CHECK(data.odometry[0].yaw_rate_radps == 0.25);
  CHECK(data.odometry[1].speed_mps == -2);  // reversing is no error
  CHECK(data.records == 2);
  CHECK(data.corrupt == 0);
  CHECK(data.notes ==
        std::vector<std::string>{"log.csv:1:1: columns by their default names: time, speed, yaw_rate"});
}

TEST_CASE("csv: byte order mark, CRLF, comments, blank lines, blanks and quotes change nothing") {
  const std::string text =
      "\xEF\xBB\xBF# a comment\r\n\r\n\"time\" , speed,\"yaw_rate\"\r\n  # another, one\r\n1.5, 10 "
      ",\"0.25\"\r\n\r\n1.54,-2,+0\r\n";
  const LogData data = read_csv(text, odometry());
  REQUIRE(data.odometry.size() == 2);
  CHECK(data.odometry[0].yaw_rate_radps == 0.25);
  CHECK(data.odometry[1].stamp.nanoseconds == 1'540'000'000);
  CHECK(data.corrupt == 0);
}

TEST_CASE("csv: separators") {
  LogRequest request = odometry();
  const auto [separator, text] =
      GENERATE(table<char, std::string>({{';', "time;speed;yaw_rate\n1;2;3\n"},
                                         {'\t', "time\tspeed\tyaw_rate\n1\t2\t3\n"},
                                         {' ', "  time speed \t yaw_rate\n 1   2\t3 \n"}}));
  request.separator = separator;
  const LogData data = read_csv(text, request);
  REQUIRE(data.odometry.size() == 1);
  CHECK(data.odometry[0].yaw_rate_radps == 3);
}

TEST_CASE("csv: an empty field between tabs is a missing value, not a missing column") {
  LogRequest request = odometry();
  request.separator = '\t';
  const LogData data = read_csv("time\tspeed\tyaw_rate\n1\t\t3\n2\t2\t3\n", request);
  REQUIRE(data.odometry.size() == 1);
  REQUIRE(data.corrupt_examples.size() == 1);
  CHECK(data.corrupt_examples[0] == "log.csv:2:3: speed: no value");
}

TEST_CASE("csv: columns by number need no header") {
  LogRequest request = odometry();
  request.columns = {{"time", {"1", "", ""}}, {"speed", {"3", "", ""}}, {"yaw_rate", {"2", "", ""}}};
  SECTION("without a header") {
    const LogData data = read_csv("1,2,3\n4,5,6\n", request);
    REQUIRE(data.odometry.size() == 2);
    CHECK(data.odometry[0].speed_mps == 3);
  }
  SECTION("with one") {
    const LogData data = read_csv("t,w,v\n4,5,6\n", request);
    REQUIRE(data.odometry.size() == 1);
    CHECK(data.odometry[0].speed_mps == 6);
  }
  SECTION("a garbled first line is corrupt, not a header") {
    const LogData data = read_csv("1,x,3\n4,5,6\n", request);
    CHECK(data.odometry.size() == 1);
    CHECK(data.corrupt_examples ==
          std::vector<std::string>{"log.csv:1:3: yaw_rate: expected a number, got 'x'"});
  }
  SECTION("beyond the last column") {
    request.columns["speed"] = {"4", "", ""};
    CHECK_THROWS_MATCHES(read_csv("1,2,3\n", request), InputError,
                         Message("log.csv:1:1: no column 4 for speed: the table has columns 1 to 3"));
  }
}

TEST_CASE("csv: names from the comment above the numbers, as numpy writes them") {
  const LogData data = read_csv("# a title\n# time,speed,yaw_rate\n1,2,3\n", odometry());
  REQUIRE(data.odometry.size() == 1);
  CHECK(data.notes.front() == "log.csv: column names were taken from the comment above line 3");
}

TEST_CASE("csv: times are exact to the nanosecond in every unit") {
  // 1627274470.528101 has no double within 1e-7 s: 1627274470.528100967...
  LogRequest request = odometry();
  const auto [unit, text] = GENERATE(table<std::string, std::string>({{"s", "1627274470.528101"},
                                                                      {"ms", "1627274470528.101"},
                                                                      {"us", "1627274470528101"},
                                                                      {"ns", "1627274470528101000"}}));
  request.columns["time"] = {"time", unit, ""};
  std::string table = "time,speed,yaw_rate\n";
  table.append(text).append(",0,0\n");
  const LogData data = read_csv(table, request);
  CHECK(data.odometry.at(0).stamp.nanoseconds == 1'627'274'470'528'101'000);
}

TEST_CASE("csv: ISO 8601 dates are UTC and come out on the scale asked for") {
  LogRequest request = odometry();
  request.columns["time"] = {"time", "iso8601", ""};
  const char* text = "time,speed,yaw_rate\n2017-01-01T00:00:00.25Z,0,0\n2017-01-01 01:00:00+01:00,0,0\n";
  request.time_scale = TimeScale::utc;
  LogData data = read_csv(text, request);
  CHECK(data.odometry.at(0).stamp.nanoseconds == 1'483'228'800'250'000'000);
  CHECK(data.odometry.at(1).stamp.nanoseconds == 1'483'228'800'000'000'000);
  request.time_scale =
      TimeScale::gps;  // GPS - UTC = 18 s from this very day; GPS week 1930 began at midnight, UTC+17
  data = read_csv(text, request);
  CHECK(data.odometry.at(0).stamp.nanoseconds == 1'167'264'018'250'000'000);
}

TEST_CASE("csv: week and offset are added, no second of a week lies past it") {
  LogRequest request = odometry();
  request.gps_week = 1900;
  request.time_offset_s = -0.4;
  const LogData data = read_csv("time,speed,yaw_rate\n126642.02,0,0\n1e7,0,0\n", request);
  REQUIRE(data.odometry.size() == 1);
  CHECK(data.odometry[0].stamp.nanoseconds == (1900LL * 604800 + 126641) * 1'000'000'000 + 620'000'000);
  CHECK(data.corrupt_examples == std::vector<std::string>{"log.csv:3:1: time: '1e7' is no second of a week"});
}

TEST_CASE("csv: units and senses") {
  LogRequest request = odometry();
  request.columns["speed"] = {"speed", "km/h", ""};
  request.columns["yaw_rate"] = {"yaw_rate", "deg/s", "cw"};
  CHECK(read_csv(kTwo, request).odometry.at(0).speed_mps == Approx(10 / 3.6).epsilon(1e-15));
  CHECK(read_csv(kTwo, request).odometry.at(0).yaw_rate_radps == Approx(-0.25 * pi / 180).epsilon(1e-15));

  LogRequest truth;
  truth.stream = StreamKind::truth;
  truth.columns["heading"] = {"h", "deg", "cw_from_north"};
  const LogData north = read_csv("time,latitude,longitude,h\n1,50,8,0\n2,50,8,90\n3,50,8,\n", truth);
  REQUIRE(north.truth.size() == 3);
  CHECK(*north.truth[0].heading_rad == Approx(pi / 2));
  CHECK(*north.truth[1].heading_rad == Approx(0).margin(1e-15));
  CHECK(!north.truth[2].heading_rad);

  LogRequest course = gnss();
  course.columns["course"] = {"c", "rad", "ccw_from_east"};
  course.columns["latitude"] = {"latitude", "1e-7deg", ""};
  const LogData data = read_csv("time,latitude,longitude,c\n1,500000000,8,0\n", course);
  CHECK(data.fixes.at(0).latitude_deg == Approx(50));
  CHECK(*data.fixes[0].course_rad == Approx(pi / 2));  // east is a course of 90 degrees
}

TEST_CASE("csv: corrupt lines are counted, the first five described, the run goes on") {
  std::string text = "time,speed,yaw_rate\n1,2\n2,x,0\n3,2,nan\n,2,0\n5,1e9,0\n6,2,0,7\n7,\"2,0\n8,2,0\n";
  const LogData data = read_csv(text, odometry());
  CHECK(data.odometry.size() == 1);
  CHECK(data.records == 8);
  CHECK(data.corrupt == 7);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.csv:2:4: expected 3 fields, got 2",
                                 "log.csv:3:3: speed: expected a number, got 'x'",
                                 "log.csv:4:5: yaw_rate: no value", "log.csv:5:1: time: no value",
                                 "log.csv:6:3: speed: '1e9' m/s is outside -150 .. 150"});
}

TEST_CASE("csv: a trailing separator on every data line is no extra field") {
  CHECK(read_csv("time,speed,yaw_rate\n1,2,3,\n", odometry()).odometry.size() == 1);
}

TEST_CASE("csv: a latitude beyond the pole is corrupt") {
  const LogData data = read_csv("time,latitude,longitude\n1,90.5,8\n2,50,8\n", gnss());
  CHECK(data.fixes.size() == 1);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.csv:2:3: latitude: '90.5' deg is outside -90 .. 90"});
}

TEST_CASE("csv: accuracy figures become covariances") {
  LogRequest request = gnss(0);
  const char* radial = "time,latitude,longitude,accuracy\n1,50,8,2\n";
  const auto variance = [&](AccuracyMeaning meaning) {
    request.accuracy = meaning;
    const LogData data = read_csv(radial, request);
    CHECK(data.fixes.at(0).covariance_en(0, 1) == 0);
    CHECK(data.fixes.at(0).covariance_en(0, 0) == data.fixes.at(0).covariance_en(1, 1));
    return data.fixes.at(0).covariance_en(0, 0);
  };
  CHECK(variance(AccuracyMeaning::percent95) == Approx(1));  // (2/2)^2, the paper's rule
  CHECK(variance(AccuracyMeaning::one_sigma) == Approx(4));
  CHECK(variance(AccuracyMeaning::drms) == Approx(2));                    // 2^2 / 2
  CHECK(variance(AccuracyMeaning::cep50) == Approx(2.8853900817779268));  // 4 / (2 ln 2)
  CHECK(variance(AccuracyMeaning::automatic) == Approx(2));               // one radius: drms, and said so
  CHECK(read_csv(radial, request).notes.back() == "log.csv: accuracy is taken as drms (not stated)");

  const LogData axes =
      read_csv("time,latitude,longitude,accuracy_east,accuracy_north\n1,50,8,2,6\n", request);
  CHECK(axes.fixes.at(0).covariance_en(0, 0) == Approx(1));  // automatic for two axes: 95 %
  CHECK(axes.fixes.at(0).covariance_en(1, 1) == Approx(9));
}

TEST_CASE("csv: RTKLIB's signed root covariance") {
  LogRequest request = gnss(0);
  const LogData data = read_csv(
      "time,latitude,longitude,sigma_east,sigma_north,covariance_en_signed_root\n"
      "1,50,8,2,3,-1.5\n2,50,8,2,3,2.5\n",
      request);
  REQUIRE(data.fixes.size() == 1);
  Eigen::Matrix2d expected;
  expected << 4, -2.25, -2.25, 9;
  CHECK(data.fixes[0].covariance_en == expected);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            "log.csv:3:12: covariance_en_signed_root: the covariance is not positive definite"});
}

TEST_CASE("csv: numbers may have decimal commas where the separator is another") {
  const LogData data =
      read_csv("time;latitude;longitude;accuracy\n10,25;50,5;8,125;2,0\n11,25;50,6;8,126;2,0\n", gnss(0));
  REQUIRE(data.fixes.size() == 2);
  CHECK(data.fixes[0].stamp.nanoseconds == 10'250'000'000);
  CHECK(data.fixes[0].latitude_deg == 50.5);
  CHECK(data.fixes[1].longitude_deg == 8.126);
  CHECK(data.corrupt == 0);
  // With commas as separators nobody can tell a decimal comma from one between thousands.
  CHECK_THROWS_AS(read_csv("time,latitude,longitude,accuracy\n10,\"50,5\",\"8,1\",2\n", gnss(0)), InputError);
}

TEST_CASE("csv: a name that the header has twice is refused where it is used, and its number is taken") {
  const std::string table = "time,latitude,longitude,accuracy,latitude\n1,50,8,2,51\n";
  CHECK_THROWS_MATCHES(
      read_csv(table, gnss(0)), InputError,
      Message("log.csv:1:1: the header has 'latitude' 2 times; name the column of latitude by "
              "its number"));
  LogRequest request = gnss(0);
  request.columns["latitude"] = {"5", "", ""};
  CHECK(read_csv(table, request).fixes.at(0).latitude_deg == 51);
  CHECK(read_csv("time,latitude,longitude,accuracy,note,note\n1,50,8,2,a,b\n", gnss(0)).fixes.size() == 1);
}

TEST_CASE("csv: a fix without accuracy takes the stated default, or is corrupt") {
  const char* text = "time,latitude,longitude,accuracy\n1,50,8,nan\n2,50,8,-1\n3,50,8,2\n";
  const LogData data = read_csv(text, gnss(5));
  REQUIRE(data.fixes.size() == 3);
  CHECK(data.fixes[0].covariance_en(0, 0) == 25);
  CHECK(data.fixes[1].covariance_en(1, 1) == 25);
  CHECK(data.notes.back() == "log.csv: 2 fixes have no accuracy; the stated default sigma of 5 m is used");

  const LogData strict = read_csv(text, gnss(0));
  CHECK(strict.fixes.size() == 1);
  CHECK(strict.corrupt == 2);
  CHECK(strict.corrupt_examples[0] ==
        "log.csv:2:8: accuracy: the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'");

  CHECK_THROWS_MATCHES(
      read_csv("time,latitude,longitude\n1,50,8\n", gnss(0)), InputError,
      Message(
          "log.csv: the fixes have no accuracy: map accuracy, accuracy_east and accuracy_north, "
          "or sigma_east and sigma_north, or quality, or state 'accuracy: {default_sigma: ...}' (in metres)"));
}

TEST_CASE("csv: a line without a fix is not corrupt") {
  const LogData data =
      read_csv("time,latitude,longitude,valid\n1,,,0\n2,50,8,1\n3,x,8,V\n4,50,8,A\n", gnss());
  CHECK(data.fixes.size() == 2);
  CHECK(data.fixes[0].line == 3);
  CHECK(data.corrupt == 0);
  CHECK(data.notes.back() == "log.csv: 2 of 4 records are marked as without a fix");
}

TEST_CASE("csv: pieces of any length give the same") {
  const std::string text =
      "\xEF\xBB\xBF# a "
      "comment\r\n\ntime;latitude;longitude;accuracy\r\n1.5;55.1;12.25;2\r\n2;x;1;1\n3;55;12;0";
  const LogData data = waymark_test::check_pieces(CsvLogReader(), text, "log.csv", gnss());
  CHECK(data.fixes.size() == 2);
  CHECK(data.corrupt == 1);
}

TEST_CASE("csv: what cannot be read at all is an error that says why") {
  CHECK_THROWS_MATCHES(read_csv("", odometry()), InputError, Message("log.csv: the log is empty"));
  CHECK_THROWS_MATCHES(read_csv("\n# only a comment\n", odometry()), InputError,
                       Message("log.csv: the log is empty"));
  CHECK_THROWS_MATCHES(read_csv("time,speed,yaw_rate\n", odometry()), InputError,
                       Message("log.csv: the log holds no records"));
  CHECK_THROWS_MATCHES(
      read_csv("time,speed,yaw_rate\n1,2\n3,4\n", odometry()), InputError,
      Message("log.csv: none of 2 records could be used; first: log.csv:2:4: expected 3 fields, got 2"));
  CHECK_THROWS_MATCHES(read_csv("time,latitude,longitude,valid\n1,,,0\n", gnss()), InputError,
                       Message("log.csv: not one fix in 1 records (1 are marked as without a fix)"));
}

TEST_CASE("csv: a missing column names those present and the nearest") {
  LogRequest request = odometry();
  request.columns["speed"] = {"v_mp", "", ""};
  CHECK_THROWS_MATCHES(
      read_csv("# note\ntime,v_mps,yaw_rate\n1,2,3\n", request), InputError,
      Message("log.csv:2:1: no column 'v_mp' for speed; did you mean 'v_mps'?; columns present: time, "
              "v_mps, yaw_rate"));
  request.columns.erase("speed");
  CHECK_THROWS_MATCHES(
      read_csv("time,v_mps,yaw_rate\n1,2,3\n", request), InputError,
      Message("log.csv:1:1: no column for speed (neither 'speed' nor 'speed_mps'): name it under "
              "columns; columns present: time, v_mps, yaw_rate"));
  request.columns["spede"] = {"v_mps", "", ""};
  CHECK_THROWS_MATCHES(
      read_csv(kTwo, request), InputError,
      Message("log.csv: 'spede' is no quantity of the odometry stream; did you mean 'speed'?"));
  request.columns = {{"speed", {"speed", "kmh", ""}}};
  CHECK_THROWS_MATCHES(
      read_csv(kTwo, request), InputError,
      Message("log.csv: unknown unit 'kmh' for speed; did you mean 'km/h'?; known: m/s, km/h, mph, "
              "kn, mm/s"));
}

}  // namespace csv_log_test

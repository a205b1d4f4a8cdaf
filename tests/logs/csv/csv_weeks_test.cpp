// Times of the week in tables: they begin anew at the end of a week, and the stated week is that of the first row.
#include <string>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/common/gps_time.hpp>

#include "logs/csv/csv_text.hpp"

namespace csv_weeks_test {

using namespace waymark;
using namespace waymark::formats;
using waymark_test::csv_request;
using waymark_test::read_csv;

namespace {

constexpr std::int64_t kWeek = kGpsWeekNanoseconds;

LogRequest request(StreamKind stream, int week) {
  LogRequest request = csv_request(stream);
  request.gps_week = week;
  return request;
}

constexpr const char* kPlaces =
    "time,latitude,longitude\n604798,50,15\n604799.5,50,15\n0.5,50,15\n1,50,15\n2,50,15\n";

}  // namespace

TEST_CASE(
    "csv: a time of the week that begins anew goes on in the next week, with a stated week and without") {
  for (const int week : {0, 2314}) {
    const LogData fixes = read_csv(kPlaces, request(StreamKind::gnss, week));
    REQUIRE(fixes.fixes.size() == 5);
    CHECK(fixes.fixes[1].stamp.nanoseconds == week * kWeek + 604'799'500'000'000);
    CHECK(fixes.fixes[2].stamp.nanoseconds == (week + 1) * kWeek + 500'000'000);
    CHECK(fixes.fixes[4].stamp.nanoseconds == (week + 1) * kWeek + 2'000'000'000);
    const LogData truth = read_csv(kPlaces, request(StreamKind::truth, week));
    CHECK(truth.truth.at(4).stamp == fixes.fixes[4].stamp);
    const LogData odometry =
        read_csv("time,speed,yaw_rate\n604799.9,1,0\n0.0,1,0\n", request(StreamKind::odometry, week));
    CHECK(odometry.odometry.at(1).stamp.nanoseconds == (week + 1) * kWeek);
  }
}

TEST_CASE("csv: milliseconds of the week begin anew, too, and rows in disorder stay in their weeks") {
  LogRequest ms = request(StreamKind::odometry, 2314);
  ms.columns["time"] = {"itow", "ms", ""};
  const LogData data =
      read_csv("itow,speed,yaw_rate\n604799950,1,0\n50,1,0\n604799990,1,0\n100,1,0\n604799999,1,0\n", ms);
  REQUIRE(data.odometry.size() == 5);
  const auto of_week = [&](std::size_t i) { return data.odometry[i].stamp.nanoseconds / kWeek; };
  CHECK(of_week(0) == 2314);
  CHECK(of_week(1) == 2315);
  CHECK(of_week(2) == 2314);
  CHECK(of_week(3) == 2315);
  CHECK(of_week(4) == 2314);
}

TEST_CASE("csv: dates, times that go on past the week and clocks of another scale begin no week") {
  const LogData beyond = read_csv("time,speed,yaw_rate\n604799,1,0\n604800.5,1,0\n604802,1,0\n",
                                  request(StreamKind::odometry, 2314));
  REQUIRE(beyond.odometry.size() == 3);
  CHECK(beyond.odometry[2].stamp.nanoseconds == 2315 * kWeek + 2'000'000'000);
  const LogData dates =
      read_csv("time,speed,yaw_rate\n1400000000,1,0\n1399000000,1,0\n", request(StreamKind::odometry, 0));
  CHECK(dates.odometry.at(1).stamp.nanoseconds == 1'399'000'000'000'000'000);
  LogRequest seconds = request(StreamKind::odometry, 0);
  seconds.time_scale = TimeScale::unix_time;
  const LogData restart = read_csv("time,speed,yaw_rate\n500000,1,0\n1,1,0\n", seconds);
  CHECK(restart.odometry.at(1).stamp.nanoseconds == 1'000'000'000);
}

}  // namespace csv_weeks_test

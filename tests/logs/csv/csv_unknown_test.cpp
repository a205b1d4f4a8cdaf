// A speed or a course of -1 that means "not known", as in logs of iOS.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/channels.hpp>

#include "logs/csv/csv_text.hpp"

namespace csv_unknown_test {

using namespace waymark;
using namespace waymark::formats;
using waymark_test::csv_request;
using waymark_test::read_csv;

namespace {

/// Returns a table of speeds with yaw rates of 0, one a second.
std::string speeds(std::initializer_list<const char*> numbers) {
  std::string text = "time,speed,yaw_rate\n";
  int time = 0;
  for (const char* number : numbers) text += std::to_string(time++) + "," + number + ",0\n";
  return text;
}

std::size_t notes_of_marks(const LogData& data) {
  return static_cast<std::size_t>(std::count_if(
      data.notes.begin(), data.notes.end(),
      [](const std::string& note) { return note.find("taken as not known") != std::string::npos; }));
}

}  // namespace

TEST_CASE("csv: speeds of -1 are not known where no other one is negative, in each kind of stream") {
  const LogData whole = read_csv(speeds({"-1", "0.4", "-1.0", "-1"}), csv_request(StreamKind::odometry));
  REQUIRE(whole.odometry.size() == 1);
  CHECK(whole.odometry[0].speed_mps == 0.4);
  CHECK(whole.corrupt == 0);
  CHECK(
      whole.notes.back() ==
      "log.csv: 3 values of speed are -1 m/s, and no other one is negative: they are taken as not known (as "
      "'missing: -1' of the column says; 'missing' with another number keeps them)");

  LogRequest parts = csv_request(StreamKind::odometry);
  parts.readings = odometry_channels();
  parts.columns["speed"] = {"speed", "km/h", ""};
  const LogData readings = read_csv(speeds({"-1", "3.6", "-1", "-1"}), parts);
  REQUIRE(readings.readings.size() == 4);
  CHECK(std::isnan(readings.readings.at(0, 0)));
  CHECK(readings.readings.at(1, 0) == Approx(1));
  CHECK(readings.readings.at(3, 1) == 0);  // the yaw rate of the row stays

  const LogData fixes = read_csv(
      "time,latitude,longitude,speed,course\n0,50,15,-1,-1\n1,50,15,0.5,359.5\n2,50,15,-1,-1\n3,50,15,-1,-1\n",
      csv_request(StreamKind::gnss));
  REQUIRE(fixes.fixes.size() == 4);
  CHECK_FALSE(fixes.fixes[0].speed_mps);
  CHECK_FALSE(fixes.fixes[0].course_rad);
  CHECK(fixes.fixes[1].speed_mps == 0.5);
  CHECK(fixes.fixes[1].course_rad);
  CHECK(notes_of_marks(fixes) == 2);
}

TEST_CASE(
    "csv: speeds of -1 are reversing beside other negative ones, if they are few, and in whole numbers") {
  const auto kept = [](const std::string& text, const LogRequest& how) {
    const LogData data = read_csv(text, how);
    CHECK(notes_of_marks(data) == 0);
    return std::count_if(data.odometry.begin(), data.odometry.end(),
                         [](const OdometrySample& sample) { return sample.speed_mps == -1; });
  };
  const LogRequest plain = csv_request(StreamKind::odometry);
  CHECK(kept(speeds({"-1", "0.5", "-1", "-1", "-0.5"}), plain) == 3);
  CHECK(kept(speeds({"-1", "0.5", "-1", "0.7"}), plain) == 2);
  // A bus of whole m/s reaches -1 first when it reverses.
  CHECK(kept(speeds({"3", "0", "-1", "-1", "-1", "0"}), plain) == 3);
  LogRequest stated = plain;
  stated.columns["speed"] = {"speed", "", "", 1, -999.0};
  CHECK(kept(speeds({"-1", "0.5", "-1", "-1"}), stated) == 3);
}

TEST_CASE("csv: a live log leaves speeds of -1 out from the first one on, until another number is negative") {
  LogRequest live = csv_request(StreamKind::odometry);
  live.is_live = true;
  const auto speeds_of = [&](const std::string& text) {
    std::vector<double> values;
    const LogData data = read_csv(text, live);
    CHECK(data.corrupt == 0);
    for (const OdometrySample& sample : data.odometry) values.push_back(sample.speed_mps);
    return values;
  };
  CHECK(speeds_of(speeds({"-1", "-1", "0.4", "-1", "2"})) == std::vector<double>{0.4, 2});
  CHECK(speeds_of(speeds({"0.4", "-0.6", "-1", "-1"})) == std::vector<double>{0.4, -0.6, -1, -1});
  CHECK(speeds_of(speeds({"3", "0", "-1", "-2"})) ==
        std::vector<double>{3, 0, -1, -2});  // a bus of whole m/s
  LogRequest stated = live;
  stated.columns["speed"] = {"speed", "", "", 1, -999.0};
  CHECK(read_csv(speeds({"0.5", "-1"}), stated).odometry.size() == 2);
}

}  // namespace csv_unknown_test

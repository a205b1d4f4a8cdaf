// Real CAN logs against the results of other decoders, and against physics.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/can/can_log.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/skip.hpp"

namespace candump_drives_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

LogRequest request_with(const std::string& dbc_text, StreamKind stream) {
  LogRequest request;
  request.stream = stream;
  request.companions["dbc"] = {{"the.dbc", dbc_text}};
  request.time_scale = TimeScale::unix_time;
  if (stream == StreamKind::odometry) request.readings = odometry_channels();
  return request;
}

/// Lines of a CSV as texts, without its header.
std::vector<std::vector<std::string>> table(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::string_view rest = text;
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    std::vector<std::string> row;
    while (true) {
      const std::size_t comma = line.find(',');
      row.emplace_back(line.substr(0, comma));
      if (comma == std::string_view::npos) break;
      line.remove_prefix(comma + 1);
    }
    rows.push_back(std::move(row));
  }
  rows.erase(rows.begin());
  return rows;
}

std::vector<std::vector<std::string>> drive_table(const std::string& path) {
  std::string text;
  if (!read_in_pieces(path, [&](std::string_view piece) { text += piece; }).empty()) return {};
  return table(text);
}

double number(const std::string& text) {
  return std::strtod(text.c_str(), nullptr);
}

constexpr const char* kAarhus = "drives/aarhus_horsens";
constexpr const char* kCandump = "/candump.log.gz";
constexpr const char* kDbc = "/canmod-gps.dbc";

LogRequest aarhus_fixes(const std::string& dbc) {
  LogRequest request = request_with(read_text_file(dbc), StreamKind::gnss);
  request.accuracy = AccuracyMeaning::one_sigma;  // sigma = the figure in the table
  request.columns = {{"latitude", {"Latitude", "", ""}},
                     {"longitude", {"Longitude", "", ""}},
                     {"accuracy", {"PositionAccuracy", "", ""}},
                     {"speed", {"Speed", "", ""}},
                     {"speed_accuracy", {"SpeedAccuracy", "", ""}},
                     {"course", {"Heading", "", ""}},
                     {"gnss_time", {"Epoch", "", ""}}};
  return request;
}

}  // namespace

TEST_CASE("candump: the fixes of Aarhus are those of its table, digit by digit") {
  const auto drive = waymark_test::shared_data(kAarhus);
  if (!drive) return;
  const auto rows = drive_table(*drive + "/gnss.csv");
  LogRequest request = aarhus_fixes(*drive + kDbc);
  const LogData all = read_log_file(CanLogReader(), *drive + kCandump, request);
  REQUIRE(all.fixes.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const GeodeticFix& fix = all.fixes[i];
    REQUIRE(fix.stamp == *stamp_from_decimal_seconds(rows[i][0]));
    REQUIRE(fix.latitude_deg == number(rows[i][1]));
    REQUIRE(fix.longitude_deg == number(rows[i][2]));
    REQUIRE(std::sqrt(fix.covariance_en(0, 0)) == number(rows[i][3]));
  }
  request.columns["valid"] = {"PositionValid", "", ""};
  const LogData valid = read_log_file(CanLogReader(), *drive + kCandump, request);
  std::vector<Stamp> expected;
  for (const auto& row : rows) {
    if (row[4] == "1") expected.push_back(*stamp_from_decimal_seconds(row[0]));
  }
  REQUIRE(valid.fixes.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) REQUIRE(valid.fixes[i].stamp == expected[i]);
  CHECK(valid.without_fix == rows.size() - expected.size());
}

TEST_CASE("candump: speed and course of Aarhus come from the frames behind the position's") {
  const auto drive = waymark_test::shared_data(kAarhus);
  if (!drive) return;
  const auto rows = drive_table(*drive + "/gnss_speed_heading.csv");
  const LogData data = read_log_file(CanLogReader(), *drive + kCandump, aarhus_fixes(*drive + kDbc));
  REQUIRE(data.fixes.size() == rows.size());
  int other_headings = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const GeodeticFix& fix = data.fixes[i];
    REQUIRE(*fix.speed_mps == number(rows[i][1]));
    REQUIRE(fix.speed_sigma_mps.value_or(0) == number(rows[i][2]));
    if (std::abs(*fix.course_rad - number(rows[i][4]) * kDegree) > 1e-12) ++other_headings;
  }
  // The table interpolates headings to the stamps of the speeds, which shows where they jump: in two rows.
  CHECK(other_headings == 2);
}

TEST_CASE("candump: the logger of Aarhus is 4.40 s ahead of GNSS time") {
  const auto drive = waymark_test::shared_data(kAarhus);
  if (!drive) return;
  LogData data = read_log_file(CanLogReader(), *drive + kCandump, aarhus_fixes(*drive + kDbc));
  REQUIRE(data.clocks.size() == 2272);
  const auto middle = data.clocks.begin() + 1136;
  const auto ahead = [](const ClockPair& pair) { return seconds_between(pair.told, pair.logged); };
  std::nth_element(data.clocks.begin(), middle, data.clocks.end(),
                   [&](const ClockPair& a, const ClockPair& b) { return ahead(a) < ahead(b); });
  CHECK(ahead(*middle) == Approx(4.40).margin(0.01));
}

TEST_CASE("candump: the gyro of Aarhus, a quarter of a million rows") {
  const auto drive = waymark_test::shared_data(kAarhus);
  if (!drive) return;
  const auto rows = drive_table(*drive + "/imu.csv.gz");
  LogRequest request = request_with(read_text_file(*drive + kDbc), StreamKind::sensor);
  request.readings = {
      {"x", "rad/s", "ccw", true, ""}, {"y", "rad/s", "ccw", true, ""}, {"z", "rad/s", "ccw", true, ""}};
  request.columns = {
      {"x", {"AngularRateX", "", ""}}, {"y", {"AngularRateY", "", ""}}, {"z", {"AngularRateZ", "", ""}}};
  const LogData data = read_log_file(CanLogReader(), *drive + kCandump, request);
  REQUIRE(data.readings.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    REQUIRE(data.readings.stamps[i] == *stamp_from_decimal_seconds(rows[i][0]));
    for (std::size_t axis = 0; axis < 3; ++axis)
      REQUIRE(data.readings.at(i, axis) == Approx(number(rows[i][1 + axis]) * kDegree).margin(1e-12));
  }
}

TEST_CASE("candump: the OBD speed of Aarhus by a multiplexed DBC of six lines") {
  const auto drive = waymark_test::shared_data(kAarhus);
  if (!drive) return;
  const auto rows = drive_table(*drive + "/obd_speed.csv");
  // Answers to OBD service 01: length, 41, the parameter's number, its value.
  const std::string dbc =
      "BO_ 2024 OBD2: 8 ECU\n"
      " SG_ Service M : 15|8@0+ (1,0) [0|255] \"\" X\n"
      " SG_ Parameter m65M : 23|8@0+ (1,0) [0|255] \"\" X\n"
      " SG_ VehicleSpeed m13 : 31|8@0+ (1,0) [0|255] \"km/h\" X\n"
      "SG_MUL_VAL_ 2024 Parameter Service 65-65;\n"
      "SG_MUL_VAL_ 2024 VehicleSpeed Parameter 13-13;\n";
  LogRequest request = request_with(dbc, StreamKind::odometry);
  request.columns = {{"speed", {"VehicleSpeed", "", ""}}};
  const LogData data = read_log_file(CanLogReader(), *drive + kCandump, request);
  REQUIRE(data.readings.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    REQUIRE(data.readings.stamps[i] == *stamp_from_decimal_seconds(rows[i][0]));
    REQUIRE(data.readings.at(i, 0) == Approx(number(rows[i][1])).margin(0.51e-4));  // four decimals
  }
}

TEST_CASE("candump: wheels and yaw rate of a RAV4 are those of one car that drives") {
  const auto logs = waymark_test::shared_data("logs/can");
  if (!logs) return;
  LogRequest request = request_with(read_text_file(*logs + "/toyota_rav4_2019.dbc"), StreamKind::sensor);
  const std::vector<std::string> wheels{"FL", "FR", "RL", "RR"};
  for (const std::string& wheel : wheels) {
    request.readings.push_back({wheel, "m/s", "", false, ""});
    request.columns[wheel] = {"WHEEL_SPEED_" + wheel, "", ""};
  }
  request.readings.push_back({"yaw_rate", "rad/s", "ccw", false, ""});
  request.columns["yaw_rate"] = {"can0:KINEMATICS.YAW_RATE", "", ""};
  const LogData data = read_log_file(CanLogReader(), *logs + "/rav4_2019_first_seconds.candump.log", request);
  REQUIRE(data.corrupt == 0);
  std::vector<double> spreads;  // between the four wheels
  int speeds = 0;
  int rates = 0;
  for (std::size_t row = 0; row < data.readings.size(); ++row) {
    if (!std::isnan(data.readings.at(row, 4))) {
      ++rates;
      REQUIRE(std::abs(data.readings.at(row, 4)) < 5 * kDegree);  // it goes straight on
      continue;
    }
    ++speeds;
    const double* at = data.readings.values.data() + row * data.readings.columns;
    const auto [slowest, fastest] = std::minmax_element(at, at + 4);
    REQUIRE(*slowest > 1);
    REQUIRE(*fastest < 30);
    spreads.push_back((*fastest - *slowest) / *fastest);
  }
  std::sort(spreads.begin(), spreads.end());
  CHECK(spreads[spreads.size() / 2] < 0.02);
  CHECK(spreads.back() < 0.10);
  CHECK(speeds == 1006);  // frames of id 0AA: grep -c '0AA#'
  CHECK(rates == 1007);
  // (46408.589503) 0AA#25B525B525A0258D by hand: 0x25B5 * 0.01 - 67.67 = 28.86 km/h, 0x25A0: 28.65,
  // 0x258D: 28.46
  const double* first = nullptr;
  for (std::size_t row = 0; first == nullptr; ++row) {
    if (data.readings.stamps[row].nanoseconds == 46'408'589'503'000)
      first = data.readings.values.data() + row * data.readings.columns;
  }
  CHECK(first[0] * 3.6 == Approx(28.86));
  CHECK(first[1] * 3.6 == Approx(28.86));
  CHECK(first[2] * 3.6 == Approx(28.46));
  CHECK(first[3] * 3.6 == Approx(28.65));
}

TEST_CASE("candump: real logs are recognised") {
  for (const char* name :
       {"drives/aarhus_horsens/candump.log.gz", "logs/can/rav4_2019_first_seconds.candump.log"}) {
    const auto log = waymark_test::shared_data(name);
    if (!log) continue;
    static const CanLogReader reader;
    const std::vector<LogReaderType> readers{{"candump", "", &reader}};
    CHECK(recognise_log(*log, readers).why.certainty == 1);
  }
}

}  // namespace candump_drives_test

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <waymark/core/error.hpp>
#include <waymark/formats/logs/candump.hpp>
#include <waymark/formats/logs/channels.hpp>

#include "logs/log_pieces.hpp"

using namespace waymark;
using Catch::Matchers::Message;

namespace {

// By hand from the DBC specification: wheels of km/h on one id, turning on another, a receiver's burst of
// three.
constexpr const char* kDbc =
    "BO_ 170 WHEELS: 4 ECU\n"
    " SG_ FL : 7|16@0+ (0.01,0) [0|0] \"kph\" X\n"
    " SG_ FR : 23|16@0+ (0.01,0) [0|0] \"kph\" X\n"
    "BO_ 36 MOTION: 2 ECU\n"
    " SG_ YAW_RATE : 0|16@1- (0.1,0) [0|0] \"deg/s\" X\n"
    "BO_ 37 STEERING: 3 ECU\n"
    " SG_ YAW_RATE : 0|16@1- (0.1,0) [0|0] \"\" X\n"
    " SG_ COUNT : 16|8@1+ (1,0) [0|0] \"\" X\n"
    "BO_ 3 gnss_pos: 8 R\n"
    " SG_ Latitude : 0|28@1+ (1e-06,-90) [0|0] \"deg\" X\n"
    " SG_ Longitude : 28|29@1+ (1e-06,-180) [0|0] \"deg\" X\n"
    " SG_ Accuracy : 57|6@1+ (1,0) [0|0] \"m\" X\n"
    " SG_ Valid : 63|1@1+ (1,0) [0|0] \"\" X\n"
    "BO_ 7 gnss_motion: 4 R\n"
    " SG_ Speed : 0|16@1+ (0.01,0) [0|0] \"m/s\" X\n"
    " SG_ Heading : 16|16@1+ (0.1,0) [0|0] \"deg\" X\n"
    "BO_ 2 gnss_time: 5 R\n"
    " SG_ Epoch : 0|40@1+ (0.001,1577840400) [0|0] \"sec\" X\n"
    "BO_ 10 latitude_only: 4 R\n"
    " SG_ Lat : 0|28@1+ (1e-06,-90) [0|0] \"deg\" X\n"
    "BO_ 11 longitude_only: 4 R\n"
    " SG_ Lon : 0|29@1+ (1e-06,-180) [0|0] \"deg\" X\n"
    "BO_ 12 covariances: 6 R\n"
    " SG_ East : 0|16@1+ (0.1,0) [0|0] \"m\" X\n"
    " SG_ North : 16|16@1+ (0.1,0) [0|0] \"m\" X\n"
    " SG_ Root : 32|16@1- (0.1,0) [0|0] \"m\" X\n";

ColumnRequest from(const std::string& column, const std::string& unit = "",
                   const std::string& convention = "") {
  return {column, unit, convention};
}

LogRequest request_of(StreamKind stream, std::map<std::string, ColumnRequest> columns) {
  LogRequest request;
  request.stream = stream;
  request.columns = std::move(columns);
  request.companions["dbc"] = {"car.dbc", kDbc};
  request.time_scale = TimeScale::unix_time;
  if (stream == StreamKind::odometry) request.readings = odometry_channels();
  return request;
}

LogRequest fixes() {
  return request_of(StreamKind::gnss, {{"latitude", from("Latitude")},
                                       {"longitude", from("Longitude")},
                                       {"accuracy", from("Accuracy")},
                                       {"valid", from("Valid")},
                                       {"speed", from("Speed")},
                                       {"course", from("Heading")}});
}

LogData read(const std::string& text, const LogRequest& request) {
  return CandumpReader().read(text, "car.log", request);
}

std::string hex_bytes(std::uint64_t word, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    const auto byte = static_cast<std::size_t>((word >> (8 * i)) & 255U);
    text += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return text;
}

/// A frame of gnss_pos at (latitude, longitude) in millionths of a degree.
std::string position(const std::string& time, int latitude, int longitude, unsigned accuracy = 4,
                     bool valid = true) {
  const std::uint64_t word = static_cast<std::uint64_t>(latitude + 90'000'000) |
                             (static_cast<std::uint64_t>(longitude + 180'000'000) << 28U) |
                             (std::uint64_t{accuracy} << 57U) | (std::uint64_t{valid ? 1U : 0U} << 63U);
  return "(" + time + ") can0 003#" + hex_bytes(word, 8) + "\n";
}

/// A frame of gnss_motion: speed in cm/s, heading in tenths of a degree.
std::string motion(const std::string& time, unsigned speed, unsigned heading) {
  return "(" + time + ") can0 007#" + hex_bytes(speed | (heading << 16U), 4) + "\n";
}

std::size_t channel(const std::string& name) {
  for (std::size_t i = 0; i < odometry_channels().size(); ++i) {
    if (odometry_channels()[i].name == name) return i;
  }
  return odometry_channels().size();
}

void check_refused(const LogRequest& request, const std::string& message) {
  CHECK_THROWS_MATCHES(CandumpReader().open("car.log", request), InputError, Message("car.log: " + message));
}

}  // namespace

TEST_CASE("candump: every frame with a wanted signal is a row") {
  const LogData data = read(
      "(100.000000) can0 0AA#0E100708\n"  // 36 and 18 km/h
      "(100.010000) can0 111#00\n"        // of no interest
      "(100.020000) can0 024#0A00\n",     // 1 deg/s
      request_of(StreamKind::odometry, {{"wheel_speed_front_left", from("FL")},
                                        {"wheel_speed_front_right", from("WHEELS.FR")},
                                        {"yaw_rate", from("MOTION.YAW_RATE", "", "cw")}}));
  REQUIRE(data.readings.size() == 2);
  CHECK(data.readings.columns == odometry_channels().size());
  CHECK(data.readings.stamps[0].nanoseconds == 100'000'000'000);
  CHECK(data.readings.stamps[1].nanoseconds == 100'020'000'000);
  CHECK(data.readings.at(0, channel("wheel_speed_front_left")) == Approx(10));
  CHECK(data.readings.at(0, channel("wheel_speed_front_right")) == Approx(5));
  CHECK(std::isnan(data.readings.at(0, channel("yaw_rate"))));
  CHECK(std::isnan(data.readings.at(1, channel("wheel_speed_front_left"))));
  CHECK(data.readings.at(1, channel("yaw_rate")) == Approx(-std::numbers::pi / 180));
  CHECK(data.records == 2);
  CHECK(data.kinds ==
        std::map<std::string, std::size_t>{{"MOTION", 1}, {"WHEELS", 1}, {"not in the DBC", 1}});
  CHECK(data.notes ==
        std::vector<std::string>{"car.log: yaw_rate: signal YAW_RATE is in 'deg/s' by the DBC",
                                 "car.log: wheel_speed_front_left: signal FL is in 'kph' by the DBC",
                                 "car.log: wheel_speed_front_right: signal FR is in 'kph' by the DBC",
                                 "car.log: interfaces: can0 (3 frames)"});
}

TEST_CASE("candump: a stated unit is used, and that the DBC has another is noted") {
  const LogData data = read("(1.000000) can0 0AA#000A0000\n",
                            request_of(StreamKind::odometry, {{"speed", from("FL", "m/s")}}));
  CHECK(data.readings.at(0, 0) == 0.1);
  CHECK(data.notes.front() ==
        "car.log: speed: signal FL is read in 'm/s' as stated, though by the DBC it is in 'kph'");
}

TEST_CASE("candump: the columns of a sensor") {
  LogRequest request = request_of(StreamKind::sensor, {{"count", from("COUNT")}});
  request.readings = {{"count", "1", "", true, ""}};
  const LogData data = read("(1.000000) can0 025#000007\n", request);
  REQUIRE(data.readings.columns == 1);
  CHECK(data.readings.values == std::vector<double>{7});
}

TEST_CASE("candump: interfaces are told apart where asked for") {
  const std::string text =
      "(1.000000) can0 0AA#00000000\n(2.000000) can1 0AA#0E100E10\n(3.000000) can1 0AA#0E100E10\n";
  const LogData one = read(text, request_of(StreamKind::odometry, {{"speed", from("can1:WHEELS.FL")}}));
  CHECK(one.readings.size() == 2);
  CHECK(one.notes.back() == "car.log: interfaces: can0 (1 frames), can1 (2 frames)");
  const LogData all = read(text, request_of(StreamKind::odometry, {{"speed", from("FL")}}));
  CHECK(all.readings.size() == 3);
  CHECK(all.notes.back() ==
        "car.log: speed: WHEELS comes on can0 (1 frames), can1 (2 frames), all are read; 'can0:WHEELS.FL' "
        "chooses one");
}

TEST_CASE("candump: a fix takes what comes in other frames of its burst") {
  const std::string pos = position("10.000000", 56'098'655, 10'218'348);
  for (const std::string& text : {motion("9.990000", 500, 900) + pos + motion("10.500000", 900, 1800),
                                  motion("9.500000", 900, 1800) + pos + motion("10.002000", 500, 900),
                                  motion("9.950000", 900, 1800) + pos + motion("10.002000", 500, 900),
                                  motion("9.999000", 500, 900) + pos + motion("10.050000", 900, 1800)}) {
    const LogData data = read(text, fixes());
    REQUIRE(data.fixes.size() == 1);
    const GeodeticFix& fix = data.fixes[0];
    CHECK(fix.stamp.nanoseconds == 10'000'000'000);
    CHECK(fix.latitude_deg == 56.098655);
    CHECK(fix.longitude_deg == 10.218348);
    CHECK(fix.covariance_en(0, 0) == Approx(8));  // 4 m as drms: 16 / 2
    CHECK(*fix.speed_mps == 5);
    CHECK(*fix.course_rad == Approx(std::numbers::pi / 2));
    CHECK(std::isnan(fix.height_m));
  }
  const LogData alone = read(motion("9.8", 500, 900) + pos + motion("10.2", 500, 900), fixes());
  CHECK_FALSE(alone.fixes.at(0).speed_mps);
}

TEST_CASE("candump: bursts in quick succession do not mix") {
  std::string text;
  for (int i = 0; i < 5; ++i) {
    const std::string second = std::to_string(10 + i / 10) + "." + std::to_string(i % 10);
    text += position(second + "00000", 56'000'000 + i, 10'000'000);
    text += motion(second + "02000", 100 * static_cast<unsigned>(i + 1), 0);
  }
  const LogData data = read(text, fixes());
  REQUIRE(data.fixes.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(*data.fixes[i].speed_mps == static_cast<double>(i + 1));
    CHECK(data.fixes[i].line == 2 * i + 1);
  }
}

TEST_CASE("candump: latitude and longitude may come in two frames") {
  const std::string latitude = hex_bytes(146'000'000, 4);
  const std::string longitude = hex_bytes(190'000'000, 4);
  LogRequest request = request_of(StreamKind::truth, {{"latitude", from("Lat")}, {"longitude", from("Lon")}});
  const LogData data =
      read("(1.000000) can0 00A#" + latitude + "\n(1.001000) can0 00B#" + longitude +
               "\n(2.000000) can0 00B#" + longitude + "\n(2.001000) can0 00A#" + latitude +
               "\n(3.000000) can0 00A#" + latitude + "\n(4.000000) can0 00B#" + longitude +
               "\n(4.050000) can0 00A#" + latitude + "\n(5.000000) can0 00B#" + longitude + "\n",
           request);
  REQUIRE(data.truth.size() == 3);
  CHECK(data.truth[0].stamp.nanoseconds == 1'001'000'000);
  CHECK(data.truth[0].latitude_deg == 56);
  CHECK(data.truth[0].longitude_deg == 10);
  CHECK(data.truth[1].stamp.nanoseconds == 2'001'000'000);
  CHECK(data.truth[2].stamp.nanoseconds == 4'050'000'000);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"car.log:5:1: latitude without a longitude within 0.1 s",
                                 "car.log:8:1: longitude without a latitude within 0.1 s"});
}

TEST_CASE("candump: fixes that the receiver marks as none are counted") {
  const LogData data = read(position("1.0", 1, 1, 4, false) + position("2.0", 1, 1), fixes());
  CHECK(data.records == 2);
  CHECK(data.without_fix == 1);
  CHECK(data.fixes.size() == 1);
  CHECK(data.notes.end()[-4] == "car.log: 1 of 2 records are marked as without a fix");
}

TEST_CASE("candump: accuracies per axis with their covariance") {
  LogRequest request = fixes();
  request.columns = {{"latitude", from("Latitude")},
                     {"longitude", from("Longitude")},
                     {"sigma_east", from("East")},
                     {"sigma_north", from("North")},
                     {"covariance_en_signed_root", from("Root")}};
  const std::string text = position("1.0", 1, 1) + "(1.001) can0 00C#14001E00F6FF\n";  // 2, 3, -1 m
  const Eigen::Matrix2d given = read(text, request).fixes.at(0).covariance_en;
  CHECK(given(0, 0) == Approx(4));
  CHECK(given(1, 1) == Approx(9));
  CHECK(given(0, 1) == Approx(-1));
  CHECK_THROWS_MATCHES(read(position("1.0", 1, 1) + "(1.001) can0 00C#0A000A00F6FF\n", request), InputError,
                       Message("car.log: none of 1 records could be used; first: car.log:1:1: "
                               "the covariance is not positive definite"));
}

TEST_CASE("candump: a fix without accuracy takes the stated default or is corrupt") {
  LogRequest request = fixes();
  CHECK_THROWS_MATCHES(read(position("1.0", 1, 1, 0), request), InputError,
                       Message("car.log: none of 1 records could be used; first: car.log:1:1: no accuracy is "
                               "given: state 'default_sigma'"));
  request.default_sigma_m = 3;
  const LogData data = read(position("1.0", 1, 1, 0), request);
  CHECK(data.fixes.at(0).covariance_en(0, 0) == 9);
  CHECK(data.notes.end()[-4] == "car.log: 1 fixes give no accuracy, the stated default sigma of 3 m is used");
  request.default_sigma_m = 0;
  request.columns.erase("accuracy");
  check_refused(
      request,
      "the fixes have no accuracy: map accuracy, accuracy_east and accuracy_north, or sigma_east and "
      "sigma_north, or state 'default_sigma' (in metres)");
}

TEST_CASE("candump: what receivers send for not available is no value") {
  const LogData data = read(motion("1.0", 65535, 65535) + position("1.001", 1, 1), fixes());
  CHECK_FALSE(data.fixes.at(0).course_rad);
  CHECK_FALSE(data.fixes.at(0).speed_mps);
  CHECK(data.notes.end()[-3] ==
        "car.log: course: 1 values of signal Heading are outside its range or no numbers, and count as not "
        "given");
  CHECK_THROWS_MATCHES(
      read(position("1.0", 91'000'000, 1), fixes()), InputError,
      Message("car.log: none of 1 records could be used; first: car.log:1:1: latitude: the signal "
              "is outside -90 .. 90 deg"));
}

TEST_CASE("candump: a fix whose validity nobody tells is corrupt") {
  LogRequest request = fixes();
  request.columns["valid"] = from("COUNT");
  CHECK_THROWS_MATCHES(
      read(position("1.0", 1, 1), request), InputError,
      Message("car.log: none of 1 records could be used; first: car.log:1:1: no frame within 0.1 s "
              "tells whether the fix is valid"));
}

TEST_CASE("candump: the receiver's clock beside the logger's") {
  LogRequest request = fixes();
  request.columns["gnss_time"] = from("Epoch");
  request.time_offset_s = -0.5;
  const std::string text = position("1627274470.528100", 1, 1) + "(1627274470.527600) can1 002#50FC7F820B\n";
  const LogData data = read(text, request);
  REQUIRE(data.clocks.size() == 1);
  CHECK(data.clocks[0].logged.nanoseconds == 1'627'274'470'027'600'000);
  CHECK(data.clocks[0].told.nanoseconds == (0x0B827FFC50LL + 1'577'840'400'000) * 1'000'000);
  CHECK(data.fixes.at(0).stamp.nanoseconds == 1'627'274'470'028'100'000);
  request.time_scale = TimeScale::gps;  // 18 leap seconds in 2021; GPS began at POSIX 315964800
  CHECK(read(text, request).clocks[0].told.nanoseconds ==
        (0x0B827FFC50LL + 1'577'840'400'000 - 315'964'800'000 + 18'000) * 1'000'000);

  request.columns["gnss_time"] = from("COUNT", "s");
  const LogData none = read(position("1.0", 1, 1) + "(1.1) can0 025#000000\n", request);
  CHECK(none.clocks.empty());  // 0: the receiver does not know the time yet
  CHECK(none.notes.end()[-4] ==
        "car.log: gnss_time: 1 values of signal COUNT are outside its range or no numbers, and count as not "
        "given");
}

TEST_CASE("candump: what is corrupt is told with its place, and the run goes on") {
  const LogData data = read(
      "(1.0) can0 0AA#0E100708\n"
      "\n"
      "garbage\n"
      "(x) can0 0AA#0E100708\n"
      "(2.0) can0 0AA#0E1007\n"
      "(2.0) can0 0AA#0E10070\n"
      "(9223372036.9) can0 0AA#0E100708\n"
      "(3.0) can0 0AA#R\n"
      "(3.0) can0 20000080#0000000000000000\n"
      "(4.0) can0 0AA#0E100708",
      request_of(StreamKind::odometry,
                 {{"wheel_speed_front_left", from("FL")}, {"wheel_speed_front_right", from("FR")}}));
  CHECK(data.readings.size() == 2);
  CHECK(data.records == 7);
  CHECK(data.corrupt == 5);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"car.log:3:1: expected a time stamp in parentheses, as candump writes",
                                 "car.log:4:2: 'x' is no time in decimal seconds",
                                 "car.log:5:16: WHEELS: 3 bytes, but the signal FR needs 4",
                                 "car.log:6:16: half a byte: the data have an odd number of hex digits",
                                 "car.log:7:2: '9223372036.9' is no time in decimal seconds"});
  CHECK(data.kinds.at("remote frames") == 1);
  CHECK(data.kinds.at("error frames") == 1);
}

TEST_CASE("candump: what a request lacks is told") {
  LogRequest request = fixes();
  request.companions.clear();
  check_refused(request, "a candump log needs its DBC: state 'dbc: FILE'");
  request.companions["timestamps"] = {"t.txt", ""};
  check_refused(request, "a candump log takes no 'timestamps' file; leave it out");

  check_refused(request_of(StreamKind::gnss, {}),
                "no signal for latitude: state 'columns: {latitude: SIGNAL}'; car.dbc has gnss_pos.Latitude, "
                "gnss_pos.Longitude, gnss_motion.Heading");
  check_refused(request_of(StreamKind::odometry, {}),
                "no signal for speed: state 'columns: {speed: SIGNAL}'; car.dbc has MOTION.YAW_RATE, "
                "STEERING.YAW_RATE, gnss_motion.Speed");
  check_refused(
      request_of(StreamKind::truth, {{"latitude", from("Latitude")}}),
      "no signal for longitude: state 'columns: {longitude: SIGNAL}'; car.dbc has gnss_pos.Latitude, "
      "gnss_pos.Longitude, gnss_motion.Heading");
}

TEST_CASE("candump: a column that does not fit the DBC is told with what does") {
  const auto refused = [](const ColumnRequest& column, const std::string& message) {
    check_refused(request_of(StreamKind::odometry, {{"yaw_rate", column}}), message);
  };
  refused(
      from("YAW_RATE"),
      "yaw_rate: 'YAW_RATE' is a signal of several messages; name one: MOTION.YAW_RATE, STEERING.YAW_RATE");
  refused(from("YAWRATE"), "yaw_rate: car.dbc has no signal 'YAWRATE'; did you mean 'YAW_RATE'?");
  refused(from("MOTION.YAW"), "yaw_rate: MOTION has no signal 'YAW'");
  refused(from("MOTON.YAW_RATE"), "yaw_rate: car.dbc has no message 'MOTON'; did you mean 'MOTION'?");
  refused(from("STEERING.YAW_RATE"),
          "yaw_rate: signal YAW_RATE is without a unit in the DBC; state 'unit' for it: rad/s, deg/s");
  refused(
      from("FL"),
      "yaw_rate: signal FL is in 'kph' by the DBC, which is no unit known for yaw_rate; state 'unit' for it: "
      "rad/s, deg/s");
  refused(from("MOTION.YAW_RATE", "degs"),
          "unknown unit 'degs' for yaw_rate; did you mean 'deg/s'?; known: rad/s, deg/s");
  check_refused(request_of(StreamKind::odometry, {{"yawrate", from("FL")}}),
                "'yawrate' is no quantity of the odometry stream; did you mean 'yaw_rate'?");
  LogRequest clock = fixes();
  clock.columns["gnss_time"] = from("Epoch", "iso8601");
  check_refused(clock, "gnss_time: a signal is a number, not an ISO 8601 date");
  LogRequest without_channels = request_of(StreamKind::odometry, {{"speed", from("FL")}});
  without_channels.readings.clear();
  CHECK_THROWS_MATCHES(CandumpReader().open("car.log", without_channels), UsageError,
                       Message("a CAN log gives odometry in channels: LogRequest::readings must name them"));
  check_refused(request_of(StreamKind::gnss, {{"time", from("Epoch")}}),
                "frames of a candump log are stamped by the logger, no signal can be their 'time'; map the "
                "receiver's clock as gnss_time, then the logger's offset is known");
}

TEST_CASE("candump: a signal that the DBC spoils is refused where it is asked for, else noted") {
  LogRequest request = request_of(StreamKind::odometry, {{"speed", from("S", "m/s")}});
  request.companions["dbc"].text =
      "BO_ 1 M: 1 X\n SG_ S : 1|8@1+ (1,0) [0|0] \"\" X\n SG_ T : 0|8@1+ (1,0) [0|0] \"\" X\n";
  check_refused(
      request,
      "speed: car.dbc:2:10: SG_ S: start 1 and length 8 do not fit into the 1 bytes of M; correct one of "
      "them");
  request.columns["speed"].column = "T";
  CHECK(read("(1.0) can0 001#05\n", request).notes.front() ==
        "car.log: 1 signals of the DBC cannot be read (none is asked for); first: car.dbc:2:10: SG_ S: start "
        "1 and "
        "length 8 do not fit into the 1 bytes of M; correct one of them");
}

TEST_CASE("candump: signals behind a frame's reach are refused") {
  LogRequest request = request_of(StreamKind::odometry, {{"speed", from("S", "m/s")}});
  request.companions["dbc"].text = "BO_ 1 LONG: 100 X\n SG_ S : 512|8@1+ (1,0) [0|0] \"\" X\n";
  check_refused(
      request,
      "speed: LONG.S lies behind the first 64 bytes, so in a message of several frames (a transport "
      "protocol), which is not read here");
}

TEST_CASE("candump: a log without a wanted frame says what was looked for") {
  CHECK_THROWS_MATCHES(read("(1.0) can0 111#00\n(1.0) can1 0AA#00000000\n",
                            request_of(StreamKind::odometry,
                                       {{"speed", from("can0:FL")}, {"yaw_rate", from("MOTION.YAW_RATE")}})),
                       InputError,
                       Message("car.log: no frame holds a wanted signal (WHEELS (id AA) on can0, MOTION (id "
                               "24)); there are can0 (1 "
                               "frames), can1 (1 frames)"));
  CHECK_THROWS_MATCHES(read("", fixes()), InputError, Message("car.log: the log holds no records"));
}

TEST_CASE("candump: Vector ASC logs are refused with the remedy") {
  CHECK_THROWS_MATCHES(
      read("date Mon Jul 26 04:40:55.012 am 2021\nbase hex  timestamps absolute\n", fixes()), InputError,
      Message("car.log: this is a Vector ASC log, which is not read here; `asc2log < car.log > candump.log` "
              "(can-utils) writes a candump log from it"));
}

TEST_CASE("candump: pieces of any length give the same") {
  std::string text = "garbage\r\n";
  for (int i = 10; i < 20; ++i)
    text += position(std::to_string(i) + ".0", i, i) + motion(std::to_string(i) + ".01", 100, 10);
  CHECK(waymark_test::check_pieces(CandumpReader(), text, "car.log", fixes()).fixes.size() == 10);
}

TEST_CASE("candump: is recognised by its lines") {
  const CandumpReader reader;
  const Recognition log = reader.recognise("(1.0) can0 0AA#00\n(1.1) can0 17F00010#2010\n(1.2) can0 0AA#0");
  CHECK(log.certainty == 1);
  CHECK(log.evidence == "2 of 2 lines are CAN frames as candump writes them");
  CHECK(reader.recognise(" (1.0)  can0  7E8   [1]  03\nsome text\n (1.0)  can0  7E8   [1]  03\n").certainty ==
        Approx(2.0 / 3));
  CHECK(reader.recognise("time,speed\n1,2\n").certainty == 0);
  CHECK(reader.recognise("").certainty == 0);
}

#include <catch2/catch.hpp>

#include "logs/can/candump_frames.hpp"

namespace candump_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test::candump_samples;

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
        std::vector<std::string>{"car.log: units by the DBC: yaw_rate 'deg/s' (YAW_RATE), "
                                 "wheel_speed_front_left 'kph' (FL), wheel_speed_front_right 'kph' (FR)",
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
        "car.log: speed: WHEELS is on several interfaces (can0 (1 frames), can1 (2 frames)); all "
        "are read, 'can0:WHEELS.FL' chooses one");
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

TEST_CASE("candump: pieces of any length give the same") {
  std::string text = "garbage\r\n";
  for (int i = 10; i < 20; ++i)
    text += position(std::to_string(i) + ".0", i, i) + motion(std::to_string(i) + ".01", 100, 10);
  CHECK(waymark_test::check_pieces(CanLogReader(), text, "car.log", fixes()).fixes.size() == 10);
}

TEST_CASE("candump: is recognised by its lines") {
  const CanLogReader reader;
  const Recognition log = reader.recognise("(1.0) can0 0AA#00\n(1.1) can0 17F00010#2010\n(1.2) can0 0AA#0");
  CHECK(log.certainty == 1);
  CHECK(log.evidence == "2 of 2 lines are CAN frames as candump writes them");
  CHECK(reader.recognise(" (1.0)  can0  7E8   [1]  03\nsome text\n (1.0)  can0  7E8   [1]  03\n").certainty ==
        Approx(2.0 / 3));
  CHECK(reader.recognise("time,speed\n1,2\n").certainty == 0);
  CHECK(reader.recognise("").certainty == 0);
}

}  // namespace candump_test

#include <catch2/catch.hpp>

#include "logs/can/candump_frames.hpp"

namespace candump_requests_test {

using namespace waymark;
using namespace waymark_test::candump_samples;

TEST_CASE("candump: what a request lacks is told") {
  LogRequest request = fixes();
  request.companions.clear();
  check_refused(request,
                "accuracy: the list of OBD-II and J1939 messages (no 'dbc: FILE' is stated) has no signal "
                "'Accuracy'");
  request.companions["timestamps"] = {{"t.txt", ""}};
  check_refused(request, "a log of CAN frames takes no 'timestamps' file; leave it out");

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
  refused(from("FL"),
          "yaw_rate: signal FL is in 'kph' by the DBC, which is not a unit of yaw_rate; state "
          "'unit' for it: rad/s, deg/s");
  refused(from("MOTION.YAW_RATE", "degs"),
          "unknown unit 'degs' for yaw_rate; did you mean 'deg/s'?; known: rad/s, deg/s");
  check_refused(request_of(StreamKind::odometry, {{"yawrate", from("FL")}}),
                "'yawrate' is no quantity of the odometry stream; did you mean 'yaw_rate'?");
  LogRequest clock = fixes();
  clock.columns["gnss_time"] = from("Epoch", "iso8601");
  check_refused(clock, "gnss_time: a signal is a number, never in 'iso8601'; its units are s, ms, us, ns");
  LogRequest without_channels = request_of(StreamKind::odometry, {{"speed", from("FL")}});
  without_channels.readings.clear();
  CHECK_THROWS_MATCHES(CanLogReader().open("car.log", without_channels), UsageError,
                       Message("a CAN log gives odometry in channels: LogRequest::readings must name them"));
  check_refused(request_of(StreamKind::gnss, {{"time", from("Epoch")}}),
                "frames of a candump log are stamped by the logger, so no signal can be their "
                "'time'; map the receiver's clock as gnss_time, which gives the logger's offset");
}

TEST_CASE("candump: a scale makes a count a speed, and a stated number is no value") {
  LogRequest request = request_of(StreamKind::odometry, {{"speed", from("COUNT")}});
  request.columns["speed"].scale = 0.25;
  request.columns["speed"].missing = 255;
  const LogData data = read("(1.0) can0 025#000028\n(2.0) can0 025#0000FF\n", request);
  REQUIRE(data.readings.size() == 2);
  CHECK(data.readings.at(0, channel("speed")) == 10);
  CHECK(std::isnan(data.readings.at(1, channel("speed"))));

  request.columns["speed"] = from("FL");
  request.columns["speed"].scale = 1.02;
  check_refused(request,
                "speed: signal FL has a scale, and by the DBC it is in 'kph': state the unit of the scaled "
                "value, m/s, km/h, mph, kn, mm/s");
  request.columns["speed"].unit = "km/h";
  CHECK(read("(1.0) can0 0AA#0E100000\n", request).readings.at(0, channel("speed")) == Approx(10.2));
}

TEST_CASE("candump: a signal that the DBC spoils is refused where it is asked for, else noted") {
  LogRequest request = request_of(StreamKind::odometry, {{"speed", from("S", "m/s")}});
  request.companions["dbc"] = {
      {"car.dbc", "BO_ 1 M: 1 X\n SG_ S : 1|8@1+ (1,0) [0|0] \"\" X\n SG_ T : 0|8@1+ (1,0) [0|0] \"\" X\n"}};
  check_refused(
      request,
      "speed: car.dbc:2:10: SG_ S: start 1 and length 8 do not fit into the 1 bytes of M; correct one of "
      "them");
  request.columns["speed"] = from("T", "m/s");
  CHECK(read("(1.0) can0 001#05\n", request).notes.front() ==
        "car.log: 1 signals of the DBC are unreadable (no column uses them); the first: "
        "car.dbc:2:10: SG_ S: start 1 and length 8 do not fit into the 1 bytes of M; correct "
        "one of them");
}

TEST_CASE("candump: signals behind a frame's reach are refused") {
  LogRequest request = request_of(StreamKind::odometry, {{"speed", from("S", "m/s")}});
  request.companions["dbc"] = {{"car.dbc", "BO_ 1 LONG: 100 X\n SG_ S : 512|8@1+ (1,0) [0|0] \"\" X\n"}};
  check_refused(
      request,
      "speed: LONG.S is behind the first 64 bytes, so its message takes several frames (a transport "
      "protocol), which are not read");
}

TEST_CASE("candump: a log without a wanted frame says what was looked for") {
  CHECK_THROWS_MATCHES(read("(1.0) can0 111#00\n(1.0) can1 0AA#00000000\n",
                            request_of(StreamKind::odometry,
                                       {{"speed", from("can0:FL")}, {"yaw_rate", from("MOTION.YAW_RATE")}})),
                       InputError,
                       Message("car.log: no frame holds a signal that is needed (WHEELS (id AA) on "
                               "can0, MOTION (id 24)); the log has can0 (1 frames), can1 (1 frames)"));
  CHECK_THROWS_MATCHES(read("", fixes()), InputError, Message("car.log: the log holds no records"));
}

}  // namespace candump_requests_test

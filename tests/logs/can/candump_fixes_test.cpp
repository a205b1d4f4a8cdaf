#include <catch2/catch.hpp>

#include "logs/can/candump_frames.hpp"

namespace candump_fixes_test {

using namespace waymark;
using namespace waymark_test::candump_samples;

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
  CHECK_THROWS_MATCHES(
      read(position("1.0", 1, 1, 0), request), InputError,
      Message("car.log: none of 1 records could be used; first: car.log:1:1: the "
              "log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'"));
  request.default_sigma_m = 3;
  const LogData data = read(position("1.0", 1, 1, 0), request);
  CHECK(data.fixes.at(0).covariance_en(0, 0) == 9);
  CHECK(data.notes.end()[-4] ==
        "car.log: 1 fixes have no accuracy; the stated default sigma of "
        "3 m is used");
  request.default_sigma_m = 0;
  request.columns.erase("accuracy");
  check_refused(
      request,
      "the fixes have no accuracy: map accuracy, accuracy_east and accuracy_north, or sigma_east and "
      "sigma_north, or quality, or state 'accuracy: {default_sigma: ...}' (in metres)");
}

TEST_CASE("candump: what receivers send for not available is no value") {
  const LogData data = read(motion("1.0", 65535, 65535) + position("1.001", 1, 1), fixes());
  CHECK_FALSE(data.fixes.at(0).course_rad);
  CHECK_FALSE(data.fixes.at(0).speed_mps);
  CHECK(
      data.notes.end()[-3] ==
      "car.log: course: 1 values of signal Heading are outside its range or not available; they are ignored");
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
        "car.log: gnss_time: 1 values of signal COUNT are outside its range or not available; "
        "they are ignored");
}

}  // namespace candump_fixes_test

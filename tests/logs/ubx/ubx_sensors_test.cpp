#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/ubx/ubx.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_sensors.hpp>

#include "logs/ubx/ubx_bytes.hpp"

namespace ubx_sensors_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;
using Catch::Matchers::Message;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Measurement {
  unsigned type;
  std::int64_t field;
};

/// ESF-MEAS with a calibrated time tag.
std::string esf_meas(std::int64_t tag_ms, const std::vector<Measurement>& measurements) {
  UbxBytes bytes(8 + 4 * measurements.size() + 4);
  bytes.u32(0, 77).u16(4, static_cast<std::int64_t>(measurements.size()) << 11 | 8);
  std::size_t at = 8;
  for (const Measurement& measurement : measurements) {
    bytes.u32(at, static_cast<std::int64_t>(measurement.type) << 24 | (measurement.field & 0xFFFFFF));
    at += 4;
  }
  bytes.u32(at, tag_ms);
  return ubx_frame(0x1002, bytes.bytes());
}

/// The same with the provider's time tag alone, as a host sends it to the receiver.
std::string plain_esf_meas(std::int64_t tag_ms, unsigned type, std::int64_t field, unsigned stated = 1) {
  UbxBytes bytes(12);
  bytes.u32(0, tag_ms)
      .u16(4, stated << 11U)
      .u32(8, static_cast<std::int64_t>(type) << 24 | (field & 0xFFFFFF));
  return ubx_frame(0x1002, bytes.bytes());
}

LogRequest channels(const std::vector<std::string>& names) {
  LogRequest request;
  request.stream = StreamKind::odometry;
  for (const SensorColumn& column : odometry_channels()) {
    if (std::find(names.begin(), names.end(), column.name) != names.end()) request.readings.push_back(column);
  }
  return request;
}

std::string pvt(int seconds) {
  return ubx_frame(0x0107, nav_pvt(seconds).u32(16, 0).bytes());
}

LogData decode(std::string_view bytes, const LogRequest& request) {
  const auto decoder = UbxReader().open("log.ubx", request);
  decoder->take(bytes);
  decoder->finish();
  return decoder->data();
}

}  // namespace

TEST_CASE("ubx, by the specification: ESF-MEAS in SI units, NaN for what a message has not") {
  const std::string log = esf_meas(1000, {{5, -4096}, {14, 8192}, {13, 2048}, {12, 3121}, {11, -1500}}) +
                          pvt(0) + esf_meas(1500, {{16, 1024}, {17, -512}, {18, 10'000}, {6, 5}, {10, 3}});
  const LogData data =
      decode(log, channels({"gyro_x", "gyro_y", "gyro_z", "speed", "acceleration_x", "acceleration_y",
                            "acceleration_z", "wheel_ticks_front_left", "wheel_ticks", "steering_angle"}));
  REQUIRE(data.readings.size() == 2);
  REQUIRE(data.readings.columns == 10);
  // Columns in the order of odometry_channels(): speed, front left, ticks, steering, gyros, accelerations.
  const auto at = [&](std::size_t row, std::size_t column) { return data.readings.at(row, column); };
  CHECK(at(0, 0) == Approx(-1.5));
  CHECK(at(0, 4) == Approx(2 * kDegree));
  CHECK(at(0, 5) == Approx(0.5 * kDegree));
  CHECK(at(0, 6) == Approx(-kDegree));
  for (const std::size_t absent : {1U, 2U, 3U, 7U, 8U, 9U}) CHECK(std::isnan(at(0, absent)));
  CHECK(at(1, 1) == 5);
  CHECK(at(1, 2) == 3);
  CHECK(at(1, 7) == 1);
  CHECK(at(1, 8) == -0.5);
  CHECK(at(1, 9) == Approx(9.765625));
  for (const std::size_t absent : {0U, 3U, 4U, 5U, 6U}) CHECK(std::isnan(at(1, absent)));
  CHECK(data.records == 2);
}

TEST_CASE("ubx: sensor tags are placed on GNSS time where a navigation message follows them") {
  // Tags 100 ms apart, a navigation message after each tenth: tag 1000 k comes just before iTOW + 1000 k.
  std::string log;
  for (int k = 0; k < 20; ++k) {
    for (int i = 9; i >= 0; --i) log += esf_meas(1'000'000 + 1000 * k - 100 * i, {{5, k}});
    log += pvt(k);
  }
  LogRequest request = channels({"gyro_z"});
  request.time_scale = TimeScale::utc;
  const LogData data = decode(log, request);
  REQUIRE(data.readings.size() == 200);
  for (std::size_t row = 0; row < 200; ++row)
    CHECK(data.readings.stamps[row].nanoseconds == kUtc + (static_cast<std::int64_t>(row) - 9) * 100'000'000);
  CHECK(data.notes.at(0) ==
        "log.ubx: the calibrated time tags of ESF-MEAS were placed on GNSS time by the order of the "
        "messages (drift over the log 0.000 s); they are too early by the delay of the navigation "
        "messages: hundredths of a second with HNR-PVT, up to half a second without");
}

TEST_CASE("ubx: sensor rows come out in order of their tags") {
  const std::string log = esf_meas(1000, {{5, 1}}) + esf_meas(995, {{5, 2}}) + esf_meas(1090, {{5, 3}}) +
                          esf_meas(1085, {{5, 4}}) + pvt(0);
  const LogData data = decode(log, channels({"gyro_z"}));
  REQUIRE(data.readings.size() == 4);
  CHECK(std::is_sorted(data.readings.stamps.begin(), data.readings.stamps.end()));
  CHECK(data.readings.at(0, 0) == Approx(2 * data.readings.at(1, 0)));
}

TEST_CASE("ubx: the sensors' clock is followed slowly, outliers leave no trace") {
  UbxSensorClock clock;
  std::int64_t gps = kGps;
  for (int i = 0; i < 100; ++i) {
    // 20 ppm fast; each seventh navigation message comes 80 ms late, behind newer tags.
    clock.sensor(5000 + 100 * i + i / 500 + (i % 7 == 3 ? 80 : 0));
    gps = kGps + 100'000'000LL * i;
    clock.navigation(gps);
    if (i > 10) CHECK(std::abs(clock.gps_ns(5000 + 100 * i) - gps) <= 1'000'000);
  }
  CHECK(clock.jumps() == 0);
}

TEST_CASE("ubx: a sensors' clock that begins anew is placed anew") {
  std::string log;
  for (int k = 0; k < 5; ++k) log += esf_meas(900'000 + 1000 * k, {{10, 100 + k}}) + pvt(k);
  for (int k = 5; k < 10; ++k) log += esf_meas(1000 * k, {{10, k}}) + pvt(k);
  const LogData data = decode(log, channels({"wheel_ticks"}));
  REQUIRE(data.readings.size() == 10);
  for (std::size_t k = 0; k < 10; ++k)
    CHECK(data.readings.stamps[k].nanoseconds == kGps + static_cast<std::int64_t>(k) * 1'000'000'000);
  CHECK(data.readings.at(4, 0) == 104);
  CHECK(data.readings.at(5, 0) == 104);  // counter from 104 to 5: begun anew
  CHECK(data.readings.at(9, 0) == 108);
  CHECK(data.notes.at(1) == "log.ubx: the sensors' clock jumped or restarted 1 times");
  CHECK(data.notes.at(2) ==
        "log.ubx: tick counters went back 1 times; each time a restart without motion is assumed");
}

TEST_CASE("ubx: tick counters run on over their end, and back while the direction bit says backwards") {
  constexpr std::uint32_t kBackwards = 1U << 23U;
  UbxTicks ticks;
  CHECK(ticks.count(8'388'600) == 8'388'600);
  CHECK(ticks.count(4) == 8'388'612);
  CHECK(ticks.count(14 | kBackwards) == 8'388'602);
  CHECK(ticks.count(14) == 8'388'602);
  CHECK(ticks.count(24) == 8'388'612);
  CHECK(ticks.restarts() == 0);
  CHECK(ticks.count(20) == 8'388'612);
  CHECK(ticks.restarts() == 1);
}

TEST_CASE("ubx: messages to the receiver are not read twice") {
  std::string log;
  for (int k = 0; k < 3; ++k)
    log += esf_meas(1000 * k, {{10, k}}) + plain_esf_meas(7'000'000 + 1000 * k, 10, k) + pvt(k);
  const LogData data = decode(log, channels({"wheel_ticks"}));
  CHECK(data.readings.size() == 3);
  CHECK(data.notes.at(1) ==
        "log.ubx: 3 ESF-MEAS without a calibrated time tag (messages to the receiver) were skipped");
  const LogData alone = decode(plain_esf_meas(500, 10, 7) + pvt(0), channels({"wheel_ticks"}));
  REQUIRE(alone.readings.size() == 1);
  CHECK(alone.readings.stamps[0].nanoseconds == kGps);
  CHECK(alone.readings.at(0, 0) == 7);
  // Older firmware states no number of measurements: the length tells it.
  CHECK(decode(plain_esf_meas(500, 10, 7, 0) + pvt(0), channels({"wheel_ticks"})).readings.at(0, 0) == 7);
}

TEST_CASE("ubx: corrupt and unplaceable measurements") {
  CHECK(decode(plain_esf_meas(500, 10, 7, 3) + pvt(0), channels({"wheel_ticks"})).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: ESF-MEAS: 12 bytes cannot hold 3 measurements"});
  UbxBytes lacking(12);
  lacking.u16(4, 1 << 11 | 8);
  CHECK(decode(ubx_frame(0x1002, lacking.bytes()), channels({"wheel_ticks"})).corrupt_examples ==
        std::vector<std::string>{
            "log.ubx:byte 0: ESF-MEAS: 12 bytes cannot hold 1 measurements and a calibrated time tag"});
  CHECK(decode(ubx_frame(0x1002, "1234567"), channels({"wheel_ticks"})).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: ESF-MEAS: 7 bytes, but the message has at least 8"});

  const std::string undated = esf_meas(1000, {{10, 1}}) + esf_meas(1100, {{10, 1}}) +
                              ubx_frame(0x0103, UbxBytes(16).u32(0, kItowMs).bytes());
  LogRequest request = channels({"wheel_ticks"});
  const LogData data = decode(undated, request);
  CHECK(data.corrupt == 2);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            "log.ubx: no navigation message gives a GPS week for 2 ESF-MEAS messages; state "
            "'time: {week: ...}' if navigation messages give the time of week"});
  request.gps_week = 2268;
  CHECK(decode(undated, request).readings.stamps.at(1).nanoseconds == kGps);
}

TEST_CASE("ubx: readings that ESF-MEAS has not are an error that says what it has") {
  const std::string has =
      "gyro_z, wheel_ticks_front_left, wheel_ticks_front_right, wheel_ticks_rear_left, "
      "wheel_ticks_rear_right, wheel_ticks, speed, gyro_y, gyro_x, acceleration_x, acceleration_y, "
      "acceleration_z";
  CHECK_THROWS_MATCHES(
      UbxReader().open("log.ubx", channels({"steering_angle"})), InputError,
      Message("log.ubx: a UBX log holds none of the readings asked for; its ESF-MEAS messages may "
              "hold " +
              has));
  LogRequest request = channels({"speed"});
  request.stream = StreamKind::sensor;
  request.readings.push_back({"range", "m", "", true, ""});
  CHECK_THROWS_MATCHES(UbxReader().open("log.ubx", request), InputError,
                       Message("log.ubx: a UBX log holds no 'range'; its ESF-MEAS messages may hold " + has));
  request = channels({"speed"});
  request.columns["speed"] = {"v", "", ""};
  CHECK_THROWS_MATCHES(UbxReader().open("log.ubx", request), InputError,
                       Message("log.ubx: a UBX log of readings has no columns to map; leave out 'columns'"));
}

}  // namespace ubx_sensors_test

// Odometry from pieces: values follow from how the pieces were made.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/csv/csv_log.hpp>
#include <waymark/tools/drive/logs/parts/odometry_parts.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace odometry_parts_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

std::size_t column_of(const std::string& channel) {
  const auto& channels = odometry_channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name == channel) return c;
  }
  FAIL("no channel " << channel);
  return 0;
}

/// A log of one channel at `rate` from `from` to `to`.
OdometryPart part(const std::string& channel, double rate, double from, double to,
                  const std::function<double(double)>& value) {
  OdometryPart result;
  result.file = channel + ".csv";
  result.readings.columns = odometry_channels().size();
  const auto count = static_cast<int>(std::floor((to - from) * rate + 1e-9));
  for (int i = 0; i <= count; ++i) {
    const double t = from + i / rate;
    result.readings.stamps.push_back(Stamp::from_seconds(t));
    std::vector<double> row(result.readings.columns, std::numeric_limits<double>::quiet_NaN());
    row[column_of(channel)] = value(t);
    result.readings.values.insert(result.readings.values.end(), row.begin(), row.end());
  }
  return result;
}

std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

OdometryAssembly at_rate(double rate) {
  OdometryAssembly how;
  how.rate_hz = rate;
  return how;
}

}  // namespace

TEST_CASE("parts: speed at 2 Hz and yaw rate at 100 Hz meet on one clock, ways and turns kept") {
  const auto speed = [](double t) { return 10 + 0.5 * t; };
  const auto yaw = [](double t) { return 0.2 * std::sin(t); };
  const std::vector<OdometryPart> parts{part("speed", 2, 0.2, 30, speed), part("yaw_rate", 100, 0, 31, yaw)};
  const AssembledOdometry odometry = assemble_odometry(parts, at_rate(10), 0.5);
  REQUIRE(odometry.samples.size() == 296);  // whole tenths of a second from 0.2 to 29.7
  CHECK(odometry.samples.front().stamp == Stamp{200'000'000});
  double turn = 0;
  for (const OdometrySample& sample : odometry.samples) {
    const double t = sample.stamp.seconds();
    const bool inside = t > 0.25 && t < 29.65;
    if (inside) CHECK(sample.speed_mps == Approx(speed(t)));
    turn += inside ? 0.1 * sample.yaw_rate_radps : 0;
  }
  // The integral of 0.2 sin t over the samples' periods; the lines between readings at 100 Hz cut 1e-5 off
  // it.
  CHECK(turn == Approx(0.2 * (std::cos(0.25) - std::cos(29.65))).epsilon(1e-4));
}

TEST_CASE("parts: a clock that nobody stated is the yaw rate's, and said") {
  const std::vector<OdometryPart> parts{part("speed", 10, 0, 10, constant(5)),
                                        part("yaw_rate", 25, 0, 10, constant(0.1))};
  const AssembledOdometry odometry = assemble_odometry(parts, {}, 0.5);
  CHECK(odometry.samples.size() == 251);
  CHECK(odometry.notes.back() ==
        "odometry: 251 samples at 25 Hz (the rate of the yaw rate; state 'rate' for another)");
  CHECK(odometry.notes.front() == "odometry: speed from 'speed', 10 readings a second");
}

TEST_CASE("parts: four wheel speeds give speed of the rear axle and, with the track width, the yaw rate") {
  const std::vector<OdometryPart> parts{part("wheel_speed_rear_left", 20, 0, 5, constant(9.85)),
                                        part("wheel_speed_rear_right", 20, 0.01, 5, constant(10.15)),
                                        part("wheel_speed_front_left", 20, 0, 5, constant(11)),
                                        part("wheel_speed_front_right", 20, 0, 5, constant(11))};
  OdometryAssembly how = at_rate(20);
  CHECK_THROWS_MATCHES(assemble_odometry(parts, how, 0.5), InputError,
                       Message("odometry: 'rear_wheels' needs 'vehicle: {track_width: ...}'"));
  how.track_width_m = 1.5;
  const AssembledOdometry odometry = assemble_odometry(parts, how, 0.5);
  CHECK(odometry.samples[50].speed_mps == Approx(10));
  CHECK(odometry.samples[50].yaw_rate_radps == Approx(0.2));  // (10.15 - 9.85) / 1.5
  CHECK(odometry.yaw_rate_from == "rear_wheels");
  how.speed_from = "front_wheels";
  CHECK(assemble_odometry(parts, how, 0.5).samples[50].speed_mps == Approx(11));
}

TEST_CASE("parts: a yaw rate that is known only now and then is warned of") {
  const OdometryPart speed = part("speed", 10, 0, 100, constant(5));
  const OdometryPart gyro = part("yaw_rate", 10, 0, 100, constant(0.1));
  OdometryPart now_and_then = gyro;
  std::vector<double>& values = now_and_then.readings.values;
  for (std::size_t i = 101; i < 900; ++i)
    values[i * gyro.readings.columns + column_of("yaw_rate")] = std::numeric_limits<double>::quiet_NaN();
  const AssembledOdometry odometry =
      assemble_odometry(std::vector<OdometryPart>{speed, now_and_then}, at_rate(10), 0.5);
  REQUIRE(odometry.warnings.size() == 1);
  CHECK_THAT(
      odometry.warnings[0],
      Catch::StartsWith("odometry: the yaw rate from 'yaw_rate' is known in 20.2 % of the 100 s of speed"));
  CHECK(assemble_odometry(std::vector<OdometryPart>{speed, gyro}, at_rate(10), 0.5).warnings.empty());
}

TEST_CASE("parts: counters of ticks become speed, also where they start again from 0") {
  const auto ticks = [](double t) { return std::fmod(std::floor(200 * t), 256); };  // 200 ticks a second
  const std::vector<OdometryPart> parts{part("wheel_ticks", 50, 0, 20, ticks),
                                        part("yaw_rate", 50, 0, 20, constant(0))};
  OdometryAssembly how = at_rate(10);
  CHECK_THROWS_MATCHES(assemble_odometry(parts, how, 0.5), InputError,
                       Message("odometry: 'ticks' needs 'vehicle: {metres_per_tick: ...}'"));
  how.metres_per_tick = 0.05;
  how.tick_range = 256;
  for (const OdometrySample& sample : assemble_odometry(parts, how, 0.5).samples)
    CHECK(sample.speed_mps == Approx(10).margin(0.26));  // a tick within 0.2 s
}

TEST_CASE("parts: an odometer's distance becomes speed, and `reverse` its sign") {
  const std::vector<OdometryPart> parts{part("distance", 10, 0, 20, [](double t) { return 4 * t; }),
                                        part("reverse", 1, 0, 20, [](double t) { return t >= 10 ? 1 : 0; }),
                                        part("yaw_rate", 10, 0, 20, constant(0))};
  const AssembledOdometry odometry = assemble_odometry(parts, at_rate(10), 0.5);
  CHECK(odometry.samples[50].speed_mps == Approx(4));
  CHECK(odometry.samples[150].speed_mps == Approx(-4));
}

TEST_CASE("parts: the axis of a gyro is stated, with its sign") {
  const std::vector<OdometryPart> parts{part("speed", 10, 0, 10, constant(5)),
                                        part("gyro_x", 10, 0, 10, constant(-0.3))};
  OdometryAssembly how = at_rate(10);
  CHECK_THROWS_MATCHES(
      assemble_odometry(parts, how, 0.5), InputError,
      Message(
          "odometry: the yaw rate of a gyro needs 'gyro: {axis: ...}': x, y or z for the axis that points "
          "up, -x, -y or -z for one that points down, gravity to find it from the accelerometer"));
  how.gyro_axis = "-x";
  CHECK(assemble_odometry(parts, how, 0.5).samples[5].yaw_rate_radps == Approx(0.3));
  how.gyro_axis = "y";
  CHECK_THROWS_MATCHES(
      assemble_odometry(parts, how, 0.5), InputError,
      Message(
          "odometry: no log has a channel 'gyro_y' for 'gyro: {axis: y}'; channels found: gyro_x, speed"));
  how.gyro_axis = "gravity";
  CHECK_THROWS_MATCHES(
      assemble_odometry(parts, how, 0.5), InputError,
      Message("odometry: 'gyro: {axis: gravity}' needs gyro_x, _y, _z and acceleration_x, _y, _z; "
              "channels found: gyro_x, speed"));
}

TEST_CASE("parts: gravity at standstill says which way a tilted gyro's yaw points") {
  // Up is (0.6, 0, 0.8) of the sensor's axes; the vehicle turns by 0.5 rad/s once it drives.
  const auto speed = [](double t) { return t < 5 ? 0 : 8; };
  const auto rate = [](double part_of_up) {
    return [part_of_up](double t) { return t < 5 ? 0 : 0.5 * part_of_up; };
  };
  const auto force = [](double part_of_up) {
    return [part_of_up](double t) { return 9.81 * part_of_up + (t < 5 ? 0 : 2); };  // driving adds its own
  };
  const std::vector<OdometryPart> parts{part("speed", 10, 0, 20, speed),
                                        part("gyro_x", 50, 0, 20, rate(0.6)),
                                        part("gyro_y", 50, 0, 20, rate(0)),
                                        part("gyro_z", 50, 0, 20, rate(0.8)),
                                        part("acceleration_x", 50, 0, 20, force(0.6)),
                                        part("acceleration_y", 50, 0, 20, force(0)),
                                        part("acceleration_z", 50, 0, 20, force(0.8))};
  OdometryAssembly how = at_rate(10);
  how.gyro_axis = "gravity";
  const AssembledOdometry odometry = assemble_odometry(parts, how, 0.5);
  CHECK(odometry.samples[150].yaw_rate_radps == Approx(0.5));
  CHECK(odometry.notes[1] ==
        "odometry: up is (0.600, 0.000, 0.800) of the sensor's axes, by gravity at standstill");
}

TEST_CASE("parts: the angle of the steering wheel turns the vehicle as the bicycle model says") {
  const std::vector<OdometryPart> parts{part("speed", 10, 0, 10, constant(10)),
                                        part("steering_angle", 10, 0, 10, constant(1.5))};
  OdometryAssembly how = at_rate(10);
  how.wheelbase_m = 2.5;
  how.steering_ratio = 15;
  CHECK(assemble_odometry(parts, how, 0.5).samples[5].yaw_rate_radps == Approx(10 * std::tan(0.1) / 2.5));
}

TEST_CASE("parts: the change of a heading is the yaw rate, also through half a turn and at other rates") {
  // A turn by 0.3 rad/s to the left for 30 s, through north, west, south and east; then to the right.
  const auto turn = [](double t) { return t < 30 ? 0.3 * t : 9 - 0.2 * (t - 30); };
  const auto wrapped = [&](double t) { return std::remainder(turn(t), 2 * std::numbers::pi); };
  const auto running_on = GENERATE(true, false);
  const double rate = GENERATE(5.0, 20.0, 100.0);  // of the clock: below, at and above that of the heading
  const std::vector<OdometryPart> parts{
      part("speed", 2, 0, 60, constant(5)),
      running_on ? part("heading", 20, 0, 60, turn) : part("heading", 20, 0, 60, wrapped)};
  const AssembledOdometry odometry = assemble_odometry(parts, at_rate(rate), 0.5);
  REQUIRE(odometry.samples.size() == static_cast<std::size_t>(60 * rate) + 1);
  CHECK(odometry.notes[1] == "odometry: yaw rate from 'heading', 20 readings a second");
  double sum = 0;
  for (const OdometrySample& sample : odometry.samples) {
    const double t = sample.stamp.seconds();
    if (t < 29.85) CHECK(sample.yaw_rate_radps == Approx(0.3));
    if (t > 30.15) CHECK(sample.yaw_rate_radps == Approx(-0.2));
    const bool at_an_end = t < 0.5 / rate || t > 60 - 0.5 / rate;
    sum += sample.yaw_rate_radps * (at_an_end ? 0.5 : 1) / rate;
  }
  CHECK(sum == Approx(turn(60)));  // no turn is lost between the clocks
}

TEST_CASE("parts: the clock of a heading is its own, at most 50 Hz, and other sources come before it") {
  const auto turn = [](double t) { return 0.1 * t; };
  std::vector<OdometryPart> parts{part("speed", 10, 0, 10, constant(5)), part("heading", 1, 0, 10, turn)};
  CHECK(assemble_odometry(parts, {}, 0.5).samples.size() == 11);
  parts[1] = part("heading", 200, 0, 10, turn);
  CHECK(assemble_odometry(parts, {}, 0.5).samples.size() == 501);
  parts.push_back(part("yaw_rate", 10, 0, 10, constant(0.7)));
  CHECK(assemble_odometry(parts, {}, 0.5).samples[50].yaw_rate_radps == Approx(0.7));
  OdometryAssembly how;
  how.yaw_rate_from = "heading";
  CHECK(assemble_odometry(parts, how, 0.5).samples[50].yaw_rate_radps == Approx(0.1));
}

TEST_CASE("parts: a turn by more than half a round between two headings is taken the short way") {
  const std::vector<OdometryPart> parts{part("speed", 10, 0, 10, constant(5)),
                                        part("heading", 1, 0, 10, [](double t) { return 4 * t; })};
  for (const OdometrySample& sample : assemble_odometry(parts, {}, 0.5).samples)
    CHECK(sample.yaw_rate_radps == Approx(4 - 2 * std::numbers::pi));
}

TEST_CASE("parts: a compass that counts clockwise from north in degrees is a heading") {
  LogRequest request;
  request.stream = StreamKind::odometry;
  request.readings = odometry_channels();
  request.columns["heading"] = {"hdt", "deg", "cw_from_north"};
  const LogData data =
      CsvLogReader().read("time,speed,hdt\n0,5,350\n1,5,356\n2,5,2\n3,5,\n4,5,14\n", "imu.csv", request);
  const std::vector<OdometryPart> parts{{data.readings, "imu.csv"}};
  const AssembledOdometry odometry = assemble_odometry(parts, {}, 0.5);
  REQUIRE(odometry.samples.size() == 5);
  for (const OdometrySample& sample : odometry.samples)  // 6 degrees a second to the right
    CHECK(sample.yaw_rate_radps == Approx(-6 * std::numbers::pi / 180));
}

TEST_CASE("parts: where a channel is silent there are no samples, so that the gap is seen") {
  OdometryPart yaw = part("yaw_rate", 50, 0, 20, constant(0.1));
  SensorTable kept;
  kept.columns = yaw.readings.columns;
  for (std::size_t row = 0; row < yaw.readings.size(); ++row) {
    const double t = yaw.readings.stamps[row].seconds();
    if (t > 8 && t < 12) continue;
    kept.stamps.push_back(yaw.readings.stamps[row]);
    for (std::size_t c = 0; c < kept.columns; ++c) kept.values.push_back(yaw.readings.at(row, c));
  }
  yaw.readings = kept;
  const std::vector<OdometryPart> parts{part("speed", 10, 0, 20, constant(5)), yaw};
  for (const OdometrySample& sample : assemble_odometry(parts, at_rate(10), 0.5).samples) {
    const double t = sample.stamp.seconds();
    CHECK_FALSE((t > 8.01 && t < 11.99));
  }
}

TEST_CASE("parts: what cannot be put together is said") {
  const std::vector<OdometryPart> twice{part("speed", 10, 0, 10, constant(5)),
                                        part("speed", 10, 0, 10, constant(5))};
  CHECK_THROWS_MATCHES(assemble_odometry(twice, {}, 0.5), InputError,
                       Message("odometry: both speed.csv and speed.csv have 'speed'; leave it out "
                               "of the columns of one of them"));
  const std::vector<OdometryPart> half{part("speed", 10, 0, 10, constant(5))};
  CHECK_THROWS_MATCHES(assemble_odometry(half, {}, 0.5), InputError,
                       Message("odometry: no log has a channel for the yaw rate; channels found: speed"));
  OdometryAssembly how;
  how.speed_from = "distance";
  CHECK_THROWS_MATCHES(assemble_odometry(half, how, 0.5), InputError,
                       Message("odometry: no log has a channel for the speed from 'distance', as "
                               "stated; channels found: speed"));
  const std::vector<OdometryPart> apart{part("speed", 10, 0, 10, constant(5)),
                                        part("yaw_rate", 10, 20, 30, constant(0))};
  CHECK_THROWS_MATCHES(assemble_odometry(apart, {}, 0.5), InputError,
                       Message("odometry: speed and yaw rate do not overlap in time; check 'time: "
                               "{scale, week, offset}' of the parts"));
}

TEST_CASE("parts: a channel that is stated comes before one that only has a default name") {
  OdometryPart unstated = part("speed", 10, 0, 10, constant(36));  // km/h, which nobody asked for
  unstated.by_default = {"speed"};
  const OdometryPart distance = part("distance", 10, 0, 10, [](double t) { return 10 * t; });
  const OdometryPart gyro = part("gyro_z", 10, 0, 10, constant(0.1));
  OdometryAssembly how;
  how.gyro_axis = "z";
  const std::vector<OdometryPart> both{unstated, distance, gyro};
  CHECK(assemble_odometry(both, how, 0.5).samples[50].speed_mps == Approx(10));
  // It fills what is lacking, and what is stated by its source.
  const std::vector<OdometryPart> lacking{unstated, gyro};
  CHECK(assemble_odometry(lacking, how, 0.5).samples[50].speed_mps == Approx(36));
  how.speed_from = "speed";
  CHECK(assemble_odometry(both, how, 0.5).samples[50].speed_mps == Approx(36));
  // The same channel of two logs: in either order the stated one counts.
  how.speed_from = {};
  const OdometryPart stated = part("speed", 10, 0, 10, constant(10));
  const std::vector<OdometryPart> after{unstated, stated, gyro};
  const std::vector<OdometryPart> before{stated, unstated, gyro};
  const std::vector<OdometryPart> twice{unstated, unstated, gyro};
  CHECK(assemble_odometry(after, how, 0.5).samples[50].speed_mps == Approx(10));
  CHECK(assemble_odometry(before, how, 0.5).samples[50].speed_mps == Approx(10));
  CHECK(assemble_odometry(twice, how, 0.5).samples[50].speed_mps == Approx(36));
}

TEST_CASE("parts: stated wheels give the yaw rate before a default column if the track width is stated") {
  OdometryPart unstated = part("yaw_rate", 10, 0, 10, constant(0.5));
  unstated.by_default = {"yaw_rate"};
  const std::vector<OdometryPart> parts{part("wheel_speed_rear_left", 10, 0, 10, constant(9.9)),
                                        part("wheel_speed_rear_right", 10, 0, 10, constant(10.1)), unstated};
  CHECK(assemble_odometry(parts, {}, 0.5).samples[50].yaw_rate_radps == Approx(0.5));
  OdometryAssembly how;
  how.track_width_m = 2;
  CHECK(assemble_odometry(parts, how, 0.5).samples[50].yaw_rate_radps == Approx(0.1));
}

TEST_CASE("time series: means over a span are those of the lines between readings") {
  const TimeSeries ramp{{Stamp{0}, Stamp{1'000'000'000}, Stamp{3'000'000'000}}, {0, 2, 2}};
  const SeriesIntegral integral(ramp);
  CHECK(integral.mean({0}, {1'000'000'000}) == Approx(1));
  CHECK(integral.mean({500'000'000}, {2'000'000'000}) == Approx((0.75 + 2) / 1.5));
  CHECK(integral.mean({3'000'000'000}, {4'000'000'000}) == Approx(2));  // constant beyond the end
  CHECK(integral.mean({500'000'000}, {500'000'000}) == Approx(1));
  CHECK(*value_at(ramp, {500'000'000}, 1) == Approx(1));
  CHECK_FALSE(value_at(ramp, {2'000'000'000}, 1).has_value());  // between readings 2 s apart
  CHECK_FALSE(value_at(ramp, {-1}, 1).has_value());
}

}  // namespace odometry_parts_test

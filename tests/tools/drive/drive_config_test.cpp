#include <catch2/catch.hpp>

#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>

namespace drive_config_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

DriveFile parse(const std::string& text, const std::string& data_folder = "") {
  return parse_drive_file(text, "tours/drive.yaml", data_folder);
}

/// The error that a line added to a minimal drive gives.
std::string error_of(const std::string& more) {
  try {
    (void)parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\n" + more);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_of_gnss(const std::string& entries) {
  try {
    (void)parse("odometry: {file: o.csv}\ngnss:\n  file: g.csv\n" + entries);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("drive.yaml: the least there is, and its defaults") {
  const DriveFile config = parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\n");
  CHECK(config.description.name == "drive");
  CHECK(config.description.odometry.front().logs.front().file == "tours/o.csv");
  CHECK(config.description.odometry.front().logs.front().format == "auto");
  CHECK(config.description.odometry.front().logs.front().request.stream == StreamKind::odometry);
  REQUIRE(config.description.gnss.size() == 1);
  CHECK(config.description.gnss[0].file == "tours/g.csv");
  CHECK(config.description.gnss[0].request.accuracy == AccuracyMeaning::automatic);
  CHECK(config.description.gnss[0].request.time_scale == TimeScale::gps);
  CHECK(!config.description.truth);
  CHECK(!config.description.utm_zone);
  CHECK(config.settings.gate.max_angle_rad == Approx(1.5 * std::numbers::pi / 180));
  CHECK(config.settings.gate.max_displacement_m == 15);
  CHECK(config.settings.initial_guess.method == StartMethod::anchored);
  CHECK(config.settings.modeling == "correlated");
  CHECK_FALSE(config.settings.gate.enabled.has_value());  // left to the modeling, as the next two
  CHECK_FALSE(config.settings.calibration.has_value());
  CHECK_FALSE(config.settings.estimates_noise.has_value());
}

TEST_CASE("drive.yaml: an antenna at the body point is stated, and one of which nothing is said is not") {
  const auto is_stated = [](const std::string& more) {
    return parse("odometry: {file: o.csv}\ngnss: {file: g.csv" + more + "}\n")
        .description.gnss[0]
        .antenna_is_stated;
  };
  CHECK(is_stated(", antenna: [0, 0]"));
  CHECK_FALSE(is_stated(""));
}

TEST_CASE("drive.yaml: everything that can be said") {
  const DriveFile config = parse(R"(
name: Somewhere
environment: urban
folder: logs
time: {scale: utc, from: 10, to: 70.5}
frame: {utm_zone: 56S, origin: [300000, 6250000]}
odometry:
  file: can.tsv
  separator: tab
  columns:
    time: 1
    speed: {column: v, unit: km/h}
    yaw_rate: {column: w, unit: deg/s, convention: cw}
  time: {scale: gps, week: 1900, offset: -0.4}
  options: {heading_variance_per_s: 1e-7}
gnss:
  - {file: a.json, format: gpsd_json, accuracy: {meaning: drms, default_sigma: 5}, antenna: [1, -0.5], period: 0.25,
     delay: 0.1, withhold_every: 10}
  - {file: /logs/b.csv, antenna: [1, -0.5], period: 0.25, delay: 0.1, withhold_every: 10}
truth: {file: t.csv, reference: [0.1, 0.2], time: {scale: unix}}
gate: {enabled: false, max_angle_deg: 2, max_displacement_m: 20}
gap: {longer_than: 1, policy: error, noise_factor: 10}
snap: 0.002
initial_guess: dead_reckoning
modeling: {name: g2, loss: "cauchy:1", options: {weight: 1e6}}
)");
  CHECK(config.description.name == "Somewhere");
  CHECK(config.description.environment == "urban");
  CHECK(config.description.time_scale == TimeScale::utc);
  CHECK(*config.description.from_s == 10);
  CHECK(*config.description.to_s == 70.5);
  CHECK(*config.description.utm_zone == -56);
  CHECK(*config.description.utm_origin == Eigen::Vector2d(300000, 6250000));
  CHECK(config.description.odometry.front().logs.front().file == "tours/logs/can.tsv");
  const LogRequest& odometry = config.description.odometry.front().logs.front().request;
  CHECK(odometry.separator == '\t');
  CHECK(odometry.columns.at("time").column == "1");
  CHECK(odometry.columns.at("speed").unit == "km/h");
  CHECK(odometry.columns.at("yaw_rate").convention == "cw");
  CHECK(odometry.time_scale == TimeScale::gps);
  CHECK(odometry.gps_week == 1900);
  CHECK(odometry.time_offset_s == -0.4);
  CHECK(config.settings.odometry_options.at("heading_variance_per_s") == "1e-7");
  CHECK(config.places.of.at("odometry.options.heading_variance_per_s") == "tours/drive.yaml:15:37: ");
  REQUIRE(config.description.gnss.size() == 2);
  CHECK(config.description.gnss[0].format == "gpsd_json");
  CHECK(config.description.gnss[0].request.accuracy == AccuracyMeaning::drms);
  CHECK(config.description.gnss[0].request.default_sigma_m == 5);
  CHECK(config.description.gnss[0].request.time_scale == TimeScale::utc);  // the drive's, if it states none
  CHECK(config.description.gnss[1].file == "/logs/b.csv");
  CHECK(config.description.gnss[1].request.source == 1);
  CHECK(config.description.gnss.front().antenna_m == Eigen::Vector2d(1, -0.5));
  CHECK(config.description.gnss.front().period_s == 0.25);
  CHECK(config.description.gnss.front().delay_s == 0.1);
  CHECK(config.description.gnss.front().withhold_every == 10);
  CHECK(config.description.truth->request.time_scale == TimeScale::unix_time);
  CHECK(config.description.truth_reference_m == Eigen::Vector2d(0.1, 0.2));
  CHECK(config.settings.gate.enabled == false);
  CHECK(config.settings.gate.max_angle_rad == Approx(2 * std::numbers::pi / 180));
  CHECK(config.settings.gate.max_displacement_m == 20);
  CHECK(config.description.timeline.gap_s == 1);
  CHECK(config.description.timeline.gap_policy == GapPolicy::error);
  CHECK(config.description.timeline.gap_noise_factor == 10);
  CHECK(config.description.timeline.snap_s == 0.002);
  CHECK(config.settings.initial_guess.method == StartMethod::dead_reckoning);
  CHECK(config.settings.modeling == "g2");
  CHECK(config.settings.loss == "cauchy:1");
  CHECK(config.settings.modeling_options.at("weight") == "1e6");
}

TEST_CASE(
    "drive.yaml: a column has a scale and a number for no value, and wrong ones are refused at their place") {
  const LogRequest odometry =
      parse(
          "odometry: {file: o.csv, columns: {speed: {column: v, scale: -0.31, missing: -1}, yaw_rate: w}}\n"
          "gnss: {file: g.csv}\n")
          .description.odometry.front()
          .logs.front()
          .request;
  CHECK(odometry.columns.at("speed").scale == -0.31);
  CHECK(odometry.columns.at("speed").missing == -1.0);
  CHECK(odometry.columns.at("yaw_rate").scale == 1);
  CHECK_FALSE(odometry.columns.at("yaw_rate").missing);
  CHECK(error_of_gnss("  columns: {speed: {column: v, scale: 0}}\n") ==
        "tours/drive.yaml:4:39: columns.speed.scale: expected a number other than 0, got '0'");
  CHECK(error_of_gnss("  columns: {speed: {column: v, scale: .nan}}\n") ==
        "tours/drive.yaml:4:39: columns.speed.scale: expected a number other than 0, got '.nan'");
  CHECK(error_of_gnss("  columns: {time: {column: t, scale: 60}}\n") ==
        "tours/drive.yaml:4:19: time is no number that a scale could multiply; leave out 'scale'");
}

TEST_CASE("drive.yaml: a data folder given from outside replaces the stated one, absolute names stand") {
  const DriveFile config =
      parse("folder: logs\nodometry: {file: o.csv}\ngnss: {file: /g.csv}\n", "/elsewhere");
  CHECK(config.description.odometry.front().logs.front().file == "/elsewhere/o.csv");
  CHECK(config.description.gnss[0].file == "/g.csv");
}

TEST_CASE("drive.yaml: an unknown key is an error with its place and the right key") {
  CHECK(error_of("gates: {}\n") == "tours/drive.yaml:3:1: unknown key 'gates'; did you mean 'gate'?");
  CHECK(error_of("gate: {max_angle_dg: 1}\n") ==
        "tours/drive.yaml:3:8: unknown key 'max_angle_dg' in gate; did you mean 'max_angle_deg'?");
  CHECK(error_of("frame: {foo: 1}\n") ==
        "tours/drive.yaml:3:9: unknown key 'foo' in frame; known: utm_zone, origin");
  CHECK(error_of_gnss("  colums: {time: t}\n") ==
        "tours/drive.yaml:4:3: unknown key 'colums' in gnss; did you mean 'columns'?");
  CHECK(error_of_gnss("  columns:\n    lattitude: lat\n") ==
        "tours/drive.yaml:5:5: unknown key 'lattitude' in columns; did you mean 'latitude'?");
  CHECK(error_of_gnss("  columns:\n    latitude: {colum: lat}\n") ==
        "tours/drive.yaml:5:16: unknown key 'colum' in columns.latitude; did you mean 'column'?");
}

TEST_CASE("drive.yaml: wrong types and ranges") {
  CHECK(error_of("snap: soon\n") ==
        "tours/drive.yaml:3:7: snap: expected seconds from 0 to 0.05, got 'soon'");
  CHECK(error_of("gap: {noise_factor: 0.5}\n") ==
        "tours/drive.yaml:3:21: gap.noise_factor: expected a number not below 1, got '0.5'");
  CHECK(error_of("gap: {longer_than: .nan}\n") ==
        "tours/drive.yaml:3:20: gap.longer_than: expected a number above 0, got '.nan'");
  CHECK(error_of("gate: {enabled: maybe}\n") ==
        "tours/drive.yaml:3:17: gate.enabled: expected true or false, got 'maybe'");
  CHECK(error_of("gate: {chord_s: 8}\n") ==
        "tours/drive.yaml:3:7: gate: max_chord_s (5) must not be below chord_s (8)");
  CHECK(error_of("gate: 3\n") == "tours/drive.yaml:3:7: gate: expected a mapping (key: value), got '3'");
  CHECK(error_of("initial_guess: somewhere\n") ==
        "tours/drive.yaml:3:16: initial_guess: expected one of anchored, dead_reckoning, got 'somewhere'");
  CHECK(error_of("time: {from: 5, to: 5}\n") ==
        "tours/drive.yaml:3:21: time.to: must be greater than 'from'");
  CHECK(error_of("frame: {utm_zone: 61N}\n") ==
        "tours/drive.yaml:3:19: frame.utm_zone: expected a zone such as 32N or 56S, got '61N'");
  CHECK(error_of("frame: {origin: [1, 2]}\n") ==
        "tours/drive.yaml:3:17: frame.origin: needs a stated utm_zone, because it is "
        "in coordinates of that zone");
  CHECK(error_of("truth: {reference: [1, 2]}\n") == "tours/drive.yaml:3:8: truth: 'file' is missing");
  CHECK(error_of("truth: {file: t.csv, reference: [1, 2, 3]}\n") ==
        "tours/drive.yaml:3:33: truth.reference: expected two numbers [x, y], got a list of 3");
  CHECK(error_of_gnss("  period: -1\n") ==
        "tours/drive.yaml:4:11: gnss.period: expected 0 (all), or seconds from 0.001 to 1e6, got '-1'");
  CHECK(error_of_gnss("  withhold_every: 1\n") ==
        "tours/drive.yaml:4:19: gnss.withhold_every: expected 0 (none) or a whole number from 2, got '1'");
  CHECK(error_of_gnss("  accuracy: {meaning: 2sigma}\n") ==
        "tours/drive.yaml:4:23: gnss.accuracy.meaning: expected one of auto, 95, 1sigma, drms, cep50, got "
        "'2sigma'");
  CHECK(error_of_gnss("  time: {scale: utc, week: 1900}\n") ==
        "tours/drive.yaml:4:28: gnss.time.week: a week belongs to the scale gps");
  CHECK(error_of_gnss("  format: gpsd_json\n  separator: ;\n") ==
        "tours/drive.yaml:5:14: gnss.separator: belongs to the format csv, not to gpsd_json");
  CHECK(error_of_gnss("  columns:\n    speed: {column: v, unit: kmh}\n") ==
        "tours/drive.yaml:5:12: unknown unit 'kmh' for speed; did you mean 'km/h'?; known: m/s, km/h, mph, "
        "kn, mm/s");
  CHECK(error_of_gnss("  columns:\n    course: {unit: deg}\n") ==
        "tours/drive.yaml:5:13: no column is given for course");
}

TEST_CASE("drive.yaml: numbers that nothing in the world has are refused with their place") {
  CHECK(error_of_gnss("  period: 1e-10\n") ==
        "tours/drive.yaml:4:11: gnss.period: expected 0 (all), or seconds from 0.001 to 1e6, got '1e-10'");
  CHECK(error_of_gnss("  delay: 1e300\n") ==
        "tours/drive.yaml:4:10: gnss.delay: expected seconds from -1e9 to 1e9, got '1e300'");
  CHECK(
      error_of_gnss("  accuracy: {default_sigma: 1e-9}\n") ==
      "tours/drive.yaml:4:29: gnss.accuracy.default_sigma: expected a standard deviation from 1e-6 to 1e6, got "
      "'1e-9'");
  CHECK(error_of("time: {from: 1e300}\n") ==
        "tours/drive.yaml:3:14: time.from: expected seconds from 0 to 1e9, got '1e300'");
  CHECK(
      error_of("gap: {longer_than: 1e-300}\n") ==
      "tours/drive.yaml:3:20: gap.longer_than: expected a number that something in the world may have (0, or "
      "1e-12 to 1e12), got '1e-300'");
}

TEST_CASE("drive.yaml: aliases without end and a second document are refused") {
  CHECK(error_of("modeling: {name: g1, options: {a: &x [*x]}}\n") ==
        "tours/drive.yaml:3:35: the values are nested more than 50 deep");
  std::string bomb = "plugins:\n  - &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    bomb += "  - &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += (k > 0 ? ", *a" : "*a") + std::to_string(i - 1);
    bomb += "]\n";
  }
  CHECK_THAT(error_of(bomb), Catch::Contains("the file has more than 100,000 values with its aliases"));
  CHECK_THAT(error_of("---\nname: x\n"), Catch::Contains(":3:1: a second YAML document begins"));
}

TEST_CASE("drive.yaml: a comma that belongs to nothing ends the document, and does not fill the memory") {
  CHECK(error_of(", and more\n") == "tours/drive.yaml:3:1: no valid YAML: end of map not found");
  CHECK_THROWS_MATCHES(parse("# a drive\n, name: x\n"), InputError,
                       Message("tours/drive.yaml:2:1: no valid YAML: the document has ended before this"));
}

TEST_CASE("drive.yaml: odometry from parts, a CAN log with its DBC, a velocity apart") {
  const DriveFile config = parse(R"(
odometry:
  parts:
    - {file: v.csv, columns: {time: t, speed: v}, time: {offset: -0.4}}
    - {file: can.log, format: candump, dbc: car.dbc, columns: {gyro_x: {column: IMU.Rate, unit: deg/s}}}
  rate: 20
  speed_from: speed
  yaw_rate_from: gyro
  gyro: {axis: -x}
  vehicle: {track_width: 1.5, wheelbase: 2.7, steering_ratio: 15, metres_per_tick: 0.02, tick_range: 65536}
  speed_delay: 0.4
  yaw_rate_delay: -0.1
gnss:
  file: g.nmea
  format: auto
  time: {date: 2009-04-01}
  accuracy: {range_error: 5}
  velocity: {file: doppler.csv, columns: {time: t, speed: v, course: c}}
truth: {file: oxts/data, format: kitti_oxts, timestamps: oxts/times.txt}
)");
  REQUIRE(config.description.odometry.front().logs.size() == 2);
  CHECK(config.description.odometry.front().logs[0].request.time_offset_s == -0.4);
  CHECK(config.description.odometry.front().logs[1].format == "candump");
  CHECK(config.description.odometry.front().logs[1].companions.at("dbc") ==
        std::vector<std::string>{"tours/car.dbc"});
  CHECK(config.description.odometry.front().logs[1].request.columns.at("gyro_x").column == "IMU.Rate");
  CHECK(config.description.odometry.front().logs[1].request.readings.size() == odometry_channels().size());
  CHECK(config.description.odometry.front().assembly.rate_hz == 20);
  CHECK(config.description.odometry.front().assembly.speed_from == "speed");
  CHECK(config.description.odometry.front().assembly.yaw_rate_from == "gyro");
  CHECK(config.description.odometry.front().assembly.gyro_axis == "-x");
  CHECK(config.description.odometry.front().assembly.track_width_m == 1.5);
  CHECK(config.description.odometry.front().assembly.wheelbase_m == 2.7);
  CHECK(config.description.odometry.front().assembly.steering_ratio == 15);
  CHECK(config.description.odometry.front().assembly.metres_per_tick == 0.02);
  CHECK(config.description.odometry.front().assembly.tick_range == 65536);
  CHECK(config.description.odometry.front().speed_delay_s == 0.4);
  CHECK(config.description.odometry.front().yaw_rate_delay_s == -0.1);
  CHECK(config.description.gnss[0].request.date->nanoseconds ==
        1'238'544'000'000'000'000);  // 2009-04-01T00:00:00Z
  CHECK(config.description.gnss[0].request.range_error_m == 5);
  CHECK(config.description.gnss[0].velocity->file == "tours/doppler.csv");
  CHECK(config.description.gnss[0].velocity->request.readings.size() == velocity_channels().size());
  CHECK(config.description.truth->companions.at("timestamps") ==
        std::vector<std::string>{"tours/oxts/times.txt"});
}

TEST_CASE("drive.yaml: what is wrong with parts, dates and signals is told with its place") {
  const auto error_of_odometry = [](const std::string& more) {
    try {
      (void)parse("gnss: {file: g.csv}\nodometry:\n" + more);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK(error_of_odometry("  file: o.csv\n  parts: [{file: v.csv}]\n") ==
        "tours/drive.yaml:3:9: odometry.file: give either 'file' or 'parts'");
  CHECK(error_of_odometry("  parts: []\n") ==
        "tours/drive.yaml:3:10: odometry.parts: at least one log is needed");
  CHECK(error_of_odometry("  parts: [{fil: v.csv}]\n") ==
        "tours/drive.yaml:3:12: unknown key 'fil' in odometry.parts; did you mean 'file'?");
  CHECK(error_of_odometry("  file: o.csv\n  gyro: {axis: up}\n") ==
        "tours/drive.yaml:4:16: odometry.gyro.axis: expected one of x, -x, y, -y, z, -z, gravity, got 'up'");
  CHECK(error_of_odometry("  file: o.csv\n  rate: 0\n") ==
        "tours/drive.yaml:4:9: odometry.rate: expected a rate in Hz from 0.001 to 1000, got '0'");
  CHECK(error_of_odometry("  file: o.csv\n  speed_from: wheels\n") ==
        "tours/drive.yaml:4:15: odometry.speed_from: expected one of speed, rear_wheels, front_wheels, "
        "rear_ticks, "
        "front_ticks, ticks, distance, got 'wheels'");
  CHECK(error_of_odometry("  file: o.csv\n  columns: {wheel_speed_rear_lef: v}\n") ==
        "tours/drive.yaml:4:13: unknown key 'wheel_speed_rear_lef' in columns; did you mean "
        "'wheel_speed_rear_left'?");
  CHECK(error_of_gnss("  time: {date: 1.4.2009}\n") ==
        "tours/drive.yaml:4:16: gnss.time.date: expected a date such as 2009-04-01, got '1.4.2009'");
}

TEST_CASE("drive.yaml: calibration is on, off, or stated state by state") {
  const auto calibration = [](const std::string& more) {
    return parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\n" + more).settings.calibration;
  };
  using Map = std::map<std::string, std::string>;
  CHECK_FALSE(calibration("").has_value());
  CHECK(calibration("calibration: off\n") == Map());
  CHECK(calibration("calibration: false\n") == Map());
  CHECK(calibration("calibration: on\n") == default_calibration());
  CHECK(calibration("calibration: true\n") == default_calibration());
  CHECK(default_calibration().count("gyro_bias") == 1);
  CHECK(default_calibration().count("speed_scale") == 1);
  CHECK(calibration("calibration: {gyro_bias: constant, gyro_bias_sigma: 0.02}\n") ==
        Map{{"gyro_bias", "constant"}, {"gyro_bias_sigma", "0.02"}});
  CHECK(error_of("calibration: maybe\n") ==
        "tours/drive.yaml:3:14: calibration: expected one of on, off, true, false, got 'maybe'");
  const DriveFile config =
      parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\ncalibration: {time_offset: constant}\n");
  CHECK(config.places.of.at("calibration.time_offset") == "tours/drive.yaml:3:28: ");
}

TEST_CASE("drive.yaml: the odometry's model") {
  const DriveFile config = parse("odometry: {file: o.csv, model: bicycle}\ngnss: {file: g.csv}\n");
  CHECK(config.settings.odometry_model == "bicycle");
  CHECK(config.places.of.at("odometry.model") == "tours/drive.yaml:1:32: ");
  CHECK(parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\n").settings.odometry_model == "constant_twist");
}

TEST_CASE("drive.yaml: sensors are a list or a single one, with logs and options of their own") {
  const DriveFile config = parse(R"(
folder: logs
odometry: {file: o.csv}
gnss: {file: g.csv}
sensors:
  - name: heading
    file: compass.csv
    separator: ";"
    columns: {heading: {column: hdg, unit: deg, convention: cw_from_north}}
    time: {scale: unix, offset: 1300319576.61}
    options: {sigma_deg: 0.5}
  - {name: gnss_velocity}
)");
  REQUIRE(config.description.sensors.size() == 2);
  const SensorConfig& compass = config.description.sensors[0];
  CHECK(compass.name == "heading");
  CHECK(compass.place == "tours/drive.yaml:6:5: ");
  CHECK(compass.log->file == "tours/logs/compass.csv");
  CHECK(compass.log->request.stream == StreamKind::sensor);
  CHECK(compass.log->request.separator == ';');
  CHECK(compass.log->request.columns.at("heading").convention == "cw_from_north");
  CHECK(compass.log->request.time_scale == TimeScale::unix_time);
  CHECK(compass.log->request.time_offset_s == 1300319576.61);  // a logger that counts from its start
  CHECK(compass.options.at("sigma_deg") == "0.5");
  CHECK(!config.description.sensors[1].log);

  const DriveFile single =
      parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\nsensors: {name: lane, file: m.csv}\n");
  REQUIRE(single.description.sensors.size() == 1);
  CHECK(single.description.sensors[0].name == "lane");

  CHECK(error_of("sensors: [{file: m.csv}]\n") == "tours/drive.yaml:3:11: sensors: 'name' is missing");
  CHECK(error_of("sensors: heading\n") ==
        "tours/drive.yaml:3:10: sensors: expected a mapping (key: value), got 'heading'");
  CHECK(error_of("sensors: [{name: lane, option: {}}]\n") ==
        "tours/drive.yaml:3:24: unknown key 'option' in sensors; did you mean 'options'?");
  CHECK(error_of("sensors: [{name: lane, antenna: [1, 2]}]\n").find("unknown key 'antenna' in sensors") !=
        std::string::npos);
  CHECK(error_of("sensor: {name: lane}\n") ==
        "tours/drive.yaml:3:1: unknown key 'sensor'; did you mean 'sensors'?");
}

TEST_CASE("drive.yaml: plugins are names, or files beside the drive.yaml") {
  const auto plugins = [](const std::string& value) {
    return parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\nplugins: " + value + "\n", "/data")
        .description.plugins;
  };
  using Names = std::vector<std::string>;
  CHECK(plugins("[my_sensor.so, lib/other, named, /opt/third.so]") ==
        Names{"tours/my_sensor.so", "tours/lib/other", "named", "/opt/third.so"});
  CHECK(plugins("my_sensor.so") == Names{"tours/my_sensor.so"});
  CHECK(plugins("[]").empty());
  CHECK(error_of("plugins: [[a.so]]\n") ==
        "tours/drive.yaml:3:10: plugins: expected a list of plugin files, got a list of 1");
}

TEST_CASE("drive.yaml: what is missing, doubled or no YAML") {
  CHECK_THROWS_MATCHES(parse("gnss: {file: g.csv}\n"), InputError,
                       Message("tours/drive.yaml:1:1: 'odometry' is missing"));
  CHECK_THROWS_MATCHES(
      parse("odometry: {file: g.csv}\n"), InputError,
      Message("tours/drive.yaml:1:1: 'gnss' is missing; a drive without it needs a sensor that sees known "
              "places, or 'first_pose'"));
  CHECK_THROWS_MATCHES(parse("odometry: {file: o.csv}\ngnss: []\n"), InputError,
                       Message("tours/drive.yaml:2:7: gnss: at least one log is needed"));
  CHECK(error_of("gate: {}\ngate: {}\n") == "tours/drive.yaml:4:1: key 'gate' is given twice");
  CHECK_THROWS_MATCHES(parse("odometry: {file: [\n"), InputError,
                       Message("tours/drive.yaml:2:1: no valid YAML: end of sequence flow not found"));
  CHECK_THROWS_MATCHES(parse(""), InputError,
                       Message("tours/drive.yaml: the file: expected a mapping (key: value), got nothing"));
  CHECK_THROWS_MATCHES(load_drive_file("absent/drive.yaml"), InputError,
                       Message("absent/drive.yaml: cannot read: No such file or directory"));
}

}  // namespace drive_config_test

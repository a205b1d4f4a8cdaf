// `inspect` on constructed logs with known answers: each suspicion once, and none for a clean log.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/inspection/proposal/drive_proposal.hpp>

#include "logs/ubx/raw_frames.hpp"
#include "support/paths.hpp"

namespace inspection_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;
using namespace waymark::inspection;

namespace {

constexpr double kStart = 1'600'000'000;  // 2020-09-13T12:26:40Z
const Stamp kNow = Stamp::from_seconds(1'700'000'000);

/// One fix of a drive at 10 m/s on a circle of 200 m.
struct Row {
  double t = 0, latitude = 0, longitude = 0, height = 50, speed = 10, sigma_east = 1, sigma_north = 1.5;
  bool valid = true;
};

Row row_at(int i) {
  const double angle = 10.0 * i / 200;
  Row row;
  row.t = kStart + i;
  row.latitude = 50 + 200 * std::sin(angle) / 111195.08;
  row.longitude = 10 + 200 * std::cos(angle) / (111195.08 * std::cos(50 * std::numbers::pi / 180));
  row.height = 50 + i % 11;
  row.sigma_east = 1 + 0.01 * (i % 7);
  row.sigma_north = 1.5 + 0.01 * (i % 5);
  return row;
}

std::string write(const std::string& name, const std::string& text) {
  const std::string path = (waymark_test::scratch_dir() / name).string();
  write_file_atomically(path, text);
  return path;
}

std::string gnss_csv(const std::function<void(int, Row&)>& change = {}, int fixes = 120,
                     const char* name = "gnss.csv") {
  std::string text = "t_unix_s,lat_deg,lon_deg,h_m,v_mps,sigma_e_m,sigma_n_m,valid\n";
  for (int i = 0; i < fixes; ++i) {
    Row row = row_at(i);
    if (change) change(i, row);
    text +=
        fmt::format("{:.3f},{:.8f},{:.8f},{:.2f},{:.4f},{:.4f},{:.4f},{}\n", row.t, row.latitude,
                    row.longitude, row.height, row.speed, row.sigma_east, row.sigma_north, row.valid ? 1 : 0);
  }
  return write(name, text);
}

LogInspection inspect(const std::string& path, const std::string& format = "auto") {
  InspectionOptions options;
  options.format = format;
  options.now = kNow;
  return inspect_log(path, builtin_log_readers(), options);
}

std::vector<LogInspection> inspect_all(const std::vector<std::string>& paths) {
  InspectionOptions options;
  options.now = kNow;
  return inspect_logs(paths, builtin_log_readers(), options);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The one suspicion of a changed drive begins so.
void check_suspicion(const std::string& sentence, const std::function<void(int, Row&)>& change) {
  const LogInspection log = inspect(gnss_csv(change));
  INFO(inspection_text(log));
  REQUIRE(log.suspicions.size() == 1);
  CHECK(has(log.suspicions[0], sentence));
}

std::string odometry_csv(const char* header, double yaw_rate, const char* name = "odometry.csv") {
  std::string text = std::string(header) + "\n";
  for (int i = 0; i < 1200; ++i)
    text += fmt::format("{:.2f},{:.3f},{:.5f}\n", kStart + 0.1 * i, 10.0, yaw_rate);
  return write(name, text);
}

}  // namespace

TEST_CASE("inspection: quantiles in a histogram are those of the sorted numbers within 3.2 percent") {
  Quantiles quantiles;
  std::vector<double> all;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(std::exp(std::sin(1.7 * i) * 8));  // from 3e-4 to 3e3
    quantiles.add(i % 2 == 0 ? all.back() : -all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.0, 0.05, 0.5, 0.95, 1.0})
    CHECK(quantiles.quantile(share) == Approx(all[static_cast<std::size_t>(share * 19999)]).epsilon(0.032));
  CHECK(quantiles.count_above(1e9) == 0);
  Quantiles constant;
  for (int i = 0; i < 100; ++i) constant.add(0.2);
  CHECK(constant.median() == Approx(0.2).epsilon(1e-12));
  CHECK(std::isnan(Quantiles().median()));
}

TEST_CASE("inspection: the median of an even sample is exact up to 1024 numbers and near beyond") {
  EvenSample few, many;
  for (int i = 0; i < 1001; ++i) few.add((i * 7919) % 1001 - 500);
  CHECK(few.median() == 0);
  for (int i = 0; i < 100'000; ++i) many.add((i * 7919) % 100'003 - 50'000);
  CHECK(std::abs(many.median()) < 4000);
  CHECK(many.count() == 100'000);
}

TEST_CASE("inspection: a clean log has its figures and nothing suspicious") {
  const LogInspection log = inspect(gnss_csv());
  INFO(inspection_text(log));
  CHECK(log.suspicions.empty());
  CHECK(log.format == "csv");
  REQUIRE(log.fixes);
  const FixSummary& fixes = *log.fixes;
  CHECK(fixes.fixes == 120);
  CHECK(fixes.stamps.median_interval_s() == Approx(1).epsilon(1e-9));
  CHECK(fixes.stamps.span_s() == Approx(119));
  CHECK(fixes.stamps.gaps() == 0);
  CHECK(fixes.distance_m == Approx(119 * 2 * 200 * std::sin(10.0 / 400)).epsilon(1e-4));
  CHECK(fixes.box.height_m() == Approx(400).epsilon(0.001));
  CHECK(fixes.box.width_m() == Approx(400).epsilon(0.001));
  CHECK(fixes.height.smallest == 50);
  CHECK(fixes.height.largest == 60);
  CHECK(fixes.with_accuracy == 120);
  CHECK(fixes.east.range.smallest == Approx(1.0));
  CHECK(fixes.east.range.largest == Approx(1.06));
  CHECK(fixes.north.median == Approx(1.52).epsilon(0.032));
  CHECK(fixes.with_speed == 120);
  CHECK(fixes.with_course == 0);
  CHECK(fixes.speed_factor == Approx(1).epsilon(0.032));
  CHECK(log.clock.scale == TimeScale::unix_time);
  CHECK(log.clock.known);
  CHECK(date_text(fixes.stamps.earliest(), log.clock) == "2020-09-13T12:26:40.000Z");
}

TEST_CASE("inspection: gaps are counted, the five longest named with their places") {
  const LogInspection log = inspect(gnss_csv([](int i, Row& row) {
    for (int gap = 1; gap <= 7; ++gap)
      if (i >= 10 * gap) row.t += gap == 1 ? 1 : 1 + gap;  // 2 s is no gap, 4 s and more are
  }));
  CHECK(log.fixes->stamps.gaps() == 6);
  const std::vector<LongInterval> longest = log.fixes->stamps.longest_gaps();
  REQUIRE(longest.size() == 5);
  CHECK(longest[0].seconds == 9);
  CHECK(longest[0].line == 72);  // the 71st fix, below a header
  CHECK(longest[4].seconds == 5);
}

TEST_CASE("inspection: clocks that go backwards, stand or jump are named with count and first place") {
  check_suspicion(
      "the clock of the fixes goes backwards once, first in record 52, 2020-09-13T12:27:27.000Z by 2 s",
      [](int i, Row& row) { row.t -= i >= 50 ? 3 : 0; });
  check_suspicion("a stamp of the fixes equals the one before once, first in record 52",
                  [](int i, Row& row) { row.t -= i >= 50 ? 1 : 0; });
  check_suspicion(
      "the clock of the fixes jumps by more than an hour once, first in record 52, "
      "2020-09-13T13:30:50.000Z by 3801 s",
      [](int i, Row& row) { row.t += i >= 50 ? 3800 : 0; });
}

TEST_CASE("inspection: positions that cannot be right are counted") {
  check_suspicion("3 fixes are at latitude 0, longitude 0, first in record 12", [](int i, Row& row) {
    if (i >= 10 && i < 13) row.latitude = row.longitude = 0;
  });
  check_suspicion("2 fixes are more than 1000 km from the others, first in record 32", [](int i, Row& row) {
    if (i == 30 || i == 70) row.longitude += 40;
  });
  check_suspicion(
      "the position is constant for 5 fixes or more although the receiver's speed is above 1 m/s "
      "once, first in record 42",
      [](int i, Row& row) {
        if (i >= 40 && i < 48) row.latitude = row_at(40).latitude;
        if (i >= 40 && i < 48) row.longitude = row_at(40).longitude;
      });
  check_suspicion("positions are written in steps of 11 m", [](int, Row& row) {
    row.latitude = std::round(row.latitude * 1e4) / 1e4;
    row.longitude = std::round(row.longitude * 1e4) / 1e4;
  });
  check_suspicion("heights reach from 50.0 to 32767.0 m", [](int i, Row& row) {
    if (i == 5) row.height = 32767;
  });
}

TEST_CASE("inspection: a vehicle that stands, and four equal positions, are not frozen receivers") {
  const LogInspection standing = inspect(gnss_csv([](int i, Row& row) {
    if (i < 40) return;
    row.latitude = row_at(40).latitude;
    row.longitude = row_at(40).longitude;
    row.speed = 0;
  }));
  CHECK(standing.suspicions.empty());
  const LogInspection four = inspect(gnss_csv([](int i, Row& row) {
    if (i >= 40 && i < 44) row.latitude = row_at(40).latitude;
    if (i >= 40 && i < 44) row.longitude = row_at(40).longitude;
  }));
  CHECK(four.suspicions.empty());
}

TEST_CASE("inspection: accuracies that say little") {
  check_suspicion("the accuracy never changes: sigma is 1 m in all 120 fixes",
                  [](int, Row& row) { row.sigma_east = row.sigma_north = 1; });
  check_suspicion("east and north have the same accuracy in every fix",
                  [](int, Row& row) { row.sigma_north = row.sigma_east; });
  check_suspicion("half of the fixes claim a sigma below 0.0", [](int, Row& row) {
    row.sigma_east *= 0.01;
    row.sigma_north *= 0.01;
  });
  const LogInspection none =
      inspect(gnss_csv([](int i, Row& row) { row.sigma_east = i < 20 ? 1 + 0.1 * i : 0; }));
  CHECK(none.fixes->with_accuracy == 20);
  CHECK(has(inspection_text(none),
            "100 of 120 fixes have none: state 'accuracy: {default_sigma: ...}' for them"));
}

TEST_CASE("inspection: speeds in another unit are named") {
  check_suspicion("km/h were read as m/s", [](int, Row& row) { row.speed *= 3.6; });
  check_suspicion("m/s were read as km/h", [](int, Row& row) { row.speed /= 3.6; });
  check_suspicion("knots were read as m/s", [](int, Row& row) { row.speed *= 1.943844; });
  check_suspicion("m/s were read as knots", [](int, Row& row) { row.speed /= 1.943844; });
}

TEST_CASE("inspection: a receiver mostly without a fix, and dates of another age") {
  check_suspicion("the receiver has no fix in 90 of 120 records",
                  [](int i, Row& row) { row.valid = i < 30; });
  const LogInspection old = inspect(write(
      "old.csv",
      "time,latitude,longitude,accuracy\n1999-08-22T00:00:00Z,50,10,1.1\n1999-08-22T00:00:01Z,50.1,10,1\n"));
  REQUIRE(old.suspicions.size() == 1);
  CHECK(old.suspicions[0] ==
        "the first stamp is 1999-08-22T00:00:00.000Z, before 2000: if the receiver is wrong by 1024 "
        "weeks, the date is 2019-04-07T00:00:00.000Z");
}

TEST_CASE("inspection: a log without a fix is inspected, and that is said") {
  const std::string path =
      write("nofix.nmea", "$GPRMC,120000.00,V,,,,,,,010409,,,N*72\n$GPRMC,120001.00,V,,,,,,,010409,,,N*73\n");
  const LogInspection log = inspect(path);
  CHECK(log.format == "nmea");
  CHECK(log.records == 2);
  CHECK(log.without_fix == 2);
  CHECK(has(inspection_text(log), "no fix in 2 records (2 marked as without a fix)"));
  CHECK(log.suspicions == std::vector<std::string>{"the receiver has no fix in 2 of 2 records"});
}

TEST_CASE("inspection: yaw rates in degrees are suspicious, those of a car in radians are not") {
  const LogInspection right = inspect(odometry_csv("t_unix_s,v_mps,yawrate_radps", 0.05));
  CHECK(right.suspicions.empty());
  REQUIRE(right.odometry);
  REQUIRE(right.odometry->channels.size() == 2);
  CHECK(right.odometry->channels[1].range.largest == 0.05);
  CHECK(1 / right.odometry->channels[0].stamps.median_interval_s() == Approx(10));
  const LogInspection wrong = inspect(odometry_csv("t_unix_s,v_mps,yawrate_radps", 2.86));
  REQUIRE(wrong.suspicions.size() == 1);
  CHECK(has(wrong.suspicions[0],
            "yaw_rate exceeds 2.86 rad/s (164 deg/s) in 5 % of the drive: probably deg/s are"));
}

TEST_CASE("inspection: logs that do not overlap are told apart by how much") {
  const std::string a = gnss_csv({}, 10, "a.csv");
  const auto after = [&](double seconds) {
    const std::string b = gnss_csv([&](int, Row& row) { row.t += seconds; }, 10, "b.csv");
    const std::vector<LogInspection> logs = inspect_all({a, b});
    return logs[1].suspicions.empty() ? std::string() : logs[1].suspicions.back();
  };
  CHECK(after(5).empty());
  CHECK(has(after(18), "it begins 9.000 s after that ends, and its start is 18.000 s later"));
  CHECK(has(after(18), "GPS time is 18 s ahead of UTC"));
  CHECK(has(after(-315964800), "ends 315964791.000 s before that begins"));
  CHECK(has(after(-315964800), "GPS epoch of 1980"));
  CHECK(has(after(-619315200), "1024 weeks"));
}

TEST_CASE("inspection: names of columns and signals say quantity, unit and sense") {
  const auto told = [](const char* name) {
    const ColumnProposal proposal = propose_quantity(name);
    return proposal.quantity + "|" + proposal.unit + "|" + proposal.convention;
  };
  CHECK(told("t_unix_s") == "time|s|");
  CHECK(told("gps_sow_s") == "time|s|");
  CHECK(told("lat_deg") == "latitude|deg|");
  CHECK(told("v_mps") == "speed|m/s|");
  CHECK(told("Vehicle Speed [km/h]") == "speed|km/h|");
  CHECK(told("yawrate_radps") == "yaw_rate|rad/s|");
  CHECK(told("yawrate_projected_degps") == "yaw_rate|deg/s|");
  CHECK(told("Yaw [deg/s]") == "yaw_rate|deg/s|");
  CHECK(told("yaw_degps_cw") == "yaw_rate|deg/s|cw");
  CHECK(told("yaw_deg") == "heading|deg|");
  CHECK(told("gyro_x_degps") == "gyro_x|deg/s|");
  CHECK(told("AngularRateZ") == "gyro_z||");
  CHECK(told("accel_y (m/s^2)") == "acceleration_y|m/s^2|");
  CHECK(told("pos_acc_m") == "accuracy|m|");
  CHECK(told("sdn_m") == "sigma_north|m|");
  CHECK(told("sdne_m") == "covariance_en_signed_root|m|");
  CHECK(told("heading_rad_ccw_from_east") == "heading|rad|ccw_from_east");
  CHECK(told("WHEEL_SPEED_FL") == "wheel_speed_front_left||");
  CHECK(told("rear_right_ticks") == "wheel_ticks_rear_right||");
  CHECK(told("speed_valid") == "||");
  CHECK(told("nsat") == "satellites||");
  CHECK(told("gps_seconds_of_week") == "time|s|");
  CHECK(told("gpstime") == "time||");
  CHECK(told("gps_week") == "date|gps_week|");
  CHECK(told("field.position_covariance0") == "sigma_east|m^2|");
  CHECK(told("field.status.status") == "quality|ros|");
  CHECK(told("N/S") == "latitude_hemisphere||");
  CHECK(told("lat (rad)") == "latitude|rad|");
  CHECK(told("heading°") == "heading|deg|");
  CHECK(told("Geschwindigkeit [km/h]") == "speed|km/h|");
  CHECK(told("Gierrate [°/s]") == "yaw_rate|deg/s|");
  CHECK(told("Geographische Länge") == "longitude||");
  CHECK(told("velocity_north") == "velocity_north||");
  CHECK(told("vel_east") == "velocity_east||");
  CHECK(told("VelForward (km/h)") == "speed|km/h|");
  CHECK(told("Speed (OBD)(km/h)") == "speed|km/h|");
  CHECK(told("/odom/twist/twist/angular/z") == "yaw_rate||");
  CHECK(told("/fix/latitude") == "latitude||");
  CHECK(told("/odom/pose/pose/orientation/w") == "||");
  CHECK(told("Breite [m]") == "||");
  CHECK(told("GEOGRAPHISCHE LÄNGE") == "longitude||");
  CHECK(told("speed\xC2\xA0[km/h]") == "speed|km/h|");
  CHECK(told("vel m/s up") == "||");
  CHECK(told("utcTimeMillis") == "time|ms|");
  CHECK(told("TOW [0.001 s]") == "time|ms|");
  CHECK(told("HAccuracy [0.01 m]") == "accuracy|cm|");
  CHECK(told("position_covariance_4") == "sigma_north|m^2|");
  CHECK(told("angvel_z") == "gyro_z||");
  CHECK(told("gz") == "gyro_z||");
  CHECK(told("Vitesse de lacet (deg/s)") == "yaw_rate|deg/s|");
  CHECK_FALSE(propose_quantity("hacc_m_first_60s_only").remark.empty());
}

TEST_CASE("inspection: names of accuracies say what share of the errors they hold") {
  const auto told = [](const char* name) {
    const ColumnProposal proposal = propose_quantity(name);
    return std::tuple(proposal.quantity, proposal.meaning, proposal.scale);
  };
  const std::string accuracy = "accuracy";
  CHECK(told("2DRMS [m]") == std::tuple(accuracy, AccuracyMeaning::drms, 0.5));
  for (const char* name : {"2dRMS", "h_acc_2drms_m", "2 drms (m)"})
    CHECK(told(name) == std::tuple(accuracy, AccuracyMeaning::drms, 0.5));
  for (const char* name : {"cep_m", "CEP50", "hacc_cep"})
    CHECK(told(name) == std::tuple(accuracy, AccuracyMeaning::cep50, 1.0));
  for (const char* name : {"CEP (95%)", "accuracy_cep_95", "accuracy_cep95"})
    CHECK(told(name) == std::tuple(accuracy, AccuracyMeaning::drms, 0.578));
  CHECK(told("accuracy_drms") == std::tuple(accuracy, AccuracyMeaning::drms, 1.0));
  CHECK(told("hacc_m") == std::tuple(accuracy, AccuracyMeaning::automatic, 1.0));
  // 95 % of normal errors of 1 per axis are within sqrt(-2 log 0.05); their drms is sqrt(2).
  const auto [quantity, meaning, scale] = told("r95");
  CHECK(quantity == accuracy);
  CHECK(meaning == AccuracyMeaning::drms);
  CHECK(scale == Approx(std::sqrt(2.0) / std::sqrt(-2 * std::log(0.05))).epsilon(1e-3));
  const ColumnProposal rate = propose_quantity("gyro_z_mdps");
  CHECK(rate.quantity == "gyro_z");
  CHECK(rate.unit == "deg/s");
  CHECK(rate.scale == 1e-3);
  CHECK(propose_quantity("yaw [mdps]").quantity == "yaw_rate");
  CHECK(propose_quantity("yaw [mdps]").scale == 1e-3);
  CHECK(propose_quantity("v [mrad/s]").quantity.empty());
}

TEST_CASE("inspection: the meaning of an accuracy is proposed as its name tells") {
  std::string text = "time,lat,lon,2DRMS [m]\n";
  for (int i = 0; i < 60; ++i) {
    const Row row = row_at(i);
    text += fmt::format("{:.3f},{:.8f},{:.8f},{}\n", row.t, row.latitude, row.longitude, 5.6 + i % 3);
  }
  const LogInspection log = inspect(write("drms.csv", text));
  // 2drms of 5.6 m are 2.8 m drms, which are 1.98 m per axis.
  CHECK(log.fixes->with_accuracy == 60);
  const std::vector<LogInspection> logs{log};
  const std::string yaml = drive_yaml(propose_drive(logs), logs, waymark_test::scratch_dir());
  CHECK(has(yaml, "meaning: drms\n"));
  CHECK(has(yaml, "scale: 0.5"));
}

TEST_CASE("inspection: the name of a radius says nothing of the accuracies of axes") {
  std::string text = "time,lat,lon,epx,epy,cep\n";
  for (int i = 0; i < 60; ++i) {
    const Row row = row_at(i);
    text += fmt::format("{:.3f},{:.8f},{:.8f},4,{},5\n", row.t, row.latitude, row.longitude, 4 + i % 3);
  }
  const std::vector<LogInspection> logs{inspect(write("axes.csv", text))};
  CHECK(logs[0].fixes->east.median == Approx(2).epsilon(0.04));  // 95 % of an axis
  CHECK_FALSE(has(drive_yaml(propose_drive(logs), logs, waymark_test::scratch_dir()), "meaning: cep50"));
}

TEST_CASE("inspection: CAN frames without a DBC are ids with rates and lengths") {
  std::string text;
  for (int i = 0; i < 100; ++i)
    text += fmt::format("({:.6f}) can{} 1A0#0102{}\n", kStart + 0.01 * i, i % 2, i == 7 ? "03" : "");
  text += "(1600000001.000000) can0 17F00010#20\n";
  const LogInspection log = inspect(write("raw.candump", text));
  REQUIRE(log.can);
  CHECK(log.can->frames == 101);
  REQUIRE(log.can->ids.size() == 2);
  CHECK(log.can->ids[0].name == "1A0");
  CHECK(log.can->ids[0].values == 100);
  CHECK(log.can->ids[0].rate_hz == Approx(100).epsilon(1e-6));
  CHECK(log.can->ids[0].detail == "2 to 3 bytes");
  CHECK(log.can->ids[1].name == "17F00010");
  CHECK(has(inspection_text(log), "only messages of OBD-II and J1939 are known without a DBC (--dbc FILE)"));
}

TEST_CASE("inspection: roles are decided and told, and the drive.yaml parses") {
  const std::string folder = waymark_test::scratch_dir().string();
  const std::vector<LogInspection> logs = inspect_all(
      {gnss_csv(), odometry_csv("t_unix_s,v_kmh,yawrate_degps", 2.86), gnss_csv({}, 120, "truth.csv")});
  const DriveProposal proposal = propose_drive(logs);
  CHECK(proposal.gnss == std::vector<std::size_t>{0});
  CHECK(proposal.odometry == std::vector<std::size_t>{1});
  CHECK(proposal.truth == std::vector<std::size_t>{2});
  CHECK_FALSE(proposal.in_parts);
  REQUIRE(proposal.decisions.size() == 3);
  CHECK(has(proposal.decisions[1], "truth: its name says 'truth'"));
  const std::string yaml = drive_yaml(proposal, logs, folder + "/drive.yaml");
  INFO(yaml);
  CHECK(has(yaml, "\n  file: odometry.csv\n"));  // relative to the drive.yaml
  const DriveDescription config = parse_drive_file(yaml, folder + "/drive.yaml").description;
  REQUIRE(config.odometry.size() == 1);
  CHECK(config.odometry[0].logs.front().file == folder + "/odometry.csv");
  CHECK(config.odometry[0].logs.front().request.columns.at("speed").unit == "km/h");
  CHECK(config.odometry[0].logs.front().request.columns.at("yaw_rate").unit == "deg/s");
  CHECK(config.odometry[0].logs.front().request.time_scale == TimeScale::unix_time);
  REQUIRE(config.gnss.size() == 1);
  CHECK(config.gnss[0].request.columns.at("sigma_east").column == "sigma_e_m");
  CHECK(config.time_scale == TimeScale::utc);
  CHECK(config.truth);
}

TEST_CASE("inspection: odometry in two logs becomes parts, columns that say the same are to be checked") {
  std::string speed = "t_unix_s,v\n";
  std::string gyro = "t_unix_s,gyro_x_degps,gyro_y_degps,gyro_z_degps\n";
  for (int i = 0; i < 100; ++i) {
    speed += fmt::format("{:.1f},{}\n", kStart + 0.5 * i, 10);
    gyro += fmt::format("{:.2f},0.1,{},0.2\n", kStart + 0.05 * i, i % 10);
  }
  const std::vector<LogInspection> logs = inspect_all(
      {gnss_csv(), write("speed.csv", speed), write("gyro.csv", gyro), gnss_csv({}, 120, "copy.csv")});
  const DriveProposal proposal = propose_drive(logs);
  CHECK(proposal.in_parts);
  CHECK(proposal.odometry == std::vector<std::size_t>{1, 2});
  CHECK(proposal.unused == std::vector<std::size_t>{3});
  const std::string path = (waymark_test::scratch_dir() / "parts.yaml").string();
  const std::string yaml = drive_yaml(proposal, logs, path);
  INFO(yaml);
  CHECK(has(yaml, "# CHECK: no unit is named; m/s is assumed"));
  CHECK(has(yaml, "gyro: {axis: y}"));  // the one that turns
  const DriveDescription config = parse_drive_file(yaml, path).description;
  CHECK(config.odometry.front().logs.size() == 2);
  CHECK(config.odometry.front().assembly.gyro_axis == "y");
}

TEST_CASE(
    "inspection: a second complete odometry is a source in comments, which is parsed once they are taken away") {
  const std::string first = odometry_csv("t_unix_s,v_kmh,yawrate_degps", 2.86);
  const std::string second = odometry_csv("t_unix_s,v_kmh,yawrate_degps", 2.9, "visual odometry.csv");
  const std::vector<LogInspection> logs = inspect_all({gnss_csv(), first, second});
  const DriveProposal proposal = propose_drive(logs);
  CHECK(proposal.odometry == std::vector<std::size_t>{1});
  CHECK(proposal.further == std::vector<std::size_t>{2});
  CHECK(proposal.unused.empty());
  const std::string path = (waymark_test::scratch_dir() / "several.yaml").string();
  const std::string yaml = drive_yaml(proposal, logs, path);
  INFO(yaml);
  CHECK(parse_drive_file(yaml, path).description.odometry.size() == 1);
  std::string uncommented = yaml;
  const std::size_t begin = uncommented.find("# sources:");
  REQUIRE(begin != std::string::npos);
  for (std::size_t at = begin; at != std::string::npos; at = uncommented.find("\n# ", at))
    uncommented.erase(uncommented[at] == '\n' ? at + 1 : at, 2);
  const DriveDescription config = parse_drive_file(uncommented, path).description;
  REQUIRE(config.odometry.size() == 2);
  CHECK(config.odometry[1].name == "visual_odometry");
  CHECK(config.odometry[1].logs.front().file == second);
  CHECK(config.odometry[1].logs.front().request.columns.at("yaw_rate").unit == "deg/s");
}

TEST_CASE("inspection: a drive.yaml without odometry or positions parses and says what to fill in") {
  const std::vector<LogInspection> logs = inspect_all({gnss_csv()});
  const DriveProposal proposal = propose_drive(logs);
  CHECK(proposal.decisions.back() == "no log with odometry was found: fill in odometry");
  const std::string yaml = drive_yaml(proposal, logs, "/somewhere/else.yaml");
  CHECK(has(yaml, "file: FILL_IN_odometry.csv"));
  const DriveDescription config = parse_drive_file(yaml, "/somewhere/else.yaml").description;
  CHECK(config.gnss[0].file == logs[0].path);  // nothing in common: absolute
}

TEST_CASE("inspection: the template parses, with every key uncommented too") {
  const std::string text = drive_template();
  CHECK_NOTHROW(parse_drive_file(text, "drive.yaml"));
  std::string all;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin + 1);
    all += line.starts_with("# ") ? line.substr(2) : line;
    begin = end + 1;
  }
  const DriveDescription config = parse_drive_file(all, "drive.yaml").description;
  CHECK(config.name == "Somewhere");
  CHECK(config.gnss[0].request.range_error_m == 5);
  CHECK(config.sensors.size() == 1);
}

TEST_CASE("inspection: rubbish is an error with a remedy or a report, never a crash") {
  CHECK_THROWS_WITH(inspect(write("empty.log", "")), Catch::Contains("the log is empty"));
  CHECK_THROWS_WITH(inspect(write("words.log", "hello\nworld\n")),
                    Catch::Contains("format is not recognised"));
  CHECK_THROWS_WITH(inspect(gnss_csv(), "cvs"), Catch::Contains("did you mean 'csv'?"));
  // As a table of no numbers: one column, words.
  const LogInspection words = inspect(write("words.log", "hello\nworld\n"), "csv");
  CHECK_FALSE(words.fixes);
  CHECK(has(inspection_text(words), "neither fixes nor odometry were found"));
  const LogInspection ubx = inspect(write("words.log", "hello\nworld\n"), "ubx");
  CHECK(has(inspection_text(ubx), "no position in the log"));
  CHECK_NOTHROW(inspection_json(words).dump());
}

TEST_CASE(
    "inspect: raw measurements of a UBX log are counted by satellite, with the ephemerides of the log") {
  using namespace waymark_test;
  satellites::KeplerOrbit orbit;
  orbit.number = 5;
  orbit.sqrt_a = 5153;
  orbit.toe_sow_s = 129'600;
  std::string log;
  for (int second = 0; second < 3; ++second)
    log += rawx_frame(1900, 129'600 + second,
                      {{0, 5, 0, 2.1e7, 100.0F, 40 + second},
                       {3, 3, 0, 3.6e7, 10.0F, 30},
                       {6, 2, 0, 2e7, 5.0F, 44, second > 0}});
  for (const int number : {1, 2, 3})
    log += sfrbx_frame(0, 5, 0, lnav_subframe(orbit, number, 7, 1900 % 1024));
  log += rawx_frame(0, 100, {{0, 5, 0, 2.1e7, 100.0F, 40}});  // the receiver does not know the week
  const LogInspection found =
      inspect_log(write("raw.ubx", log), builtin_log_readers(), {.format = "ubx", .dbc = {}, .now = kNow});
  REQUIRE(found.raw);
  CHECK(found.raw->stamps.count() == 3);
  CHECK(found.raw->fewest == 2);
  CHECK(found.raw->most == 3);
  CHECK(found.raw->systems() == "GPS 1, GLONASS 1, BeiDou 1");
  CHECK(found.raw->satellites.at("G05").pseudoranges == 3);
  CHECK(found.raw->satellites.at("G05").mean_cn0_dbhz() == Approx(41));
  CHECK(found.raw->satellites.at("G05").ephemerides == 1);
  CHECK(found.raw->satellites.at("R02").pseudoranges == 2);
  CHECK(found.raw->satellites.at("C03").ephemerides == 0);
  CHECK(found.corrupt == 0);
  CHECK(found.notes.back().find("the log has no ephemeris of C03, R02") != std::string::npos);
  const std::string text = inspection_text(found);
  CHECK(text.find("GPS 1, GLONASS 1, BeiDou 1") != std::string::npos);
  CHECK(text.find("ephemerides") != std::string::npos);
  CHECK(inspection_json(found)["raw"]["satellites"]["G05"]["ephemerides"] == 1);
}

}  // namespace inspection_test

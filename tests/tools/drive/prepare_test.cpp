#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

#include "support/paths.hpp"
#include "support/skip.hpp"

namespace prepare_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;
using Catch::StartsWith;
using Catch::Matchers::Message;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TypeRegistry registry_with_readers() {
  TypeRegistry registry;
  register_log_readers(registry);
  return registry;
}

OdometrySample odometry_at(double t, double speed = 1, double yaw_rate = 0) {
  return {Stamp::from_seconds(t), speed, yaw_rate};
}

GeodeticFix fix_at(double t, double longitude_deg = 15, int source = 0) {
  GeodeticFix fix;
  fix.stamp = Stamp::from_seconds(t);
  fix.latitude_deg = 50;
  fix.longitude_deg = longitude_deg;
  fix.source = source;
  return fix;
}

GeodeticTruth truth_at(double t) {
  GeodeticTruth truth;
  truth.stamp = Stamp::from_seconds(t);
  truth.latitude_deg = 50;
  truth.longitude_deg = 15;
  return truth;
}

/// Ten seconds of odometry at 10 Hz from t = 100 s, fixes at 101, 102, ... 108 s.
DriveLogs small_drive() {
  DriveLogs logs;
  logs.odometry.assign(1, std::vector<DriveLogs::Log>(1));
  logs.odometry.front().front().file = "odometry.csv";
  for (int i = 0; i <= 100; ++i)
    logs.odometry.front().front().data.odometry.push_back(odometry_at(100 + 0.1 * i));
  logs.gnss.emplace_back();
  logs.gnss[0].file = "gnss.csv";
  for (int i = 1; i <= 8; ++i) logs.gnss[0].data.fixes.push_back(fix_at(100 + i));
  return logs;
}

DriveDescription small_description() {
  DriveDescription description;
  description.path = "drive.yaml";
  description.name = "small";
  return description;
}

}  // namespace

TEST_CASE("prepare: a clean drive passes whole") {
  const PreparedDrive drive = prepare_drive(small_drive(), small_description());
  CHECK(drive.name == "small");
  CHECK(drive.odometry.size() == 101);
  REQUIRE(drive.fixes.size() == 8);
  CHECK(drive.frame.zone == 33);
  CHECK(drive.frame.origin_easting_m == 500'000);
  for (int i = 0; i < 8; ++i) {
    CHECK(drive.fixes[static_cast<std::size_t>(i)].epoch == i);
    CHECK(drive.fixes[static_cast<std::size_t>(i)].status == FixStatus::accepted);
  }
  CHECK(drive.fixes[0].grid_scale == Approx(0.9996));
  CHECK(drive.report.odometry.median_interval_s == Approx(0.1));
  CHECK(drive.report.gnss.median_interval_s == Approx(1));
  CHECK(drive.report.odometry.gaps.empty());
  CHECK(drive.truth.empty());
}

TEST_CASE("prepare: disorder, repetition, garbage and reversing are counted") {
  DriveLogs logs = small_drive();
  auto& odometry = logs.odometry.front().front().data.odometry;
  std::swap(odometry[10], odometry[11]);
  odometry.push_back(odometry_at(100.5));         // identical to an earlier one, and out of order
  odometry.push_back(odometry_at(100.6, 7));      // conflicting: the first is kept
  odometry.push_back(odometry_at(105.05, kNan));  // no number
  odometry.push_back(odometry_at(105.06, 1, INFINITY));
  odometry.push_back(odometry_at(105.07, -1));  // reversing
  auto& fixes = logs.gnss[0].data.fixes;
  fixes.push_back(fixes[2]);
  fixes.push_back(fix_at(104, 15.1));
  fixes.push_back(fix_at(105, kNan));
  const PreparedDrive drive = prepare_drive(logs, small_description());
  CHECK(drive.odometry.size() == 102);
  const StreamReport& report = drive.report.odometry;
  CHECK(report.read == 106);
  CHECK(report.non_finite == 2);
  CHECK(report.out_of_order == 2);  // the swap and the step back to 100.5
  CHECK(report.duplicates_identical == 1);
  CHECK(report.duplicates_conflicting == 1);
  CHECK(report.used == 102);
  CHECK(drive.report.reversing == 1);
  CHECK(drive.odometry[6].speed_mps == 1);
  for (std::size_t i = 1; i < drive.odometry.size(); ++i)
    CHECK(drive.odometry[i - 1].stamp < drive.odometry[i].stamp);

  CHECK(drive.fixes.size() == 8);
  CHECK(drive.report.gnss.duplicates_identical == 1);
  CHECK(drive.report.gnss.duplicates_conflicting == 1);
  CHECK(drive.report.gnss.non_finite == 1);
}

TEST_CASE("prepare: seconds of the day go on behind midnight in every log") {
  const DriveLogs usual = small_drive();
  DriveLogs at_midnight = usual;
  const auto wrap = [](Stamp& stamp) {  // 104.95 s is midnight
    stamp = Stamp::from_seconds(std::fmod(stamp.seconds() - 104.95 + 86400, 86400));
  };
  for (OdometrySample& sample : at_midnight.odometry.front().front().data.odometry) wrap(sample.stamp);
  for (GeodeticFix& fix : at_midnight.gnss[0].data.fixes) wrap(fix.stamp);
  const PreparedDrive drive = prepare_drive(at_midnight, small_description());
  CHECK(drive.odometry.size() == 101);
  CHECK(drive.fixes.size() == 8);
  CHECK(seconds_between(drive.odometry.front().stamp, drive.odometry.back().stamp) == Approx(10));
  CHECK(drive.report.odometry.out_of_order == 0);
  CHECK(drive.report.odometry.gaps.empty());
}

TEST_CASE("prepare: two receivers may speak at one stamp: one epoch, two fixes") {
  DriveLogs logs = small_drive();
  logs.gnss.emplace_back();
  for (int i = 1; i <= 8; ++i) logs.gnss[1].data.fixes.push_back(fix_at(100 + i, 15, 1));
  const PreparedDrive drive = prepare_drive(logs, small_description());
  REQUIRE(drive.fixes.size() == 16);
  CHECK(drive.fixes[2].epoch == 1);
  CHECK(drive.fixes[3].epoch == 1);
  CHECK(drive.fixes[3].source == 1);
  CHECK(drive.report.gnss.duplicates_identical == 0);
}

TEST_CASE("prepare: a gap is longer than four usual intervals of the odometry, unless its length is stated") {
  DriveLogs logs = small_drive();
  std::vector<OdometrySample>& odometry = logs.odometry.front().front().data.odometry;
  const double start_s = odometry.front().stamp.seconds();
  std::erase_if(odometry, [&](const OdometrySample& s) {
    const double second = s.stamp.seconds() - start_s;
    return std::abs(second - std::round(second)) > 1e-6;
  });
  DriveDescription description = small_description();
  const PreparedDrive slow = prepare_drive(logs, description);
  CHECK(slow.timeline.gap_s == Approx(4));
  CHECK(slow.report.odometry.gaps.empty());
  for (const Interval& interval : build_timeline(slow.odometry, slow.fixes, slow.timeline).intervals)
    CHECK_FALSE(interval.bridged);
  description.states_gap = true;
  const PreparedDrive stated = prepare_drive(logs, description);
  CHECK(stated.timeline.gap_s == 0.5);
  CHECK(stated.report.odometry.gaps.size() == stated.odometry.size() - 1);
}

TEST_CASE("prepare: gaps are named") {
  DriveLogs logs = small_drive();
  std::erase_if(logs.odometry.front().front().data.odometry, [](const OdometrySample& s) {
    return s.stamp.seconds() > 103.05 && s.stamp.seconds() < 104.95;
  });
  std::erase_if(logs.gnss[0].data.fixes,
                [](const GeodeticFix& f) { return f.stamp.seconds() > 103.5 && f.stamp.seconds() < 107; });
  const PreparedDrive drive = prepare_drive(logs, small_description());
  REQUIRE(drive.report.odometry.gaps.size() == 1);
  CHECK(drive.report.odometry.gaps[0].start == Stamp::from_seconds(103));
  CHECK(drive.report.odometry.gaps[0].length_s == Approx(2));
  REQUIRE(drive.report.gnss.gaps.size() == 1);
  CHECK(drive.report.gnss.gaps[0].length_s == Approx(4));
}

TEST_CASE("prepare: fixes outside the odometry are dropped, those on its ends kept") {
  DriveLogs logs = small_drive();
  for (const double t : {99.9, 100.0, 110.0, 110.001}) logs.gnss[0].data.fixes.push_back(fix_at(t));
  const PreparedDrive drive = prepare_drive(logs, small_description());
  CHECK(drive.fixes.size() == 10);
  CHECK(drive.report.fixes_outside_odometry == 2);
}

TEST_CASE(
    "prepare: more than a tenth of the fixes outside the odometry is told, unless a stretch is stated") {
  DriveLogs logs = small_drive();
  for (int i = 0; i < 8; ++i) logs.gnss[0].data.fixes.push_back(fix_at(121 + i));
  CHECK(prepare_drive(logs, small_description()).report.warnings.empty());  // fewer than ten are a log's end
  for (int i = 8; i < 20; ++i) logs.gnss[0].data.fixes.push_back(fix_at(121 + i));
  const PreparedDrive drive = prepare_drive(logs, small_description());
  CHECK(drive.report.fixes_outside_odometry == 20);
  REQUIRE(drive.report.warnings.size() == 1);
  CHECK_THAT(drive.report.warnings[0],
             StartsWith("20 of 28 fixes lie up to 30 s behind the odometry: they are left out"));
  DriveDescription description = small_description();
  description.to_s = 9;
  CHECK(prepare_drive(logs, description).report.warnings.empty());
  for (GeodeticFix& fix : logs.gnss[0].data.fixes)
    if (fix.stamp.seconds() > 115) fix.stamp = fix.stamp.later(-70);
  CHECK_THAT(prepare_drive(logs, small_description()).report.warnings.at(0),
             StartsWith("20 of 28 fixes lie up to 49 s before the odometry"));
}

TEST_CASE("prepare: samples that share their stamps in great number are told") {
  DriveLogs logs = small_drive();
  std::vector<OdometrySample>& samples = logs.odometry.front().front().data.odometry;
  for (std::size_t i = 1; i < samples.size(); i += 2) {
    samples[i].stamp = samples[i - 1].stamp;
    samples[i].speed_mps = 1.01;
  }
  const PreparedDrive drive = prepare_drive(logs, small_description());
  REQUIRE(drive.report.warnings.size() == 1);
  CHECK_THAT(drive.report.warnings[0],
             StartsWith("odometry.csv: 50 of 101 odometry samples share their stamp with another reading"));
}

TEST_CASE("prepare: window and delay") {
  DriveDescription description = small_description();
  description.from_s = 2;
  description.to_s = 5;
  PreparedDrive drive = prepare_drive(small_drive(), description);
  CHECK(drive.odometry.front().stamp == Stamp::from_seconds(102));
  CHECK(drive.odometry.back().stamp == Stamp::from_seconds(105));
  CHECK(drive.fixes.size() == 4);  // 102 .. 105
  CHECK(drive.report.odometry_outside_window == 70);

  description.gnss.resize(1);
  description.gnss.front().delay_s = 0.25;  // stamped late: each happened a quarter second before
  drive = prepare_drive(small_drive(), description);
  REQUIRE(drive.fixes.size() == 3);
  CHECK(drive.fixes[0].stamp.nanoseconds == 102'750'000'000);
}

TEST_CASE("prepare: thinning keeps the fix nearest to each whole multiple of the period") {
  DriveLogs logs = small_drive();
  auto& fixes = logs.gnss[0].data.fixes;
  fixes.clear();
  // 5 Hz as of a receiver whose epochs straddle the second: .9 and .1 are equally near, the earlier wins.
  for (int i = 0; i < 18; ++i) fixes.push_back(fix_at(100.9 + 0.2 * i));
  DriveDescription description = small_description();
  description.gnss.resize(1);
  description.gnss.front().period_s = 1;
  PreparedDrive drive = prepare_drive(logs, description);
  REQUIRE(drive.fixes.size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(drive.fixes[i].stamp == Stamp::from_seconds(100.9 + static_cast<double>(i)));
  CHECK(drive.report.fixes_thinned == 14);

  description.gnss.front().period_s = 0.5;
  drive = prepare_drive(logs, description);
  CHECK(drive.fixes.size() == 8);
  CHECK(drive.fixes[1].stamp == Stamp::from_seconds(101.5));
}

TEST_CASE("prepare: every n-th epoch is withheld") {
  DriveDescription description = small_description();
  description.gnss.resize(1);
  description.gnss.front().withhold_every = 3;
  const PreparedDrive drive = prepare_drive(small_drive(), description);
  CHECK(drive.report.fixes_withheld == 2);
  for (const Fix& fix : drive.fixes) {
    const bool withheld = fix.epoch == 2 || fix.epoch == 5;
    CHECK(fix.status == (withheld ? FixStatus::withheld : FixStatus::accepted));
    CHECK((fix.reason == "withheld") == withheld);
  }
}

TEST_CASE("prepare: logs on other scales are converted, which needs dates") {
  DriveLogs logs;
  logs.odometry.assign(1, std::vector<DriveLogs::Log>(1));
  logs.odometry.front().front().scale = TimeScale::gps;
  logs.odometry.front().front().file = "odometry.csv";
  for (int i = 0; i < 30; ++i)
    logs.odometry.front().front().data.odometry.push_back(odometry_at(1'200'000'000 + i));
  logs.gnss.emplace_back();
  logs.gnss[0].scale = TimeScale::utc;
  logs.gnss[0].data.fixes.push_back(fix_at(1'200'000'000 + 315'964'800 - 18 + 5));  // 18 leap seconds in 2018
  const PreparedDrive drive = prepare_drive(logs, small_description());
  CHECK(drive.fixes.at(0).stamp == Stamp::from_seconds(1'200'000'005));

  DriveDescription description = small_description();
  description.time_scale = TimeScale::utc;
  CHECK_THROWS_MATCHES(
      prepare_drive(small_drive(), description), InputError,
      Message("odometry.csv: seconds of week cannot be put onto the scale 'utc' of the drive; state "
              "the log's 'time: {week: ...}'"));
}

TEST_CASE("prepare: what cannot become a drive says why and what to do") {
  DriveLogs logs = small_drive();
  logs.odometry.front().front().data.odometry.resize(1);
  CHECK_THROWS_MATCHES(prepare_drive(logs, small_description()), InputError,
                       Message("odometry.csv: 1 usable odometry samples; at least 2 are needed"));
  logs = small_drive();
  logs.gnss[0].data.fixes.clear();
  CHECK_THROWS_MATCHES(prepare_drive(logs, small_description()), InputError,
                       Message("gnss.csv: the GNSS logs hold no usable fix; a drive needs at least one"));
  logs = small_drive();
  for (GeodeticFix& fix : logs.gnss[0].data.fixes) fix.stamp.nanoseconds += 1'000'000'000'000;
  CHECK_THROWS_MATCHES(prepare_drive(logs, small_description()), InputError,
                       Message("drive.yaml: no fix lies within the odometry: odometry from 100.000000000 s "
                               "to 110.000000000 s, fixes "
                               "from 1101.000000000 s to 1108.000000000 s on the scale 'gps'; check 'time: "
                               "{scale, week, offset}' of "
                               "both logs and 'time: {from, to}'"));
  logs = small_drive();
  logs.truth.emplace_back();
  logs.truth[0].data.truth = {truth_at(90), truth_at(91)};
  CHECK_THROWS_MATCHES(prepare_drive(logs, small_description()), InputError,
                       Message("drive.yaml: the truth does not overlap the odometry: odometry from "
                               "100.000000000 s to 110.000000000 s, "
                               "truth from 90.000000000 s to 91.000000000 s on the scale 'gps'; check 'time: "
                               "{scale, week, offset}' of "
                               "both logs and 'time: {from, to}'"));
  DriveDescription description = small_description();
  description.from_s = 20;
  CHECK_THROWS_AS(prepare_drive(small_drive(), description), InputError);
}

TEST_CASE(
    "prepare: stamps that leap by more than a day are told with their place, unless the window ends before") {
  DriveLogs logs = small_drive();
  std::vector<OdometrySample>& samples = logs.odometry.front().front().data.odometry;
  for (std::size_t i = 91; i < samples.size(); ++i) samples[i].stamp = samples[i].stamp.later(1.7e9);
  CHECK_THROWS_WITH(
      prepare_drive(logs, small_description()),
      StartsWith("odometry.csv: the stamps leap by 1.7e+09 s after 9 s of the log, where 91 of its 101 "
                 "samples have passed"));
  DriveDescription description = small_description();
  description.to_s = 9;
  CHECK(prepare_drive(logs, description).odometry.size() == 91);
}

TEST_CASE("prepare: a place that the UTM zone cannot hold is told with its log, its time and the remedy") {
  DriveLogs logs = small_drive();
  logs.gnss[0].data.fixes[3].longitude_deg = -160;
  CHECK_THROWS_WITH(
      prepare_drive(logs, small_description()),
      StartsWith(
          "gnss.csv: 4.000 s after the start: latitude 50, longitude -160 cannot be projected into UTM zone 33N; "
          "leave the wrong places out"));
  DriveDescription description = small_description();
  description.utm_zone = -56;
  CHECK_THROWS_WITH(
      prepare_drive(small_drive(), description),
      StartsWith("drive.yaml: the first place of the drive: latitude 50, longitude 15 cannot be "
                 "projected into UTM zone 56S; leave the wrong places out"));
}

TEST_CASE("prepare: a delay that is longer than the log is told with its line") {
  DriveDescription description = small_description();
  description.gnss.resize(1);
  description.gnss[0].delay_s = -3600;
  description.gnss[0].delay_place = "drive.yaml:7:10: ";
  CHECK_THROWS_WITH(
      prepare_drive(small_drive(), description),
      StartsWith("drive.yaml:7:10: delay: -3600 s is longer than the odometry, 10 s, and no fix"));
  description = small_description();
  description.odometry.resize(1);
  description.odometry[0].speed_delay_s = 3600;
  description.odometry[0].delay_place = "drive.yaml:3:16: ";
  CHECK_THROWS_WITH(prepare_drive(small_drive(), description),
                    StartsWith("drive.yaml:3:16: speed_delay 3600 s and yaw_rate_delay 0 s leave 0 samples"));
}

TEST_CASE("prepare: reading the logs of a description") {
  DriveDescription description = small_description();
  CHECK_THROWS_MATCHES(load_drive(description, registry_with_readers()), InputError,
                       Message("drive.yaml: no odometry log is named"));
  LogConfig& log = description.odometry.emplace_back().logs.emplace_back();
  log.place = "drive.yaml:2:3: ";
  log.format = "cvs";
  CHECK_THROWS_MATCHES(
      load_drive(description, registry_with_readers()), InputError,
      Message("drive.yaml:2:3: unknown log format 'cvs'; did you mean 'csv'?; `waymark info` lists "
              "all; load the plugin of a format with --plugin"));
}

TEST_CASE("prepare: the real drives that come as configs") {
  struct Expected {
    std::string name;
    int zone;
    std::size_t fixes, odometry;  // at least
  };
  const auto root = waymark_test::examples_dir();
  for (const Expected& expected : {Expected{"berlin_potsdamer_platz", 33, 160, 8400},
                                   {"berlin_gendarmenmarkt", 33, 1100, 29'000},
                                   {"nagoya", 53, 1000, 28'000},
                                   {"aarhus_horsens", 32, 2000, 23'000},
                                   {"munich_2009", 32, 350, 19'000},
                                   {"pittsburgh_i376", 17, 450, 10'000}}) {
    const bool bundled = expected.name == "berlin_potsdamer_platz";
    const auto yaml =
        bundled ? root / expected.name / "drive.yaml" : root / "drives" / (expected.name + ".yaml");
    const auto folder =
        bundled ? (root / expected.name).string() : waymark_test::shared_data("drives/" + expected.name);
    if (!folder) continue;
    INFO(expected.name);
    const PreparedDrive drive =
        load_drive(load_drive_file(yaml.string(), *folder).description, registry_with_readers());
    CHECK(drive.frame.zone == expected.zone);
    CHECK(drive.fixes.size() >= expected.fixes);
    CHECK(drive.odometry.size() >= expected.odometry);
    CHECK(drive.report.odometry.corrupt + drive.report.truth.corrupt == 0);
    CHECK(drive.fixes.front().position.norm() < 71);
  }
}

}  // namespace prepare_test

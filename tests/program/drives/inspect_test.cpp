// `waymark inspect` and `waymark init`: their output and their refusals; the drive.yaml that they write
// runs.
#include <catch2/catch.hpp>

#include <filesystem>
#include <numbers>
#include <regex>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/formats/logs/detail/place/geocentric.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/skip.hpp"

namespace inspect_test {

using Json = nlohmann::json;

namespace {

/// Logs of 40 s on a circle of 200 m at 10 m/s.
std::string drive_folder() {
  const std::string folder = fresh_folder();
  std::filesystem::remove(write_drive(folder));
  return folder;
}

void check_runs(const std::vector<std::string>& logs, double smallest_m, double largest_m) {
  const std::string folder = fresh_folder();
  std::vector<std::string> arguments{"init", "-o", folder + "drive.yaml"};
  arguments.insert(arguments.end(), logs.begin(), logs.end());
  const RunResult init = run(arguments);
  INFO(init.err);
  REQUIRE(init.code == 0);
  CHECK(init.out.empty());
  const RunResult fused = run({"run", folder + "drive.yaml", "-o", folder + "out", "-m", "g2"});
  INFO(fused.err + fused.out);
  REQUIRE(fused.code == 0);
  std::smatch way;
  REQUIRE(std::regex_search(fused.out, way, std::regex(R"((\d+) m by odometry)")));
  CHECK(std::stod(way[1]) > smallest_m);
  CHECK(std::stod(way[1]) < largest_m);
}

}  // namespace

TEST_CASE("inspect: an area that crosses 180 degrees is as wide as the drive") {
  std::string log = "time,latitude,longitude,accuracy\n";
  for (int second = 0; second < 40; ++second)  // 0.04 degrees of longitude at 17 S are 4253 m
    log += std::to_string(second) + ",-17," + (second < 20 ? "179.9" : "-179.9") +
           std::to_string(second < 20 ? 80 + second : 99 - (second - 20)) + ",5\n";
  const RunResult result = run({"inspect", write_text(fresh_folder() + "fiji.csv", log)});
  INFO(result.out);
  CHECK(contains(result.out, "longitude 179.98 .. 180.02 deg: 0 m to the north, 4253 m to the east"));
}

TEST_CASE("inspect: says what is in a log, as text and as JSON") {
  const std::string folder = drive_folder();
  const RunResult text = run({"inspect", folder + "gnss.csv", folder + "odometry.csv"});
  INFO(text.out);
  CHECK(text.code == 0);
  CHECK(text.err.empty());
  for (const char* part : {"gnss.csv\n", "format         csv: a table", "proposed as", "latitude", "  gnss ",
                           "  odometry ", "suspicious"})
    CHECK(contains(text.out, part));
  const RunResult result = run({"inspect", folder + "gnss.csv", folder + "odometry.csv", "--json"});
  const Json json = Json::parse(result.out).at("logs");
  REQUIRE(json.size() == 2);
  CHECK(json.at(0).at("format") == "csv");
  CHECK(json.at(0).at("gnss").at("fixes") == 41);
  CHECK(json.at(0).at("gnss").at("stamps").at("median_interval_s") == Approx(1));
  CHECK(json.at(0).at("odometry").is_null());
  CHECK(json.at(1).at("gnss").is_null());
  CHECK(json.at(1).at("odometry").at("channels").size() == 2);
  CHECK(json.at(1).at("odometry").at("channels").at(0).at("range").at("largest") == Approx(10));
}

TEST_CASE(
    "inspect: inspect and init write the same drive.yaml, tell what was decided, and replace none unasked") {
  const std::string folder = drive_folder();
  const std::vector<std::string> logs{folder + "gnss.csv", folder + "odometry.csv", folder + "truth.csv"};
  std::vector<std::string> arguments{"init"};
  arguments.insert(arguments.end(), logs.begin(), logs.end());
  arguments.insert(arguments.end(), {"-o", folder + "drive.yaml"});
  const RunResult init = run(arguments);
  INFO(init.err);
  CHECK(init.code == 0);
  CHECK(init.out.empty());
  CHECK(contains(init.err, "gnss.csv: gnss: it holds 41 fixes"));
  CHECK(contains(init.err, "odometry.csv: odometry: speed, yaw_rate"));
  CHECK(contains(init.err, "truth.csv: truth: its name says 'truth'"));
  const std::string written = read_text(folder + "drive.yaml");
  CHECK(contains(written, "file: gnss.csv\n"));

  const RunResult again = run(arguments);
  CHECK(again.code == 5);
  CHECK(contains(again.err, "drive.yaml: it exists already; --force replaces it"));
  arguments.emplace_back("--force");
  CHECK(run(arguments).code == 0);
  CHECK(read_text(folder + "drive.yaml") == written);
  CHECK(names_in(folder) == std::vector<std::string>{"drive.yaml", "gnss.csv", "odometry.csv", "truth.csv"});

  const RunResult fused = run({"run", folder + "drive.yaml", "-o", folder + "out", "-m", "g2"});
  INFO(fused.err);
  CHECK(fused.code == 0);
}

TEST_CASE("inspect: init without logs writes a template, and -o - goes to the standard output") {
  const RunResult result = run({"init", "-o", "-"});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "FILL_IN_odometry.csv"));
  CHECK(contains(result.err, "this is a template"));
  const std::string folder = drive_folder();
  const RunResult both = run({"init", folder + "gnss.csv", "-o", "-"});
  CHECK(both.code == 0);
  CHECK(both.out.starts_with("# Proposed by"));
  CHECK(contains(both.err, "no log with odometry was found: fill in odometry"));
}

TEST_CASE("inspect: a folder, and all files of one, go on after what is no log") {
  const std::string folder = drive_folder();
  write_text(folder + "picture.png", "\x89PNG\r\n");
  write_text(folder + "drive.yaml", "odometry: {file: odometry.csv}\n");
  const RunResult whole = run({"inspect", folder});
  INFO(whole.err);
  CHECK(whole.code == 0);
  CHECK(contains(whole.out, folder + "gnss.csv\n"));
  CHECK(contains(whole.err,
                 "picture.png: the log's format is not recognised: it is a picture, which is not "
                 "supported; it holds no log; left out"));
  CHECK(contains(whole.err, "drive.yaml: left out: it describes a drive; inspect it alone"));
  const RunResult listed = run({"init", folder + "drive.yaml", folder + "picture.png", folder + "gnss.csv",
                                folder + "odometry.csv", "-o", "-"});
  CHECK(listed.code == 0);
  CHECK(contains(listed.out, "gnss.csv"));
  check_refused(run({"inspect", folder + "picture.png", folder + "drive.yaml"}), 3,
                "none of the files is a log that is known");
}

TEST_CASE("inspect: inspect and init refuse what they cannot read, with exit code and remedy") {
  const std::string folder = drive_folder();
  check_refused(run({"inspect"}), 2, "logs is required");
  check_refused(run({"inspect", folder + "a.yaml", "--dbc", "car.dbc"}), 2,
                "belong to logs, not to a drive.yaml");
  check_refused(run({"inspect", folder + "nothing.csv"}), 3,
                "nothing.csv: cannot read: No such file or directory");
  check_refused(run({"inspect", write_text(folder + "empty", "")}), 3, "the log is empty");
  check_refused(run({"inspect", write_text(folder + "rubbish", std::string(5000, '\1'))}), 3,
                "format is not recognised");
  check_refused(run({"inspect", folder + "gnss.csv", "--format", "cvs"}), 2,
                "unknown log format 'cvs'; did you mean 'csv'?");
  check_refused(run({"inspect", write_text(folder + "car.dbc", "BO_ 1 A: 8 X\n")}), 2, "name a log too");
  check_refused(run({"init", folder + "gnss.csv"}), 2, "-o is required");
  check_refused(run({"init", folder + "gnss.csv", "-o", folder + "no/drive.yaml"}), 5, "no/drive.yaml");
}

TEST_CASE("inspect: of Aarhus's CAN log names the logger's clock and proposes its signals") {
  const auto drive = waymark_test::shared_data("drives/aarhus_horsens");
  if (!drive) return;
  const RunResult result =
      run({"inspect", *drive + "/candump.log.gz", "--dbc", *drive + "/canmod-gps.dbc", "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out).at("logs").at(0);
  CHECK(json.at("format") == "candump");
  CHECK(json.at("gnss").at("fixes") == 2161);
  CHECK(json.at("without_fix") == 111);
  CHECK(json.at("logger_ahead_s").get<double>() == Approx(4.40).margin(0.01));  // by the data's own README
}

TEST_CASE("inspect: finds Munich's frozen receiver and gpsd's date of another age") {
  const auto logs = waymark_test::shared_data("logs");
  if (!logs) return;
  const RunResult nmea = run({"inspect", *logs + "/nmea/genivi_munich_Petuelring_2009.nmea"});
  CHECK(contains(
      nmea.out, "the position is constant for 5 fixes or more although the receiver's speed is above 1 m/s"));
  const RunResult gpsd = run({"inspect", *logs + "/gpsd/gpsd_neo-m8n.log.chk"});
  CHECK(contains(gpsd.out, "if the receiver is wrong by 1024 weeks, the date is 2015-03-18T17:19:26.000Z"));
  const RunResult nofix = run({"inspect", *logs + "/gpsd/gpsd_bu303-nofix.log.chk"});
  CHECK(nofix.code == 0);
  CHECK(contains(nofix.out, "the receiver has no fix in 7 of 7 records"));
}

TEST_CASE("inspect: init makes drives that run of raw logs: Potsdamer Platz, Nagoya, Aarhus") {
  const std::string bundled = bundled_drive();
  const std::string folder = bundled.substr(0, bundled.rfind('/') + 1);
  check_runs({folder + "odometry_50hz.csv", folder + "gnss_5hz.csv", folder + "truth_5hz.csv"}, 800, 900);
  const auto drives = waymark_test::shared_data("drives");
  const auto logs = waymark_test::shared_data("logs");
  if (!drives || !logs) return;
  check_runs({*drives + "/nagoya/odometry_imitated_25hz.csv", *logs + "/pos/taroz_rover_1Hz_spp.pos"}, 4300,
             4500);
  const std::string aarhus = *drives + "/aarhus_horsens/";
  check_runs(
      {aarhus + "candump.log.gz", aarhus + "canmod-gps.dbc", aarhus + "obd_speed.csv", aarhus + "imu.csv.gz"},
      40e3, 42e3);
}

namespace {

/// A table of fixes that a program wrote in its own way, on the circle of `write_drive`.
struct Dialect {
  const char* name;
  const char* header;
  /// @param second since 12:00:00 UTC of the dialect's day, 2020-09-13
  std::string (*row)(int second, double latitude, double longitude);
};

int whole(double x) {
  return static_cast<int>(x);
}
double minutes(double degrees) {
  return 60 * (degrees - whole(degrees));
}

constexpr double kUnix = 1599998400;  // 2020-09-13T12:00:00Z

const Dialect kDialects[] = {
    {"german spreadsheet", "date;time;latitude;longitude\n",
     [](int s, double lat, double lon) {
       std::string row = fmt::format("13.09.2020;12:00:{:02};{:.9f};{:.9f}", s, lat, lon);
       for (std::size_t i = row.find(';'); i < row.size(); ++i)
         if (row[i] == '.') row[i] = ',';
       return row;
     }},
    {"american dates", "Date,Time,Lat (deg),Lon (deg)\n",
     [](int s, double lat, double lon) {
       return fmt::format("09/13/2020,12:00:{:02} PM,{:.9f},{:.9f}", s, lat, lon);
     }},
    {"days of a spreadsheet", "Time,Latitude,Longitude\n",
     [](int s, double lat, double lon) {
       return fmt::format("{:.10f},{:.9f},{:.9f}", 44087.5 + s / 86400., lat, lon);
     }},
    {"days of MATLAB", "time,lat,lon\n",
     [](int s, double lat, double lon) {
       return fmt::format("{:.9f},{:.9f},{:.9f}", 738047.5 + s / 86400., lat, lon);
     }},
    {"FILETIME", "Timestamp,Latitude,Longitude\n",
     [](int s, double lat, double lon) {
       return fmt::format("{},{:.9f},{:.9f}", 116444736000000000 + (1599998400LL + s) * 10'000'000, lat, lon);
     }},
    {"NMEA's numbers", "UTC date,UTC time,Lat,N/S,Lon,E/W\n",
     [](int s, double lat, double lon) {
       return fmt::format("130920,1200{:02}.00,{:02}{:010.7f},N,{:03}{:010.7f},E", s, whole(lat),
                          minutes(lat), whole(lon), minutes(lon));
     }},
    {"degrees, minutes, seconds", "utc,latitude,longitude\n",
     [](int s, double lat, double lon) {
       const auto text = [](double x, char side) {
         return fmt::format("{}°{}'{:.6f}{}", whole(x), whole(minutes(x)), minutes(minutes(x)), side);
       };
       return fmt::format("2020/09/13 12:00:{:02},{},{}", s, text(lat, 'N'), text(lon, 'E'));
     }},
    {"week and seconds of the week", "gps_week,gps_seconds_of_week,lat,lon\n",
     [](int s, double lat, double lon) {
       return fmt::format("2123,{}.000,{:.9f},{:.9f}", 43218 + s, lat, lon);
     }},
    {"GPS seconds", "gpstime,lat,lon\n",
     [](int s, double lat, double lon) {
       return fmt::format("{:.3f},{:.9f},{:.9f}", kUnix + s - 315964800 + 18, lat, lon);
     }},
    {"rostopic", "%time,field.latitude,field.longitude,field.position_covariance0\n",
     [](int s, double lat, double lon) {
       return fmt::format("{}000000000,{:.9f},{:.9f},25", 1599998400 + s, lat, lon);
     }},
    {"a row of units", "time,lat,lon\nms,rad,rad\n",
     [](int s, double lat, double lon) {
       const double radian = std::numbers::pi / 180;
       return fmt::format("{}000,{:.12f},{:.12f}", 1599998400 + s, lat * radian, lon * radian);
     }},
    {"a month by name", "DateTime,Lat,Lng\n",
     [](int s, double lat, double lon) {
       return fmt::format("13-Sep-2020 12:00:{:02},{:.9f},{:.9f}", s, lat, lon);
     }},
    {"no names", "",
     [](int s, double lat, double lon) { return fmt::format("{},{:.9f},{:.9f}", 1599998400 + s, lat, lon); }},
    {"no names, nanoseconds and a word", "",
     [](int s, double lat, double lon) {
       return fmt::format("{}000000000,{:.9f},{:.9f},D", 1599998400 + s, lat, lon);
     }},
    {"radians that no name tells", "time_unix,latitude,longitude\n",
     [](int s, double lat, double lon) {
       const double radian = std::numbers::pi / 180;
       return fmt::format("{},{:.12f},{:.12f}", 1599998400 + s, lat * radian, lon * radian);
     }},
    {"bagpy", "Time,header.stamp.secs,header.stamp.nsecs,latitude,longitude\n",
     [](int s, double lat, double lon) {
       return fmt::format("{}.0,{},0,{:.9f},{:.9f}", 1599998400 + s, 1599998395 + s, lat, lon);
     }},
    {"trailing separators", "time_unix,lat,lon,,,,\n",
     [](int s, double lat, double lon) {
       return fmt::format("{},{:.9f},{:.9f},,,,", 1599998400 + s, lat, lon);
     }},
    {"seconds and their fractions", "stamp_sec,stamp_nsec,lat,lon\n",
     [](int s, double lat, double lon) {
       return fmt::format("{},0,{:.9f},{:.9f}", 1599998400 + s, lat, lon);
     }},
    {"titles, settings, units and sources",
     "Session of a logger ( http://example.org/ )\nLaps,3\ntime_unix,lat,lon,v\ns,deg,deg,m/s\n,100: gps,100: gps,\n",
     [](int s, double lat, double lon) {
       return fmt::format("{},{:.9f},{:.9f},10", 1599998400 + s, lat, lon);
     }},
    {"a separator that is stated", "sep=;\ntime_unix;lat;lon\n",
     [](int s, double lat, double lon) { return fmt::format("{};{:.9f};{:.9f}", 1599998400 + s, lat, lon); }},
    {"Earth-centred",
     "time_unix,SvPositionXEcefMeters,WlsPositionXEcefMeters,WlsPositionYEcefMeters,WlsPositionZEcefMeters\n",
     [](int s, double lat, double lon) {
       const Eigen::Vector3d ecef = waymark::formats::ecef_from_geodetic({lat, lon, 300});
       return fmt::format("{},1e7,{:.4f},{:.4f},{:.4f}", 1599998400 + s, ecef.x(), ecef.y(), ecef.z());
     }},
    {"a velocity, and numbers for nothing", "time_unix,lat,lon,vel_north,vel_east,hdop,heading_acc\n",
     [](int s, double lat, double lon) {
       return fmt::format("{},{:.9f},{:.9f},10,0.001,{},{}", 1599998400 + s, lat, lon,
                          s % 7 == 0 ? 9999. : 0.9, s % 5 == 0 ? -999 : 1.5);
     }},
    {"topics before the members", "__time,/fix/latitude,/fix/longitude\n",
     [](int s, double lat, double lon) {
       return fmt::format("{}.0,{:.9f},{:.9f}", 1599998400 + s, lat, lon);
     }},
    {"two receivers", "time_unix,receiver,lat,lon\n",
     [](int s, double lat, double lon) {
       return fmt::format("{0},front,{1:.9f},{2:.9f}\n{0},rear,{3:.9f},{2:.9f}", 1599998400 + s, lat, lon,
                          lat + 0.01);
     }},
};

/// Proposes a drive from two logs and fuses it as it is.
RunResult fused_after_init(const std::string& folder, const std::string& first, const std::string& second) {
  const RunResult init = run({"init", folder + first, folder + second, "-o", folder + "drive.yaml"});
  INFO(init.err);
  REQUIRE(init.code == 0);
  RunResult fused = run({"run", folder + "drive.yaml", "-o", folder + "out", "-m", "g2"});
  INFO(fused.err);
  REQUIRE(fused.code == 0);
  return fused;
}

}  // namespace

TEST_CASE("init: tables in the dialects of this world give the same fixes, at the same instants") {
  for (const Dialect& dialect : kDialects) {
    INFO(dialect.name);
    const std::string folder = fresh_folder();
    std::string fixes = dialect.header;
    std::string odometry = "time_unix,speed_mps,yaw_rate_radps\n";
    for (int s = 0; s < 40; ++s) {  // 10 m/s to the north
      fixes += dialect.row(s, 48.1 + s * 10 / 111200., 11.2 + (s % 2) * 1e-7) + "\n";
      for (int i = 0; i < 10; ++i) odometry += fmt::format("{:.1f},10,0\n", kUnix + s + 0.1 * i);
    }
    write_text(folder + "fixes.csv", fixes);
    write_text(folder + "odometry.csv", odometry);
    const RunResult fused = fused_after_init(folder, "fixes.csv", "odometry.csv");
    INFO(fused.err + fused.out);
    CHECK(contains(fused.out, "399 m by odometry"));
    CHECK(contains(fused.out, "40 fixes"));
    CHECK(contains(fused.out, "0 fixes outside the odometry"));
  }
}

TEST_CASE("init: a trace of CAN, a phone's log and a VBO file are a drive without a word typed") {
  // Minute 0 of 2020-09-13 12:00 UTC; 36 km/h to the north, by OBD (24 hex) and a J1939 yaw rate of 0.
  std::string trace = "date Sun Sep 13 12:00:00.000 pm 2020\nbase hex  timestamps absolute\n";
  std::string phone =
      "# Header Description:\n# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AccuracyMeters,UnixTimeMillis\n";
  std::string race =
      "File created on 13/09/2020 at 12:00:00\n[header]\ntime\n[column names]\nsats time lat long\n[data]\n";
  for (int s = 0; s < 40; ++s) {
    const double latitude = 48.1 + s * 10 / 111200.;
    phone += fmt::format("Raw,1\nFix,GPS,{:.9f},11.2,4,{}440\n", latitude, 1599998400 + s);
    race += fmt::format("008 1200{:02}.44 {:+012.7f} -00672.00000\n", s, 60 * latitude);
    for (int i = 0; i < 10; ++i)
      trace += fmt::format(
          "{0:11.6f} 1  7E8  Rx   d 8 03 41 0D 24 00 00 00 00\n"
          "{0:11.6f} 1  18F0090Bx  Rx   d 8 FF FF FF 71 7D FF FF FF\n",
          s + 0.1 * i);
  }
  for (const auto& [name, fixes] : {std::pair{"phone.txt", phone}, std::pair{"race.vbo", race}}) {
    INFO(name);
    const std::string folder = fresh_folder();
    write_text(folder + "trace.asc", trace);
    write_text(folder + name, fixes);
    const RunResult fused = fused_after_init(folder, "trace.asc", name);
    INFO(fused.err + fused.out);
    CHECK(contains(fused.out, "399 m by odometry"));
    CHECK(contains(fused.out, "40 fixes"));
  }
}

TEST_CASE("init: a table of GPS seconds without a name for them takes its epoch from the other log") {
  const std::string folder = fresh_folder();
  std::string fixes = "time_utc,lat,lon\n";
  std::string odometry = "time_s,speed,yaw_rate\n";
  for (int s = 0; s < 40; ++s) {
    fixes += fmt::format("{},{:.9f},11.2\n", 1599998400 + s, 48.1 + s * 10 / 111200.);
    for (int i = 0; i < 10; ++i)
      odometry += fmt::format("{:.1f},10,0\n", 1599998400. - 315964800 + 18 + s + 0.1 * i);
  }
  write_text(folder + "fixes.csv", fixes);
  write_text(folder + "odometry.csv", odometry);
  REQUIRE(run({"init", folder + "fixes.csv", folder + "odometry.csv", "-o", folder + "drive.yaml"}).code ==
          0);
  CHECK(contains(read_text(folder + "drive.yaml"), "CHECK: its numbers are GPS seconds since 1980"));
  CHECK(contains(run({"run", folder + "drive.yaml", "-o", folder + "out"}).out, "40 fixes"));
}

TEST_CASE(
    "init: numbers that mean 'not known', wheels in rad/s and fractions of seconds are proposed as keys") {
  const std::string folder = fresh_folder();
  std::string fixes = "stamp_sec,stamp_nsec,lat,lon,speed [km/h]\n";
  std::string wheels = "time_unix,wheel_speed_rl [rad/s],wheel_speed_rr [rad/s],yaw_rate\n";
  for (int s = 0; s < 40; ++s) {
    fixes += fmt::format("{},{},{:.9f},11.2,{}\n", 1599998400 + s, 250'000'000, 48.1 + s * 9 / 111200.,
                         s % 8 == 0 ? 999 : 32.4);
    for (int i = 0; i < 10; ++i)
      wheels += fmt::format("{:.1f},30,30,{}\n", kUnix + s + 0.1 * i, i == 3 ? -9999 : 0.001 * i);
  }
  write_text(folder + "fixes.csv", fixes);
  write_text(folder + "wheels.csv", wheels);
  const RunResult fused = fused_after_init(folder, "fixes.csv", "wheels.csv");
  const std::string yaml = read_text(folder + "drive.yaml");
  INFO(yaml);
  CHECK(contains(yaml, "time_fraction: {column: stamp_nsec, unit: ns}"));
  CHECK(contains(yaml, "unit: km/h, missing: 999}"));
  CHECK(contains(yaml, "{column: \"wheel_speed_rl [rad/s]\", scale: 0.3}"));
  CHECK(contains(yaml, "yaw_rate: {column: yaw_rate, missing: -9999}"));
  CHECK(contains(fused.out, "359 m by odometry"));  // 30 rad/s of 0.3 m for 39.9 s
}

TEST_CASE("init: metres in a plane are named with the keys to state") {
  const std::string folder = fresh_folder();
  std::string fixes = "t_unix,x,y\n";
  for (int s = 0; s < 40; ++s) fixes += fmt::format("{},{},{}\n", 1599998400 + s, 10 * s, 2 * s);
  write_text(folder + "fixes.csv", fixes);
  const RunResult init = run({"init", folder + "fixes.csv", "-o", "-"});
  CHECK(contains(init.err, "column 'x' may be metres: state 'easting: x', 'northing: y' under columns"));
}

}  // namespace inspect_test

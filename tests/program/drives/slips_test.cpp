// Slips that a newcomer makes: wrong units and clocks at any rate of the fixes, inputs named as outputs. A
// minimum is found for most of them; the program must say that it is not to be believed.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace slips_test {

namespace {

/// The bundled drive's logs with all fixes (5 Hz), its odometry changed in each row.
std::string drive_with(const std::string& folder,
                       const std::function<std::string(double, double, double)>& row) {
  const std::string data = waymark_test::source_dir() + "/examples/berlin_potsdamer_platz/";
  std::istringstream log(read_text(data + "odometry_50hz.csv"));
  std::string text = "time,speed,yaw_rate\n";
  for (std::string line; std::getline(log, line);) {
    double time = 0, speed = 0, yaw_rate = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &time, &speed, &yaw_rate) == 3)
      text += row(time, speed, yaw_rate);
  }
  write_text(folder + "odometry.csv", text);
  return write_text(folder + "drive.yaml",
                    "odometry: {file: odometry.csv, time: {week: 1900}}\n"
                    "gnss: {file: " +
                        data +
                        "gnss_5hz.csv, time: {week: 1900}, columns: {time: gps_sow_s, latitude: lat_deg, "
                        "longitude: lon_deg, accuracy: hacc_m_first_60s_only}, accuracy: {meaning: drms, "
                        "default_sigma: 5}}\n"
                        "truth: {file: " +
                        data +
                        "truth_5hz.csv, time: {week: 1900}, columns: {time: gps_sow_s, latitude: lat_deg, "
                        "longitude: lon_deg}}\n");
}

std::string line(double time, double speed, double yaw_rate) {
  char text[96];
  std::snprintf(text, sizeof text, "%.3f,%.6f,%.8f\n", time, speed, yaw_rate);
  return text;
}

}  // namespace

TEST_CASE("slips: a sound drive with fixes at 5 Hz is not doubted") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"run", drive_with(folder, line), "-o", folder + "out"});
  CHECK(result.code == 0);
  CHECK_FALSE(contains(result.err, "warning"));
}

TEST_CASE("slips: a speed in km/h refuses the drive, and nothing is written") {
  const std::string folder = fresh_folder();
  const std::string drive =
      drive_with(folder, [](double t, double v, double w) { return line(t, 3.6 * v, w); });
  const RunResult result = run({"run", drive, "-o", folder + "out"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, drive + ": the odometry does not fit the fixes (0 of "));
  CHECK(contains(result.err, "km/h read as m/s: state 'unit: km/h' of the speed"));
  CHECK_FALSE(std::filesystem::exists(folder + "out"));
}

TEST_CASE("slips: a scale of the speed that is wrong by tens of percent is told, found and costs little") {
  const std::string folder = fresh_folder();
  for (const double factor : {0.7, 1.4, 2.5}) {
    INFO("factor " << factor);
    const std::string drive =
        drive_with(folder, [&](double t, double v, double w) { return line(t, factor * v, w); });
    const RunResult result = run({"run", drive, "-o", folder + "out"});
    CHECK(result.code == 0);
    CHECK(contains(result.err, "warning: the odometry's distance"));
    const nlohmann::json metrics = nlohmann::json::parse(read_text(folder + "out/metrics.json"));
    const nlohmann::json& truth = metrics["evaluations"][0]["truth"];
    CHECK(truth["fused"]["position"]["rmse_m"].get<double>() <
          0.6 * truth["gnss"]["position"]["rmse_m"].get<double>());
  }
}

TEST_CASE("slips: a yaw rate of the wrong sign refuses the drive at 5 Hz too") {
  const std::string folder = fresh_folder();
  const std::string drive = drive_with(folder, [](double t, double v, double w) { return line(t, v, -w); });
  const RunResult result = run({"run", drive, "-o", folder + "out"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "state 'convention: cw' of the yaw rate"));
}

TEST_CASE("slips: a yaw rate in deg/s read as rad/s, and the reverse, refuse the drive") {
  const std::string folder = fresh_folder();
  const std::string fast =
      drive_with(folder, [](double t, double v, double w) { return line(t, v, 57.29578 * w); });
  const RunResult large = run({"convert", fast, "-o", folder + "a.graph"});
  CHECK(large.code == 3);
  CHECK(contains(large.err, "deg/s read as rad/s: state 'unit: deg/s' of the yaw rate"));
  const std::string slow =
      drive_with(folder, [](double t, double v, double w) { return line(t, v, 0.01745329 * w); });
  const RunResult small = run({"convert", slow, "-o", folder + "a.graph"});
  CHECK(small.code == 3);
  CHECK(contains(small.err, "rad/s read as deg/s: state 'unit: rad/s' of the yaw rate"));
}

TEST_CASE("slips: a gyro that is dead leaves positions as good as those of the receiver, and is told") {
  const std::string folder = fresh_folder();
  REQUIRE(
      run({"simulate", "--preset", "urban", "--seed", "4", "--duration", "600", "-o", folder, "-q"}).code ==
      0);
  std::istringstream rows(read_text(folder + "odometry.csv"));
  std::string text;
  for (std::string row; std::getline(rows, row);) {
    double time = 0, speed = 0;
    text += std::sscanf(row.c_str(), "%lf,%lf", &time, &speed) == 2 ? line(time, speed, 0) : row + "\n";
  }
  write_text(folder + "odometry.csv", text);
  const RunResult result = run({"run", folder + "drive.yaml", "-o", folder + "out"});
  CHECK(result.code == 0);
  CHECK_FALSE(contains(result.err, "the fixes jump"));  // they do at its bends
  CHECK(contains(result.err, "the estimate of constant_twist heading_variance_per_s is"));
  const nlohmann::json metrics = nlohmann::json::parse(read_text(folder + "out/metrics.json"));
  const nlohmann::json& truth = metrics["evaluations"][0]["truth"];
  CHECK(truth["fused"]["position"]["rmse_m"].get<double>() <
        truth["gnss"]["position"]["rmse_m"].get<double>());
}

TEST_CASE(
    "slips: accuracies that are stated far too small or too large are named by the residuals, per modeling") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "120", "--seed", "7", "-o", folder}).code == 0);
  const auto with_accuracy = [&](const std::string& name, const std::string& column) {
    std::string text = "time,latitude,longitude,accuracy\n";
    std::istringstream truth(read_text(folder + "truth.csv"));
    int row = 0;
    for (std::string of; std::getline(truth, of);) {
      double time = 0, latitude = 0, longitude = 0;
      if (std::sscanf(of.c_str(), "%lf,%lf,%lf", &time, &latitude, &longitude) != 3 || row++ % 5 != 0)
        continue;
      // Errors of 2 m to and fro.
      char line[128];
      std::snprintf(line, sizeof line, "%.3f,%.9f,%.9f,%s\n", time, latitude + (row % 3 - 1) * 2.4e-5,
                    longitude, column.c_str());
      text += line;
    }
    write_text(folder + "gnss.csv", text);
    return write_text(folder + name,
                      "time: {scale: gps}\nodometry: {file: odometry.csv}\n"
                      "gnss: {file: gnss.csv, accuracy: {meaning: 1sigma}}\n");
  };
  const RunResult small =
      run({"run", with_accuracy("small.yaml", "0.05"), "-o", folder + "small", "-m", "g1,correlated"});
  CHECK(contains(small.err, "warning: g1: the residuals of the accepted fixes are "));
  CHECK(contains(small.err, "2 is expected): the accuracies are stated too small"));
  CHECK_FALSE(contains(small.err, "correlated: the residuals"));
  CHECK(contains(run({"run", with_accuracy("large.yaml", "50"), "-o", folder + "large", "-m", "g1"}).err,
                 "the accuracies are stated too large"));
  CHECK_FALSE(contains(run({"run", with_accuracy("right.yaml", "2"), "-o", folder + "right", "-m", "g1"}).err,
                       "the residuals of the accepted fixes"));
}

TEST_CASE("slips: a truth that cannot be projected is explained by what is written wrong") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "60", "--seed", "7", "-o", folder}).code == 0);
  std::string drive = read_text(folder + "drive.yaml");
  const std::size_t at = drive.find("latitude: latitude_deg, longitude: longitude_deg");
  REQUIRE(at != std::string::npos);
  drive.replace(at, 48, "latitude: longitude_deg, longitude: latitude_deg");
  const RunResult result = run({"run", write_text(folder + "drive.yaml", drive), "-o", folder + "out"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "in one of them latitude and longitude are exchanged"));
}

TEST_CASE("slips: odometry that reads 0 for 30 s of driving is replaced, told once and in the report") {
  const std::string folder = fresh_folder();
  const std::string drive = drive_with(folder, [](double t, double v, double w) {
    const bool frozen = t > 126700 && t < 126730;
    return line(t, frozen ? 0 : v, frozen ? 0 : w);
  });
  const RunResult result = run({"run", drive, "-o", folder + "out", "-m", "g1,correlated"});
  const std::string said = "the odometry repeats 0 m/s and its yaw rate";
  CHECK(contains(result.err, said));
  CHECK(result.err.find(said) == result.err.rfind(said));
  CHECK(contains(read_text(folder + "out/correlated.html"), said));
  CHECK(contains(read_text(folder + "out/g1.fused.graph"), said));
}

TEST_CASE("slips: a scale error of 5 % is named on a drive of one minute, and no scale is on a sound one") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "rural", "--duration", "60", "--seed", "3", "-o", folder}).code == 0);
  const RunResult sound = run({"run", folder + "drive.yaml", "-o", folder + "sound"});
  CHECK_FALSE(contains(sound.err, "speed_scale"));
  std::istringstream log(read_text(folder + "odometry.csv"));
  std::string slow;
  for (std::string row; std::getline(log, row);) {
    double time = 0, speed = 0, yaw_rate = 0;
    const bool is_sample = std::sscanf(row.c_str(), "%lf,%lf,%lf", &time, &speed, &yaw_rate) == 3;
    slow += is_sample ? line(time, 0.95 * speed, yaw_rate) : row + "\n";
  }
  write_text(folder + "odometry.csv", slow);
  const RunResult result = run({"run", folder + "drive.yaml", "-o", folder + "slow"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "warning: the estimate of speed_scale begins at 0.04"));
  CHECK(contains(result.err, "which its prior (0.01) does not expect"));
}

TEST_CASE("slips: a hole in the odometry is told with its place and length") {
  const std::string folder = fresh_folder();
  const std::string drive = drive_with(folder, [](double t, double v, double w) {
    return t > 126700 && t < 126730 ? std::string() : line(t, v, w);
  });
  const RunResult result = run({"convert", drive, "-o", folder + "a.graph"});
  CHECK(contains(result.err,
                 "the odometry has no samples for more than 0.5 s in 1 place, the longest for 30.0 s"));
  CHECK(contains(result.err, "(gap: {policy: bridge})"));
  CHECK(contains(result.err, "the motion of the fixes is assumed in 1 of these places"));
}

TEST_CASE(
    "slips: clocks that are right within three sigmas are not moved by --sync, and one log is not torn "
    "apart") {
  const std::string folder = fresh_folder();
  const std::string late = drive_with(folder, [](double t, double v, double w) { return line(t + 2, v, w); });
  const RunResult moved = run({"convert", late, "--sync", "-o", folder + "late.graph"});
  CHECK(contains(moved.err, "the odometry's speed was late by"));
  CHECK(contains(moved.err, "the odometry's yaw rate was late by"));
  const std::string straight =
      drive_with(folder, [](double t, double v, double) { return line(t + 2, v, 0); });
  CHECK(contains(run({"convert", straight, "--sync", "-o", folder + "straight.graph"}).err,
                 "yaw rate and speed are of one clock; both are moved together"));
  const RunResult sound = run({"convert", drive_with(folder, line), "--sync", "-o", folder + "sound.graph"});
  CHECK(contains(sound.err, "within what smoothing and three sigmas explain, so not applied"));
  CHECK_FALSE(contains(sound.err, "; applied"));
}

namespace {

/// A simulated drive whose odometry has another clock.
std::string drive_off_by(const std::string& folder, double seconds) {
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "300", "--seed", "7", "-o", folder + "drive"})
              .code == 0);
  std::istringstream log(read_text(folder + "drive/odometry.csv"));
  std::string text;
  for (std::string row; std::getline(log, row);) {
    double time = 0, speed = 0, yaw_rate = 0;
    if (std::sscanf(row.c_str(), "%lf,%lf,%lf", &time, &speed, &yaw_rate) == 3)
      text += line(time + seconds, speed, yaw_rate);
    else
      text += row + "\n";
  }
  write_text(folder + "drive/odometry.csv", text);
  return folder + "drive/drive.yaml";
}

}  // namespace

TEST_CASE("slips: an odometry whose clock, sign or unit is wrong is named and left out if another one fits") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "two-odometries", "--duration", "300", "--seed", "3", "-o",
               folder + "drive"})
              .code == 0);
  const auto fused_with = [&](const std::string& of, double late_s, double scale, double sign,
                              std::vector<std::string> more = {}) {
    const std::string file = folder + "drive/" + of + ".csv";
    const std::string log = read_text(file);
    std::istringstream rows(log);
    std::string text;
    for (std::string row; std::getline(rows, row);) {
      double time = 0, speed = 0, yaw_rate = 0;
      if (std::sscanf(row.c_str(), "%lf,%lf,%lf", &time, &speed, &yaw_rate) == 3)
        text += line(time + late_s, scale * speed, sign * yaw_rate);
      else
        text += row + "\n";
    }
    write_text(file, text);
    more.insert(more.begin(), {"run", folder + "drive/drive.yaml", "-o", folder + "out", "--json"});
    const RunResult result = run(more);
    write_text(file, log);
    REQUIRE(result.code == 0);
    const nlohmann::json position =
        nlohmann::json::parse(read_text(folder + "out/metrics.json"))["evaluations"][0]["truth"]["fused"];
    return std::pair(result.err, position["position"]["rmse_m"].get<double>());
  };
  const auto [sound, sound_m] = fused_with("visual", 0, 1, 1);
  CHECK_FALSE(contains(sound, "warning: visual"));
  CHECK_FALSE(contains(sound, "left out"));

  const auto [late, without_visual_m] = fused_with("visual", 0.7, 1, 1);
  CHECK(contains(late, "warning: visual's clock seems 0.7"));
  CHECK(contains(late, "for its log, or --sync. It is left out; wheels fits"));
  const auto [turned, turned_m] = fused_with("visual", 0, 1, -1);
  CHECK(contains(turned, "warning: visual: the odometry does not fit the fixes ("));
  CHECK(turned_m == Approx(without_visual_m).epsilon(1e-6));
  const auto [mended, mended_m] = fused_with("visual", 0.7, 1, 1, {"--sync"});
  CHECK_FALSE(contains(mended, "left out; wheels"));
  CHECK(mended_m == Approx(sound_m).epsilon(0.03));
  const nlohmann::json each =
      nlohmann::json::parse(run({"sync", folder + "drive/drive.yaml", "--json"}).out)["odometries"];
  REQUIRE(each.size() == 2);
  CHECK(each[1]["name"] == "visual");
  CHECK(each[1]["yaw_rate"]["late_s"].get<double>() == Approx(0).margin(0.05));

  // The nodes come from wheels.
  const auto [fast, without_wheels_m] = fused_with("wheels", 0, 3.6, 1);
  CHECK(contains(fast, "(km/h read as m/s: state 'unit: km/h' of the speed). It is left out"));
  CHECK(contains(fast, "It is left out; visual fits"));
  CHECK(without_wheels_m < 1.5 * sound_m);
  const auto [hour, hour_m] = fused_with("wheels", 3600, 1, 1);
  CHECK(contains(hour, "1 h of a time zone"));
  CHECK(hour_m == Approx(without_wheels_m).epsilon(1e-6));
}

TEST_CASE("slips: a truth of another point of the vehicle is told with its place") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "300", "--seed", "7", "-o", folder + "drive"})
              .code == 0);
  // Fixes that are the truth: what is left is the point.
  const std::string drive = folder + "drive/drive.yaml";
  const auto with_truth = [&](const std::string& keys) {
    write_text(drive,
               "time: {scale: gps}\n"
               "odometry: {file: odometry.csv, columns: {time: time_s, speed: speed_mps, yaw_rate: "
               "yaw_rate_radps}}\n"
               "gnss: {file: truth.csv, columns: {time: time_s, latitude: latitude_deg, longitude: "
               "longitude_deg}, accuracy: {default_sigma: 0.02}}\n"
               "truth: {file: truth.csv, columns: {time: time_s, latitude: latitude_deg, longitude: "
               "longitude_deg, heading: heading_rad}" +
                   keys + "}\n");
    return run({"run", drive, "-o", folder + "out"});
  };
  const RunResult same = with_truth("");
  CHECK_FALSE(contains(same.err, "the truth is always"));
  CHECK(contains(same.out, "Fused positions are not comparable with raw GNSS"));
  CHECK_FALSE(contains(same.out, "Worse:"));
  // the true point is taken for one 1.5 m ahead of it and 0.6 m to its right
  CHECK(contains(
      with_truth(", reference: [1.5, -0.6]").err,
      "the truth is always 1.50 m behind the fused position and 0.60 m to its left: if it is that of "
      "another point of the vehicle, state 'truth: {reference: [-1.50, 0.60]}'"));
}

namespace {

/// Returns by how much a fusion says that it moved the odometry, s; 0: by nothing.
double moved_s(const std::string& messages) {
  constexpr std::string_view kWords = "the odometry is probably late: its readings are moved by that; add -";
  const std::size_t at = messages.find(kWords);
  return at == std::string::npos ? 0 : std::stod(messages.substr(at + kWords.size()));
}

}  // namespace

TEST_CASE("slips: a clock off by 1 s or by leap seconds is named before the fusion, and --sync mends it") {
  const std::string folder = fresh_folder();
  const RunResult second = run({"run", drive_off_by(folder, 1), "-o", folder + "out"});
  CHECK(moved_s(second.err) == Approx(1).margin(0.1));
  CHECK_FALSE(
      contains(second.err, "the odometry's clock seems"));  // the fusion knows it better, and tells it

  const std::string third = run({"run", drive_off_by(folder, 0.3), "-o", folder + "out"}).err;
  CHECK(moved_s(third) == Approx(0.3).margin(0.1));
  CHECK_FALSE(contains(third, "the odometry's clock seems"));
  const std::string early = run({"run", drive_off_by(folder, -0.4), "-o", folder + "out"}).err;
  CHECK(contains(early, "warning: the odometry's clock seems 0.40 +- 0.05 s early against the fixes"));
  CHECK(contains(early, "state 'delay: 0.40' for the receiver if its fixes come late"));
  CHECK_FALSE(contains(run({"run", drive_off_by(folder, 0.1), "-o", folder + "out"}).err, "warning"));

  const std::string drive = drive_off_by(folder, 18);
  const RunResult leap = run({"run", drive, "-o", folder + "out"});
  CHECK(contains(leap.err,
                 "the odometry's clock seems 17.99 +- 0.05 s late against the fixes, 18 leap seconds (GPS "
                 "time against UTC), correlation 0.997: its stamps are moved by that; state 'time: {offset: "
                 "-17.99}'"));
  CHECK_FALSE(contains(leap.err, "times as far from the truth"));
  const RunResult mended = run({"run", drive, "--sync", "-o", folder + "out"});
  CHECK(contains(mended.err, "speed was late by 17.998 s, 18 leap seconds (GPS time against UTC)"));
  CHECK_FALSE(contains(mended.err, "warning"));
}

TEST_CASE(
    "slips: a stretch of a sound drive, with an odometry that is silent at times, shows no other clock") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "two-odometries", "--duration", "900", "-o", folder}).code == 0);
  const std::string whole = read_text(folder + "drive.yaml");
  // The wheels begin at rest, are silent from 17 to 68 s, and go on at a constant speed.
  for (const char* stretch : {"from: 0, to: 90", "from: 0, to: 200", "from: 450, to: 540"}) {
    CAPTURE(stretch);
    std::string text = whole;
    text.replace(text.find("{scale: gps}"), 1, "{" + std::string(stretch) + ", ");
    write_text(folder + "drive.yaml", text);
    const RunResult result = run({"run", folder + "drive.yaml", "-o", folder + "out"});
    INFO(result.err);
    CHECK(result.code == 0);
    CHECK_FALSE(contains(result.err, "clock"));
    CHECK_FALSE(contains(result.err, "left out"));
  }
}

TEST_CASE(
    "slips: logs whose clocks have nothing in common are refused with the offset, and --sync joins them") {
  const std::string folder = fresh_folder();
  for (const auto& [seconds, name] :
       {std::pair{3600.0, "3600.00 s late, 1 h of a time zone"},
        {315964782.0, "s late, the GPS epoch against the Unix epoch and 18 leap"},
        {-1299834018.0, "the odometry's clock is 1299834018.00 s early: --sync"}}) {
    const std::string drive = drive_off_by(folder, seconds);
    const RunResult apart = run({"run", drive, "-o", folder + "out"});
    INFO(apart.err);
    CHECK(apart.code == 3);
    CHECK(contains(apart.err, "294 of 294 fixes lie outside the odometry: odometry from "));
    CHECK(contains(apart.err, name));
    const RunResult joined = run({"run", drive, "--sync", "-o", folder + "out"});
    CHECK(joined.code == 0);
    CHECK_FALSE(contains(joined.err, "warning"));
  }
}

TEST_CASE("slips: no command overwrites what it reads, and simulate no drive that it did not make") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  const std::string log = read_text(folder + "gnss.csv");
  for (const std::string& output : {drive, folder + "gnss.csv"}) {
    const RunResult result = run({"convert", drive, "-o", output});
    CHECK(result.code == 2);
    CHECK(contains(result.err, output + ": is read as an input and would be overwritten"));
  }
  const RunResult simulated = run({"simulate", "--preset", "urban", "--duration", "60", "-o", folder});
  CHECK(simulated.code == 2);
  CHECK(contains(simulated.err, "drive.yaml: exists and was not written by simulate"));
  CHECK(read_text(folder + "gnss.csv") == log);
  const std::vector<std::string> again = {"simulate", "--preset", "urban",        "--duration",
                                          "60",       "-o",       folder + "made"};
  CHECK(run(again).code == 0);
  CHECK(run(again).code == 0);  // its own may be replaced
}

TEST_CASE("slips: fixes at latitude 0, longitude 0 are left out and counted") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  std::string log = read_text(folder + "gnss.csv");
  const std::size_t second = log.find('\n', log.find('\n') + 1) + 1;
  const std::string row = log.substr(second, log.find('\n', second) - second);
  const std::string time = row.substr(0, row.find(','));
  const std::size_t commas = static_cast<std::size_t>(std::count(row.begin(), row.end(), ','));
  std::string zeros = time;
  for (std::size_t i = 0; i < commas; ++i) zeros += i < 2 ? ",0" : ",1";
  write_text(folder + "gnss.csv", log.replace(second, row.size(), zeros));
  const RunResult result = run({"convert", drive, "-o", folder + "a.graph"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "1 fixes at latitude 0, longitude 0 are left out"));
}

TEST_CASE("slips: wheels that lock for a second and a speed that repeats itself cost little") {
  struct Fault {
    const char* warning;  // nullptr: none is expected
    double from_s;        // of the drive at speed
    double length_s;
    double most;  // error over that of the sound drive
    std::function<double(double held, double speed)> speed;
  };
  const std::vector<Fault> faults = {
      {nullptr, 0, 0, 0, [](double, double speed) { return speed; }},
      {"leaps away and back faster than a vehicle accelerates, in 1 place", 5, 1, 1.15,
       [](double, double speed) { return 0.1 * speed; }},
      // the fixes of the canyon that stand in move by 10 m
      {"the odometry repeats", 5, 8, 2.5, [](double held, double) { return held; }},
  };
  double sound_m = 0;
  for (const Fault& fault : faults) {
    const std::string folder = fresh_folder();
    double begin = 0;
    double fast_since = 0;
    double held = 0;
    const std::string drive = drive_with(folder, [&](double time, double speed, double yaw_rate) {
      constexpr double kFast = 6;
      if (speed < kFast) fast_since = time;
      if (begin == 0 && fast_since > 0 && time - fast_since >= fault.from_s) {
        begin = time;
        held = speed;
      }
      const bool is_wrong = begin > 0 && time < begin + fault.length_s;
      return line(time, is_wrong ? fault.speed(held, speed) : speed, yaw_rate);
    });
    REQUIRE(begin > 0);
    const auto result = run({"run", drive, "--out", folder + "r"});
    REQUIRE(result.code == 0);
    const auto metrics = nlohmann::json::parse(read_text(folder + "r/metrics.json"));
    const double rmse_m = metrics["evaluations"][0]["truth"]["fused"]["position"]["rmse_m"];
    INFO(rmse_m << " m of " << sound_m << " m: " << result.err);
    if (fault.warning == nullptr) {
      sound_m = rmse_m;
    } else {
      CHECK(contains(result.err, fault.warning));
      CHECK(rmse_m < fault.most * sound_m);
    }
  }
}

}  // namespace slips_test

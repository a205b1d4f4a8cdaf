// Further sensors from the front door: a drive.yaml with `sensors` and their logs, run by the program.
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace sensors_test {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
// The drive of write_drive: a circle of 200 m to the left at 10 m/s, heading true east at 1000 s.
constexpr double kYawRate = 0.05;
constexpr double kRadius = 200;

/// Rows of a log at every second: time, then the text of `row`.
template <typename Row>
void write_log(const std::string& file, const std::string& header, const Row& row) {
  std::ostringstream text;
  text.precision(12);
  text << header << "\n";
  for (int t = 1; t < 39; ++t) text << 1000 + t << row(t) << "\n";
  write_text(file, text.str());
}

std::string write_sensor_drive(const std::string& folder, const std::string& sensors,
                               const std::string& more = "") {
  return write_drive(folder, {.more_yaml = "sensors:\n" + sensors + more + "modeling: g1\n"});
}

/// The numbers behind the tag of every edge of a type in a graph file.
std::vector<std::vector<double>> edges(const std::string& file, const std::string& tag) {
  std::vector<std::vector<double>> found;
  std::istringstream text(read_text(file));
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with(tag + " ")) continue;
    std::istringstream words(line.substr(tag.size()));
    std::vector<double>& numbers = found.emplace_back();
    for (double number; words >> number;) numbers.push_back(number);
  }
  return found;
}

/// Converts the drive and reads the edges of a type back.
std::vector<std::vector<double>> converted(const std::string& folder, const std::string& tag) {
  const auto result = run({"convert", folder + "drive.yaml", "-o", folder + "out.graph", "-q"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  return edges(folder + "out.graph", tag);
}

void check_refused(const std::string& folder, const std::string& message) {
  const auto result = run({"convert", folder + "drive.yaml", "-o", folder + "out.graph"});
  INFO(result.err);
  CHECK(result.code == 3);
  CHECK(contains(result.err, message));
  CHECK_FALSE(exists(folder + "out.graph"));
}

/// run ends at a minimum; returns its messages.
std::string ran(const std::string& folder) {
  const auto result = run({"run", folder + "drive.yaml", "--out", folder + "results"});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
  return result.out;
}

/// Rms heading error of G1 against the truth, degrees, from `run --json`.
double heading_error_deg(const std::string& yaml, const std::string& results) {
  const auto result = run({"run", yaml, "--out", results, "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto json = nlohmann::json::parse(result.out);
  const auto& fused = json.at("evaluations").at(0).at("truth").at("fused");
  return fused.at("heading").at("rms_rad").get<double>() / kDegree;
}

}  // namespace

TEST_CASE("sensors: compass headings clockwise from north in degrees become headings in the frame") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder,
                     "  - name: heading\n"
                     "    file: compass.csv\n"
                     "    columns: {heading: {column: hdg, unit: deg, convention: cw_from_north}}\n"
                     "    options: {offset: off}\n");
  write_log(folder + "compass.csv", "time,hdg", [](int t) {
    return std::string(",").append(std::to_string(std::fmod(90 - t * kYawRate / kDegree + 360, 360.0)));
  });
  const auto found = converted(folder, "EDGE_HEADING");
  REQUIRE(found.size() == 38);
  // Zone 33 has its meridian at 15 degrees: west of it grid north lies to the east of true north, so that
  // headings from grid east are smaller by atan(tan(1.6 deg) sin(52.5 deg)) = 1.27 degrees.
  for (std::size_t i = 0; i < found.size(); ++i) {
    REQUIRE(found[i].size() == 3);  // vertex, measured, information
    const double true_heading = static_cast<double>(i + 1) * kYawRate;
    const double expected = true_heading - std::atan(std::tan(1.6 * kDegree) * std::sin(52.5 * kDegree));
    CHECK(found[i][1] == Approx(expected).margin(0.02 * kDegree));
    CHECK(found[i][2] == Approx(1 / (kDegree * kDegree)));
  }
  (void)ran(folder);
}

TEST_CASE("sensors: a compass with a deviation is calibrated by the drive, and the state is reported") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder,
                     "  name: heading\n"
                     "  file: compass.csv\n"
                     "  columns: {heading: {column: hdg, unit: deg}}\n"
                     "  options: {offset: constant, offset_sigma_deg: 20, sigma_deg: 0.5}\n");
  write_log(folder + "compass.csv", "time,hdg",
            [](int t) { return std::string(",").append(std::to_string(t * kYawRate / kDegree + 12)); });
  (void)ran(folder);
  const auto state = edges(folder + "results/g1.fused.graph", "VERTEX_HEADING_OFFSET");
  REQUIRE(state.size() == 1);
  CHECK(state[0][1] == Approx(12 * kDegree).margin(0.5 * kDegree));
}

TEST_CASE("sensors: course and Doppler speed come from the gnss log") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder, "  - {name: gnss_velocity, options: {speed_sigma: 0.05}}\n");
  check_refused(folder,
                "drive.yaml:6:5: sensor gnss_velocity: no accepted fix has a course or a speed; does the "
                "gnss log have columns 'course' and 'speed'?");
  // The fixes once more, with course (cw from north, degrees) and speed.
  std::istringstream plain(read_text(folder + "gnss.csv"));
  std::ostringstream with;
  std::string line;
  std::getline(plain, line);
  with << line << ",course,speed\n";
  for (int t = 0; std::getline(plain, line); ++t)
    with << line << ',' << std::fmod(450 - t * kYawRate / kDegree, 360.0) << ",10\n";
  write_text(folder + "gnss.csv", with.str());
  CHECK(converted(folder, "EDGE_GNSS_COURSE").size() == 41);
  const auto speeds = converted(folder, "EDGE_GNSS_SPEED");
  REQUIRE(speeds.size() == 41);
  CHECK(speeds[5][2] == Approx(10).epsilon(1e-3));  // grid metres
  CHECK(speeds[5][3] == Approx(0.2));
  (void)ran(folder);
}

TEST_CASE("sensors: a match of two moments joins their nodes") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder,
                     "  - name: loop_closure\n"
                     "    file: matches.csv\n"
                     "    columns: {heading: {column: yaw, unit: deg, convention: cw}, dt: {column: dt_ms, "
                     "unit: ms}}\n");
  const double turn = 10 * kYawRate;
  std::ostringstream text;
  text << "time,dt_ms,x,y,yaw\n1010,10000," << kRadius * std::sin(turn) << ','
       << kRadius * (1 - std::cos(turn)) << ',' << -turn / kDegree << "\n";
  write_text(folder + "matches.csv", text.str());
  const auto found = converted(folder, "EDGE_SE2");
  REQUIRE(found.size() == 1);
  CHECK(found[0][1] - found[0][0] == 100);  // nodes at 10 Hz
  CHECK(found[0][2] == Approx(kRadius * std::sin(turn)).epsilon(1e-3));
  CHECK(found[0][3] == Approx(kRadius * (1 - std::cos(turn))).epsilon(1e-3));
  CHECK(found[0][4] == Approx(turn).epsilon(1e-5));
  (void)ran(folder);
}

TEST_CASE(
    "sensors: landmarks by range and bearing become vertices, and an id that is no whole number is refused") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder,
                     "  - name: landmarks\n"
                     "    file: poles.csv\n"
                     "    columns: {bearing: {column: azimuth, unit: deg, convention: cw}}\n");
  // A pole in the middle of the circle: always 200 m to the left.
  write_log(folder + "poles.csv", "time,id,range,azimuth", [](int) { return ",4,200,-90"; });
  const auto found = converted(folder, "EDGE_SE2_XY_RANGE_BEARING");
  REQUIRE(found.size() == 38);
  CHECK(found[0][3] == Approx(90 * kDegree));
  CHECK(edges(folder + "out.graph", "VERTEX_XY").size() == 1);
  (void)ran(folder);
  std::remove((folder + "out.graph").c_str());

  write_log(folder + "poles.csv", "time,id,range,azimuth",
            [](int t) { return t == 7 ? ",4.5,200,-90" : ",4,200,-90"; });
  check_refused(folder,
                "drive.yaml:6:5: sensor landmarks: row 7 (time 1007): column 'id': expected a whole number, "
                "got 4.5");
}

TEST_CASE("sensors: offsets to a line of the map, in a frame that is stated") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder, "  - {name: lane, file: marking.csv, options: {lever_x: 2}}\n",
                     "frame: {utm_zone: 33N, origin: [391000, 5817000]}\n");
  write_text(folder + "marking.csv", "time,offset,ax,ay,bx,by\n1001.04,1.75,300,500,400,500\n");
  const auto found = converted(folder, "EDGE_LATERAL_OFFSET");
  REQUIRE(found.size() == 1);
  // offset, point, heading, lever: the camera 40 ms after the node, on a slight curve to the left.
  CHECK(found[0][1] == Approx(1.75).epsilon(1e-3));
  CHECK(found[0][2] == 300);
  CHECK(found[0][3] == 500);
  CHECK(found[0][4] == 0);
  CHECK(found[0][5] == Approx(2.4).margin(1e-3));
  (void)ran(folder);
}

TEST_CASE("sensors: what is wrong is said with its place") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder, "  - {name: compass, file: compass.csv}\n");
  check_refused(folder, "drive.yaml:6:5: sensor compass: unknown sensor model 'compass'; there are: ");

  write_sensor_drive(folder, "  - {name: heading}\n");
  check_refused(folder, "drive.yaml:6:5: sensor heading: needs a log: name it with 'file: ...'");

  write_sensor_drive(folder, "  - {name: gnss_velocity, file: compass.csv}\n");
  check_refused(folder, "drive.yaml:6:5: sensor gnss_velocity: takes no log; leave out 'file'");

  write_sensor_drive(folder, "  - {name: heading, file: compass.csv, options: {sigma: 1}}\n");
  check_refused(folder,
                "drive.yaml:6:5: sensor heading: heading: unknown option 'sigma'; it has mount_deg, "
                "sigma_deg, offset, offset_sigma_deg");

  write_sensor_drive(folder, "  - {name: heading, file: compass.csv}\n");
  check_refused(folder, "compass.csv: cannot read: No such file or directory");
  write_text(folder + "compass.csv", "time,hdg\n1001,90\n");
  check_refused(folder,
                "compass.csv:1:1: no column for heading (no 'heading'): name it under columns; columns "
                "present: time, hdg");
  write_text(folder + "compass.csv", "time,heading\n99,0\n98,0\n");
  const auto apart = run({"convert", folder + "drive.yaml", "-o", folder + "apart.graph"});
  CHECK(apart.code == 0);
  CHECK(contains(apart.err, "warning: " + folder +
                                "drive.yaml:6:5: sensor heading: none of its 2 readings lies within "
                                "the drive; is its clock (time: scale, week, offset) right?"));
  write_text(folder + "compass.csv", "time,heading,sigma\n1001,0.05,0.01\n1002,0.1,0\n");
  check_refused(folder,
                "sensor heading: row 2 (time 1002): column 'sigma': a sigma must lie in [1e-9, 1e9], got 0");

  write_sensor_drive(folder,
                     "  - {name: heading, file: compass.csv, columns: {heading: {column: heading, unit: "
                     "grad}}}\n");
  check_refused(folder, "compass.csv: unknown unit 'grad' for heading; did you mean 'rad'?; known: rad, deg");
  write_sensor_drive(folder, "  - {name: heading, file: compass.csv, columns: {azimuth: heading}}\n");
  check_refused(folder, "compass.csv: 'azimuth' is no quantity of the sensor stream; there are: time, ");
}

TEST_CASE("sensors: an imitated dual antenna on the bundled drive") {
  // Imitated: the reference's own heading at 1 Hz with 0.5 degrees of white noise, as a log counts it,
  // clockwise from true north. In an urban canyon, most fixes rejected, the drive alone is degrees off.
  const std::string folder = fresh_folder();
  const std::string example =
      bundled_drive().substr(0, bundled_drive().size() - std::string("drive.yaml").size());
  for (const char* log : {"gnss_5hz.csv", "odometry_50hz.csv", "truth_5hz.csv"})
    write_text(folder + log, read_text(example + log));
  const std::string yaml = read_text(bundled_drive());
  write_text(folder + "without.yaml", yaml);
  write_text(folder + "with.yaml",
             yaml +
                 "sensors:\n"
                 "  name: heading\n"
                 "  file: antenna.csv\n"
                 "  columns: {heading: {column: hdg, unit: deg, convention: cw_from_north}}\n"
                 "  time: {week: 1900}\n"
                 "  options: {sigma_deg: 0.5, offset: off}\n");
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.5);
  std::istringstream truth(read_text(folder + "truth_5hz.csv"));
  std::ostringstream antenna;
  antenna.precision(12);
  antenna << "time,hdg\n";
  std::string line;
  std::getline(truth, line);
  for (int i = 0; std::getline(truth, line); ++i) {
    if (i % 5 != 0) continue;
    const double heading = std::stod(line.substr(line.rfind(',') + 1)) / kDegree;
    antenna << line.substr(0, line.find(',')) << ',' << std::fmod(810 - heading + noise(random), 360.0)
            << "\n";
  }
  write_text(folder + "antenna.csv", antenna.str());
  const double without = heading_error_deg(folder + "without.yaml", folder + "without");
  const double with = heading_error_deg(folder + "with.yaml", folder + "with");
  INFO(without << " deg without, " << with << " deg with");
  CHECK(without > 1);
  CHECK(with < 0.5);  // better than one reading: the gyro averages them
}

TEST_CASE("sensors: a format that knows no sensors is refused instead of giving nothing") {
  const std::string folder = fresh_folder();
  write_sensor_drive(folder, "  - {name: heading, file: compass.json, format: gpsd_json}\n");
  write_text(folder + "compass.json",
             "{\"class\":\"TPV\",\"mode\":3,\"time\":\"2020-01-01T00:00:00.000Z\",\"lat\":52.5,\"lon\":13.4,"
             "\"epx\":2.0,\"epy\":2.0}\n");
  const RunResult result = run({"convert", folder + "drive.yaml", "-o", folder + "out.graph"});
  CHECK(result.code == 3);
  CHECK(contains(result.err,
                 "compass.json: a gpsd log holds no sensor readings; it gives the streams gnss and truth"));
}

}  // namespace sensors_test

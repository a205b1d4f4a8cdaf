// The plugins of examples/extensions: one for each extension point, used by the program as a user would.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/plugin_loader.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace extensions_test {

namespace {

using Json = nlohmann::json;

std::string extension(const std::string& name) {
  return waymark_test::extension_dir() + "/" + name + ".so";
}

bool are_built() {
  if (std::filesystem::exists(extension("step_halving"))) return true;
  waymark_test::skip("the examples are not built");
  return false;
}

/// Runs the program with one of the plugins.
RunResult run_with(const std::string& name, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--plugin", extension(name)});
  return run(std::move(arguments));
}

/// The plugin's types and those of the core, in a registry of this process.
waymark::TypeRegistry registry_with(const std::string& name) {
  waymark::TypeRegistry registry;
  waymark::register_core_types(registry);
  waymark::load_plugin(extension(name), registry);
  return registry;
}

/// Vertex id -> its numbers.
std::map<int, std::vector<double>> vertices(const std::string& graph) {
  std::map<int, std::vector<double>> found;
  std::istringstream lines(graph);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("VERTEX_")) continue;
    std::istringstream words(line);
    std::string tag;
    int id = 0;
    words >> tag >> id;
    for (double value = 0; words >> value;) found[id].push_back(value);
  }
  return found;
}

void check_near(const std::vector<double>& found, const std::vector<double>& expected, double margin) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).margin(margin));
}

/// A drive whose fixes lie off the circle by turns, so that chi2 is not 0.
std::string wavering_drive(const std::string& folder, const std::string& more_yaml = {}) {
  return write_drive(folder,
                     {.fix_error_m = [](int t) { return 0.7 * std::sin(3.0 * t); }, .more_yaml = more_yaml});
}

/// The lines of a graph without those that name its sources.
std::string without_provenance(const std::string& graph) {
  std::string kept;
  std::istringstream lines(graph);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("PROVENANCE")) kept += line + "\n";
  }
  return kept;
}

/// A CSV table as records of line_log: the letter, whole milliseconds, the other numbers as they are.
std::string as_line_log(const std::string& csv, char letter) {
  std::string records;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);  // the header
  while (std::getline(lines, line)) {
    const auto comma = line.find(',');
    std::replace(line.begin(), line.end(), ',', ' ');
    records += letter;
    records += ' ';
    records += std::to_string(std::llround(1000 * std::stod(line.substr(0, comma))));
    records += line.substr(comma);
    records += '\n';
  }
  return records;
}

}  // namespace

TEST_CASE("extensions: vertex and edges on one, two and three vertices have their minimum where it was put") {
  if (!are_built()) return;
  const std::string graph = waymark_test::source_dir() + "/examples/extensions/pseudorange.graph";
  const std::string out = fresh_folder() + "out.graph";
  const RunResult result =
      run_with("pseudorange", {"optimize", graph, "-o", out, "--json", "--tolerance", "1e-15"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(Json::parse(result.out).at("final_chi2").get<double>() == Approx(2).epsilon(1e-9));
  const auto found = vertices(read_text(out));
  check_near(found.at(10), {30, 40, 0}, 1e-5);
  check_near(found.at(11), {7}, 1e-5);
  check_near(found.at(20), {70, 40, 0}, 1e-5);
  check_near(found.at(21), {8}, 1e-5);
}

TEST_CASE("extensions: derivatives by dual numbers and by hand are checked alike") {
  if (!are_built()) return;
  const RunResult types = run_with("pseudorange", {"check", "--derivatives"});
  INFO(types.out << types.err);
  CHECK(types.code == 0);
  for (const char* tag : {"EDGE_CLOCK_SET", "EDGE_CLOCK_DRIFT", "EDGE_PSEUDORANGE"})
    CHECK(contains(types.out, tag));
  CHECK(contains(types.out, "no problems found"));
  const RunResult graph = run_with(
      "pseudorange", {"check", waymark_test::source_dir() + "/examples/extensions/pseudorange.graph"});
  INFO(graph.out << graph.err);
  CHECK(graph.code == 0);
}

TEST_CASE("extensions: an edge on the wrong type of vertex is refused with its place") {
  if (!are_built()) return;
  const std::string graph =
      write_text(fresh_folder() + "wrong.graph", "GRAPH 1\nVERTEX_SE2 1 0 0 0\nEDGE_CLOCK_SET 1 5 1\n");
  const RunResult result = run_with("pseudorange", {"check", graph});
  CHECK(result.code == 3);
  CHECK(contains(result.err + result.out, "wrong.graph:3:"));
  CHECK(contains(result.err + result.out, "VERTEX_CLOCK_BIAS"));
}

TEST_CASE("extensions: the unary modeling has the minimum of g1") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  const RunResult result = run_with(
      "unary_fixes",
      {"run", wavering_drive(folder), "--out", folder + "results", "-m", "g1,unary", "--tolerance", "1e-15"});
  INFO(result.out << result.err);
  REQUIRE(result.code == 0);
  const std::string g1 = read_text(folder + "results/g1.fused.graph");
  const std::string unary = read_text(folder + "results/unary.fused.graph");
  CHECK(contains(unary, "\nEDGE_PRIOR_SE2_XY "));
  const auto summary = Json::parse(read_text(folder + "results/summary.json"));
  INFO(summary.dump(1));
  const auto poses = vertices(unary);
  REQUIRE(poses.size() > 400);
  const auto expected = vertices(g1);
  CHECK(expected.size() == poses.size() + 1);  // g1's origin
  for (const auto& [id, pose] : poses) check_near(pose, expected.at(id), 1e-6);
}

TEST_CASE("extensions: what a modeling cannot do, and options it does not have, are refused") {
  if (!are_built()) return;
  const auto refused = [](const std::string& line, const std::string& instead, int code,
                          const std::string& message) {
    const std::string folder = fresh_folder();
    const std::string drive = wavering_drive(folder, "modeling: {name: unary}\n");
    std::string yaml = read_text(drive);
    yaml.replace(yaml.find(line), line.size(), instead);
    write_text(drive, yaml);
    check_refused(run_with("unary_fixes", {"convert", drive, "-o", folder + "out.graph"}), code, message);
    CHECK_FALSE(exists(folder + "out.graph"));
  };
  refused("{file: gnss.csv,", "{file: gnss.csv, antenna: [1, 0],", 2, "no antenna lever arm; use g1");
  refused("{name: unary", "{name: unary, options: {sigma: 2}", 3,
          "unknown option 'sigma'; it has sigma_factor");
  refused("{name: unary", "{name: unary, options: {sigma_factor: 0}", 3, "must lie in [0.01, 100], got 0");
}

TEST_CASE("extensions: the line log gives the graph that CSV gives") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder, {.with_truth = false});
  std::string yaml = read_text(drive);
  yaml.replace(yaml.find("drms"), 4, "1sigma");
  write_text(drive, yaml);
  const RunResult csv = run({"convert", drive, "-o", folder + "csv.graph"});
  INFO(csv.err);
  REQUIRE(csv.code == 0);
  write_text(folder + "all.log", as_line_log(read_text(folder + "odometry.csv"), 'O') +
                                     as_line_log(read_text(folder + "gnss.csv"), 'F'));
  const std::string own = write_text(folder + "own.yaml",
                                     "name: circle\n"
                                     "odometry: {file: all.log, format: line_log}\n"
                                     "gnss: {file: all.log, format: line_log}\n"
                                     "plugins: [" +
                                         extension("line_log") + "]\n");
  const RunResult lines = run({"convert", own, "-o", folder + "lines.graph"});
  INFO(lines.err);
  REQUIRE(lines.code == 0);
  CHECK(without_provenance(read_text(folder + "lines.graph")) ==
        without_provenance(read_text(folder + "csv.graph")));
}

TEST_CASE("extensions: the line log counts what it cannot use, and says where") {
  if (!are_built()) return;
  const waymark::TypeRegistry registry = registry_with("line_log");
  const waymark::LogReader* reader = registry.find_log_reader("line_log");
  REQUIRE(reader != nullptr);
  waymark::LogRequest fixes;
  fixes.gps_week = 2;
  fixes.time_offset_s = -0.25;
  const waymark::LogData data = reader->read(
      "a comment\nO 1 2 3\nF 1500 52.5 13.4 2.5\r\nF 2500 52.5\nF 1 91 0 1\nF 1 2 3 nan\nF 1 2 3 4 5\nF\nF 1 "
      "2 3 0",
      "x.log", fixes);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].stamp.nanoseconds == 2 * 604'800'000'000'000 + 1'250'000'000);
  CHECK(data.fixes[0].covariance_en(1, 1) == 6.25);
  CHECK(data.fixes[0].line == 3);
  CHECK(data.odometry.empty());
  CHECK(data.records == 7);
  CHECK(data.corrupt == 6);
  CHECK(data.corrupt_examples.size() == 5);
  CHECK(data.corrupt_examples.front() == "x.log:4:1: not a record of line_log");
  CHECK_THROWS_WITH(reader->read("O 1 2 3", "x.log", fixes), "x.log: no record begins with F");
  CHECK_THROWS_WITH(reader->read("\nF 1", "x.log", fixes), "x.log:2:1: not a record of line_log");
  waymark::LogRequest truth;
  truth.stream = waymark::StreamKind::truth;
  CHECK_THROWS_AS(reader->read("F 1 2 3 4", "x.log", truth), waymark::InputError);
}

TEST_CASE("extensions: weight and curvature of pseudo-Huber are the derivatives of its rho") {
  if (!are_built()) return;
  const waymark::TypeRegistry registry = registry_with("pseudo_huber");
  const waymark::LossType& loss = *registry.find_loss("pseudo_huber");
  for (const double scale : {0.3, 1.0, 4.0}) {
    CHECK(loss.evaluate(0, scale).rho == 0);
    CHECK(loss.evaluate(0, scale).weight == 1);
    for (const double s : {1e-3, 0.1, 1.0, 7.0, 1e4}) {
      INFO("scale " << scale << " s " << s);
      const double h = 1e-4 * s;
      const waymark::LossValue at = loss.evaluate(s, scale);
      const waymark::LossValue up = loss.evaluate(s + h, scale);
      const waymark::LossValue down = loss.evaluate(s - h, scale);
      CHECK(at.rho == Approx(2 * scale * scale * (std::sqrt(1 + s / (scale * scale)) - 1)).epsilon(1e-5));
      CHECK(at.weight == Approx((up.rho - down.rho) / (2 * h)).epsilon(1e-6));
      CHECK(at.curvature == Approx((up.weight - down.weight) / (2 * h)).epsilon(1e-5));
      CHECK(at.weight <= 1);
    }
  }
}

TEST_CASE("extensions: a loss moves the minimum to where its weights balance") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  // x = 0 said plainly, x = 10 with the loss: 2 x = 2 (10 - x) w with w = 1 / sqrt(1 + (10 - x)^2) for k = 1.
  // The third axis and y agree.
  const std::string graph = write_text(folder + "a.graph",
                                       "GRAPH 1\nVERTEX_SE2 1 5 0 0\nEDGE_PRIOR_SE2 1 0 0 0 1 0 0 1 0 1\n"
                                       "EDGE_PRIOR_SE2_XY 1 10 0 1 0 1\n");
  const RunResult result =
      run_with("pseudo_huber", {"optimize", graph, "-o", folder + "b.graph", "--loss",
                                "EDGE_PRIOR_SE2_XY=pseudo_huber:1", "--json", "--tolerance", "1e-15"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const std::string written = read_text(folder + "b.graph");
  CHECK(contains(written, "\nLOSS pseudo_huber 1\n"));
  const double x = vertices(written).at(1)[0];
  CHECK(x == Approx((10 - x) / std::sqrt(1 + (10 - x) * (10 - x))).epsilon(1e-7));
  const double chi2 = x * x + 2 * (std::sqrt(1 + (10 - x) * (10 - x)) - 1);
  CHECK(Json::parse(result.out).at("final_chi2").get<double>() == Approx(chi2).epsilon(1e-9));
}

TEST_CASE("extensions: the dense solver reaches the optimum of the house's own") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  const std::string graph = write_text(folder + "square.graph", square_graph());
  const std::vector<std::string> common = {"optimize", graph, "-o", folder + "out.graph", "--json"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    return more;
  };
  const Json own = Json::parse(run(with({"--tolerance", "1e-14"})).out);
  const Json dense =
      Json::parse(run_with("dense_solver", with({"--tolerance", "1e-14", "--solver", "dense"})).out);
  CHECK(own.at("final_chi2") > 1e-5);
  CHECK(dense.at("final_chi2").get<double>() == Approx(own.at("final_chi2").get<double>()).epsilon(1e-10));
  CHECK(dense.at("solver") == "dense");
  CHECK(dense.at("factor_size") == 9 * 10 / 2);  // three free poses
  const std::string large = write_text(folder + "large.graph", slow_graph(1700));
  const RunResult refused =
      run_with("dense_solver", {"optimize", large, "-o", folder + "no.graph", "--solver", "dense"});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "dense: 5097 unknowns are too many, at most 5000; use block_cholesky"));
}

TEST_CASE("extensions: step halving reaches the minimum from where full steps lead uphill") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  // Both places close to a beacon, where the ranges bend most.
  std::string text = read_text(waymark_test::source_dir() + "/examples/extensions/pseudorange.graph");
  text.replace(text.find("25 45 0.2"), 9, "29 1 3");
  text.replace(text.find("66 37 -0.1"), 10, "31 1 0");
  const std::string graph = write_text(folder + "far.graph", text);
  const RunResult result =
      run_with("pseudorange", {"optimize", graph, "-o", folder + "out.graph", "--start", "file", "--json",
                               "--plugin", extension("step_halving"), "--algorithm", "step_halving"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json summary = Json::parse(result.out);
  CHECK(summary.at("final_chi2").get<double>() == Approx(2).epsilon(1e-6));
  CHECK(summary.at("algorithm") == "step_halving");
  int halved = 0;
  for (const Json& record : summary.at("records")) {
    halved += record.at("kind") == "halved" ? 1 : 0;
    if (record.at("accepted")) CHECK(record.at("decrease") >= -1e-9);
  }
  CHECK(halved > 0);
  const RunResult refused =
      run_with("step_halving", {"optimize", graph, "-o", folder + "no.graph", "--algorithm", "step_halving",
                                "--algorithm-option", "least_fraction=2"});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "option 'least_fraction' must lie in"));
}

TEST_CASE("extensions: ranges to anchors alone locate a drive without a receiver") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  (void)write_drive(folder);
  // Places of write_drive(): a circle of 200 m that begins at 52.5, 13.4 towards the east.
  const double per_latitude = 111'270;
  const double per_longitude = 111'414 * std::cos(52.5 * 3.14159265358979 / 180);
  const std::vector<std::pair<double, double>> anchors = {{-150, -50}, {250, 60}, {10, 350}};
  std::string log = "time,anchor,range\n";
  for (int i = 0; i < 80; ++i) {
    const double heading = 0.05 * 0.5 * i;
    const auto [east, north] = anchors[static_cast<std::size_t>(i % 3)];
    const double range = std::hypot(200 * std::sin(heading) - east, 200 * (1 - std::cos(heading)) - north);
    log +=
        std::to_string(1000 + 0.5 * i) + "," + std::to_string(i % 3 + 1) + "," + std::to_string(range) + "\n";
  }
  write_text(folder + "ranges.csv", log);
  std::string yaml =
      "name: ranges\nodometry: {file: odometry.csv}\ntruth: {file: truth.csv}\n"
      "frame: {utm_zone: 33N, origin: [391300, 5817800]}\n"
      "sensors:\n  - name: ranges\n    file: ranges.csv\n    loss: cauchy:2\n    options:\n      places: wgs84\n"
      "      sigma: 0.3\n      anchors:\n";
  for (std::size_t i = 0; i < anchors.size(); ++i)
    yaml += "        " + std::to_string(i + 1) +
            ": {x: " + std::to_string(13.4 + anchors[i].first / per_longitude) +
            ", y: " + std::to_string(52.5 + anchors[i].second / per_latitude) + "}\n";
  const std::string drive = write_text(folder + "ranges.yaml", yaml);
  const RunResult result = run_with("range_sensor", {"run", drive, "-o", folder + "out"});
  INFO(result.out << result.err);
  REQUIRE(result.code == 0);
  const Json metrics = Json::parse(read_text(folder + "out/metrics.json"));
  const Json& evaluation = metrics.at("evaluations").at(0);
  CHECK(evaluation.at("truth").at("fused").at("position").at("rmse_m") < 0.5);
  CHECK(evaluation.at("residuals").at(1).at("edge") == "EDGE_ANCHOR_RANGE");
  CHECK(evaluation.at("residuals").at(1).at("measurements") == 80);
  CHECK(contains(result.out, "Fused positions: RMSE"));  // there is no raw GNSS to compare with
  // The sensor tells the anchor of each range: 80 ranges of few anchors.
  CHECK(contains(result.out, "anchors of "));
  const Json& groups = evaluation.at("groups").at(0).at("groups");
  std::size_t ranges = 0;
  for (const Json& anchor : groups) ranges += anchor.at("quantities").at(0).at("measurements").get<std::size_t>();
  CHECK(groups.size() == anchors.size());
  CHECK(ranges == 80);

  write_text(folder + "ranges.csv", "time,anchor,range\n1001,7,20\n");
  const RunResult unknown = run_with("range_sensor", {"run", drive, "-o", folder + "out"});
  CHECK(unknown.code == 3);
  CHECK(contains(unknown.err, "no anchor '7' in the options"));
}

TEST_CASE("extensions: an odometry model of a plugin gives the poses of the built-in one") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  std::string yaml = read_text(drive);
  yaml.replace(yaml.find("{file: odometry.csv}"), 20, "{file: odometry.csv, model: plain}");
  const std::string plain = write_text(folder + "plain.yaml", yaml);
  const RunResult result = run_with("plain_odometry", {"run", plain, "-m", "g1", "-o", folder + "out"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json metrics = Json::parse(read_text(folder + "out/metrics.json"));
  // Odometry and fixes are exact, up to the 0.1 % of the circle's degrees.
  CHECK(metrics.at("evaluations").at(0).at("truth").at("fused").at("position").at("rmse_m") < 0.3);
}

TEST_CASE("extensions: the initial guess along the way gives headings to poses that have none") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  const std::string graph =
      write_text(folder + "a.graph",
                 "GRAPH 1\nVERTEX_SE2 1 0 0 3\nVERTEX_SE2 2 10 0 -2\nVERTEX_SE2 3 10 10 1\nFIX 1\n"
                 "EDGE_SE2 1 2 10 0 0 1 0 0 1 0 1\nEDGE_SE2 2 3 10 0 1.5707963267948966 1 0 0 1 0 1\n");
  const RunResult result = run_with("course_start", {"optimize", graph, "-o", folder + "b.graph", "--start",
                                                     "course", "--max-iterations", "0"});
  CHECK(result.code == 4);  // no step was allowed
  check_near(vertices(read_text(folder + "b.graph")).at(2), {10, 0, std::acos(0.0)}, 1e-9);
  check_near(vertices(read_text(folder + "b.graph")).at(3), {10, 10, std::acos(0.0)}, 1e-9);
  check_near(vertices(read_text(folder + "b.graph")).at(1), {0, 0, 3}, 1e-9);
}

TEST_CASE("extensions: check --all passes for every example, and names what is wrong") {
  if (!are_built()) return;
  for (const char* name : {"pseudorange", "unary_fixes", "line_log", "pseudo_huber", "dense_solver",
                           "step_halving", "range_sensor", "plain_odometry", "course_start", "se3"}) {
    const RunResult result = run_with(name, {"check", "--all"});
    INFO(result.out << result.err);
    CHECK(result.code == 0);
    CHECK(contains(result.out, "passed"));
    CHECK(contains(result.out, "no problems found"));
  }
}

TEST_CASE("extensions: check --all tries the named plugin alone") {
  if (!are_built()) return;
  const RunResult result =
      run({"check", "--all", "--plugin", extension("se3"), "--plugin", extension("pseudo_huber"), "--json"});
  REQUIRE(result.code == 0);
  std::set<std::string> origins;
  const Json document = Json::parse(result.out);
  for (const Json& row : document.at("conformance")) origins.insert(row.at("origin"));
  CHECK(origins == std::set<std::string>{"pseudo_huber", "se3"});
}

/// A helix on a sphere of 20 m, 50 poses a turn, with an edge to the pose before and to the turn before.
/// Every pose but the first is at the origin. @param noise of the measured translations, m
std::string sphere(int poses, double noise, bool with_vertices = true) {
  std::ostringstream text;
  text.precision(15);
  const auto pose = [&](int i) {
    const double phi = 2 * M_PI * i / 50;
    const double theta = M_PI * (i + 10) / (poses + 20);
    const Eigen::Vector3d place(20 * std::sin(theta) * std::cos(phi), 20 * std::sin(theta) * std::sin(phi),
                                20 * std::cos(theta));
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitY());
    return std::pair(place, turn);
  };
  const auto write = [&](const Eigen::Vector3d& t, const Eigen::Quaterniond& q) {
    text << ' ' << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' '
         << q.w();
  };
  for (int i = 0; i < poses && with_vertices; ++i) {
    text << "VERTEX_SE3:QUAT " << i;
    i == 0 ? write(pose(0).first, pose(0).second)
           : write(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
    text << '\n';
  }
  for (int i = 0; i < poses; ++i) {
    for (const int j : {i + 1, i + 50}) {
      if (j >= poses) continue;
      const auto [from, turn] = pose(i);
      const auto [to, other] = pose(j);
      const Eigen::Vector3d off(std::sin(7.0 * i + j), std::cos(3.0 * i), std::sin(5.0 * j));
      text << "EDGE_SE3:QUAT " << i << ' ' << j;
      write(turn.inverse() * (to - from) + noise * off, turn.inverse() * other);
      for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column) text << ' ' << (row != column ? 0 : row < 3 ? 1 : 100);
      text << '\n';
    }
  }
  return text.str();
}

TEST_CASE(
    "extensions: poses in space reach the truth of a sphere by every algorithm, or are refused by name") {
  if (!are_built()) return;
  const std::string folder = fresh_folder();
  const std::string exact = write_text(folder + "exact.g2o", sphere(300, 0));
  const std::string noisy = write_text(folder + "noisy.g2o", sphere(300, 0.1));
  double lowest = 0;
  for (const char* algorithm : {"gauss_newton", "levenberg_marquardt", "dogleg"}) {
    INFO(algorithm);
    const RunResult result = run_with("se3", {"optimize", exact, "-o", folder + "out.g2o", "-a", algorithm,
                                              "--json", "--start", "chain_in_space"});
    REQUIRE(result.code == 0);
    CHECK(Json::parse(result.out).at("final_chi2").get<double>() < 1e-12);
    const RunResult of_noisy =
        run_with("se3", {"optimize", noisy, "-o", folder + "out.g2o", "-a", algorithm, "--json", "--start",
                         "chain_in_space", "--tolerance", "1e-12"});
    REQUIRE(of_noisy.code == 0);
    const double chi2 = Json::parse(of_noisy.out).at("final_chi2");
    CHECK(chi2 > 1);
    if (lowest == 0) lowest = chi2;
    CHECK(chi2 == Approx(lowest).epsilon(1e-9));
  }
  const auto last = [&] {
    std::istringstream words(read_text(folder + "out.g2o"));
    std::vector<double> numbers;
    std::string line;
    while (std::getline(words, line)) {
      if (!line.starts_with("VERTEX_SE3:QUAT 299 ")) continue;
      std::istringstream values(line.substr(20));
      for (double value = 0; values >> value;) numbers.push_back(value);
    }
    return numbers;
  };
  CHECK(last().size() == 7);
  CHECK(std::hypot(last()[0], last()[1], last()[2]) == Approx(20).margin(0.5));  // it is on the sphere

  const std::string edges = write_text(folder + "edges.g2o", sphere(60, 0, false));
  const RunResult refused = run_with("se3", {"optimize", edges, "-o", folder + "out.g2o"});
  CHECK(refused.code == 3);
  CHECK(contains(refused.err, "the file has edges only, and no start can place their vertices"));
  CHECK(contains(refused.err, "VERTEX_SE3:QUAT"));
  const RunResult planar =
      run_with("se3", {"optimize", exact, "-o", folder + "out.g2o", "--start", "spanning_tree"});
  CHECK(planar.code == 3);
  CHECK(contains(planar.err, "it is for poses of the plane, and the graph has VERTEX_SE3:QUAT"));
}

}  // namespace extensions_test

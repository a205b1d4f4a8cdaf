// The plugin of examples/plugin_template, built against the installed package and used by the installed
// program, and the tutorial that shows it.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include <catch2/catch.hpp>

#include "program/support/program.hpp"
#include "support/markdown.hpp"
#include "support/paths.hpp"

namespace {

const std::string kTemplate = waymark_test::source_dir() + "/examples/plugin_template/";

RunResult waymark(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--plugin", PLUGIN_TEMPLATE});
  return run(std::move(arguments), {.program = INSTALLED_PREFIX "/bin/waymark"});
}

/// Vertex id -> its numbers.
std::map<int, std::vector<double>> vertices(const std::string& graph) {
  std::map<int, std::vector<double>> found;
  std::istringstream lines(graph);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string tag;
    int id = 0;
    if (!(words >> tag >> id) || tag != "VERTEX_SE2") continue;
    for (double value = 0; words >> value;) found[id].push_back(value);
  }
  return found;
}

/// Lines that are neither empty nor comments only.
int code_lines(const std::string& source) {
  int count = 0;
  std::istringstream lines(source);
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find_first_not_of(' ');
    if (begin != std::string::npos && line.compare(begin, 2, "//") != 0) ++count;
  }
  return count;
}

/// The fenced block of plugins/README.md that is headed by this file name: "```cpp gnss_lever_arm.cpp".
std::string listing(const std::string& file) {
  const auto readme =
      waymark_test::parse_markdown(read_text(waymark_test::source_dir() + "/plugins/README.md"));
  const std::vector<std::string> wanted = {file};
  const auto found = std::find_if(readme.blocks.begin(), readme.blocks.end(),
                                  [&](const auto& block) { return block.words == wanted; });
  REQUIRE(found != readme.blocks.end());
  return found->text;
}

}  // namespace

TEST_CASE("plugin template: the program shows where the type comes from") {
  const RunResult result = waymark({"info"});
  INFO(result.err);
  CHECK(result.code == 0);
  const auto at = result.out.find("EDGE_MY_ANTENNA");
  REQUIRE(at != std::string::npos);
  const std::string line = result.out.substr(at, result.out.find('\n', at) - at);
  CHECK(contains(line, "fields=measured:2,antenna:2 information=2"));
  CHECK(contains(line, "[gnss_lever_arm]"));
}

TEST_CASE("plugin template: its graph is parsed and its derivatives are right") {
  const RunResult result = waymark({"check", kTemplate + "antenna.graph"});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.out, "no problems found"));
}

TEST_CASE("plugin template: a short line is refused with its place") {
  std::string text = read_text(kTemplate + "antenna.graph");
  const std::string line = "EDGE_MY_ANTENNA 2 11.5 0.5 1.5 0.5 1 0 1";
  text.replace(text.find(line), line.size(), "EDGE_MY_ANTENNA 2 11.5 0.5 1.5");
  const RunResult result = waymark({"check", write_text(fresh_folder() + "short.graph", text)});
  CHECK(result.code == 3);
  CHECK(contains(result.out, "short.graph:11:"));
  CHECK(contains(result.out, "EDGE_MY_ANTENNA"));
}

// The fixes agree with the poses (0, 0, 0), (10, 0, 0), (20, 10, 90 degrees) except for two that lie 0.3 m to
// either side: chi2 = 2 * 0.3^2.
TEST_CASE("plugin template: the optimum is the known one") {
  const std::string out = fresh_folder() + "fused.graph";
  const RunResult result = waymark({"optimize", kTemplate + "antenna.graph", "-o", out, "--json"});
  INFO(result.out << result.err);
  REQUIRE(result.code == 0);
  const std::map<int, std::vector<double>> poses = vertices(read_text(out));
  const std::map<int, std::vector<double>> truth = {
      {1, {0, 0, 0}}, {2, {10, 0, 0}}, {3, {20, 10, std::numbers::pi / 2}}};
  REQUIRE(poses.size() == truth.size());
  for (const auto& [id, values] : truth) {
    for (std::size_t i = 0; i < 3; ++i) CHECK(poses.at(id)[i] == Approx(values[i]).margin(1e-9));
  }
  const auto chi2 = result.out.find("\"final_chi2\": ");
  REQUIRE(chi2 != std::string::npos);
  CHECK(std::stod(result.out.substr(chi2 + 14)) == Approx(0.18).epsilon(1e-9));
}

TEST_CASE("plugin template: at most 20 lines of code, registration included") {
  CHECK(code_lines(read_text(kTemplate + "gnss_lever_arm.cpp")) <= 20);
}

TEST_CASE("plugin template: the listings of plugins/README.md are the compiled files") {
  for (const char* file : {"gnss_lever_arm.cpp", "CMakeLists.txt", "antenna.graph"}) {
    INFO(file);
    CHECK(listing(file) == read_text(kTemplate + file));
  }
}

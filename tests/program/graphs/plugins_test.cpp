// Plugins from the command line, the environment and a drive.yaml; what does not fit is said and never
// crashes.
#include <filesystem>

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <waymark/core/registry/plugin.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace plugins_test {

namespace {

std::string module_file(const std::string& name) {
  return waymark_test::test_module_dir() + "/" + name + ".so";
}

/// Sets WAYMARK_PLUGIN_PATH for one test.
class PluginPath {
 public:
  explicit PluginPath(const std::string& value) { setenv("WAYMARK_PLUGIN_PATH", value.c_str(), 1); }
  ~PluginPath() { unsetenv("WAYMARK_PLUGIN_PATH"); }
  PluginPath(const PluginPath&) = delete;
  PluginPath& operator=(const PluginPath&) = delete;
};

}  // namespace

TEST_CASE("plugins: --plugin loads a file, and info says where each plugin comes from") {
  const RunResult result = run({"info", "--plugins", "--plugin", module_file("sound")});
  CHECK(result.code == 0);
  CHECK(contains(result.out,
                 "plugin ABI " + std::to_string(waymark::kPluginAbi) + ", Eigen 30400 with alignment 16"));
  CHECK(contains(result.out, "gnss_g1 0.1.0, built in\n  g1\n"));
  CHECK(contains(result.out, "sample 1.2.3, " + module_file("sound") + "\n  EDGE_SAMPLE\n"));
  const RunResult json = run({"info", "--plugins", "--json", "--plugin", module_file("sound")});
  const auto plugins = nlohmann::json::parse(json.out).at("plugins");
  CHECK(plugins.back()["name"] == "sample");
  CHECK(plugins.back()["brings"] == nlohmann::json::array({"EDGE_SAMPLE"}));
}

TEST_CASE("plugins: a module that does not fit is a usage error with reason and remedy") {
  for (const auto& [name, reason] : std::vector<std::pair<std::string, std::string>>{
           {"avx2", "Eigen maximal alignment differs"},
           {"linked_fast", "linked with -ffast-math or -Ofast"},
           {"duplicate", "'EDGE_SE2' of sample is already registered"},
           {"throws", "the sensor is not plugged in"},
           {"no_descriptor", "no symbol 'waymark_plugin'"}}) {
    if (!std::filesystem::exists(module_file(name))) continue;
    const RunResult result = run({"info", "--plugin", module_file(name)});
    check_refused(result, 2, reason);
    CHECK(contains(result.err, "waymark: error: " + module_file(name) + ": "));
  }
  CHECK(contains(run({"info", "--plugin", "nobody"}).err, "no plugin 'nobody': searched for nobody.so in"));
}

TEST_CASE("plugins: folders of WAYMARK_PLUGIN_PATH are searched for names, and their plugins are loaded") {
  const std::string folder = fresh_folder();
  std::filesystem::copy(module_file("sound"), folder + "sound.so");
  std::filesystem::copy(module_file("other_abi"), folder + "old.so");
  write_text(folder + "text.so", "no library\n");
  const PluginPath path(folder + ":/nowhere");
  const RunResult result = run({"info", "--plugins"});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "sample 1.2.3, " + folder + "sound.so"));
  CHECK(contains(result.err, "warning: plugin left out: " + folder + "old.so: plugin ABI number differs"));
  CHECK_FALSE(contains(result.err, "text.so"));
  // By name or by file, it is loaded once.
  const RunResult named = run({"info", "--plugins", "--plugin", "sound", "--plugin", folder + "sound.so"});
  CHECK(named.code == 0);
  // Asked for by name, one that does not fit is an error.
  CHECK(run({"info", "--plugin", "old"}).code == 2);
}

TEST_CASE("plugins: one that is asked for comes before the installed one of its name") {
  const std::string folder = fresh_folder();
  std::filesystem::copy(module_file("sound"), folder + "sound.so");
  const PluginPath path(folder);
  const RunResult result = run({"info", "--plugins", "--plugin", module_file("sound")});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "sample 1.2.3, " + module_file("sound")));
  CHECK(contains(result.err,
                 "warning: plugin left out: plugin 'sample' (" + folder + "sound.so) is already loaded"));
}

TEST_CASE("plugins: a drive.yaml names its plugins, beside itself or by name") {
  const std::string folder = fresh_folder();
  std::filesystem::copy(module_file("sound"), folder + "sound.so");
  const std::string yaml = read_text(bundled_drive());
  const std::string data = std::filesystem::path(bundled_drive()).parent_path().string();
  const std::string drive = write_text(folder + "drive.yaml", yaml + "\nplugins: [sound.so]\n");
  const RunResult result =
      run({"convert", drive, "--data", data, "--to", "20", "-o", folder + "out.graph", "--quiet"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(contains(read_text(folder + "out.graph"), "PROVENANCE plugin sample 1.2.3\n"));
  const std::string missing = write_text(folder + "missing.yaml", yaml + "\nplugins: [gone.so]\n");
  const RunResult failed = run({"convert", missing, "--data", data, "-o", folder + "no.graph"});
  CHECK(failed.code == 2);
  CHECK(contains(failed.err, folder + "gone.so: cannot read the plugin"));
  CHECK_FALSE(exists(folder + "no.graph"));
}

TEST_CASE("plugins: a graph with a plugin's edges is read, optimised and checked with it, and not without") {
  const std::string folder = fresh_folder();
  const std::string graph = write_text(
      folder + "a.graph",
      "GRAPH 1\nVERTEX_SE2 0 1 2 0\nEDGE_SAMPLE 0 3 4 1 0 1\nEDGE_PRIOR_SE2 0 0 0 0.5 0 0 0 0 0 1\n");
  const RunResult without = run({"optimize", graph, "-o", folder + "b.graph"});
  CHECK(without.code == 3);
  CHECK(contains(without.err,
                 "a.graph:3:1: unknown tag 'EDGE_SAMPLE'; if a plugin defines it, load it with --plugin"));
  const RunResult with =
      run({"optimize", graph, "-o", folder + "b.graph", "--plugin", module_file("sound"), "--start", "file"});
  INFO(with.err);
  CHECK(with.code == 0);
  CHECK(contains(read_text(folder + "b.graph"), "VERTEX_SE2 0 3 4 0.5\n"));
  CHECK(run({"check", graph, "--plugin", module_file("sound")}).code == 0);
}

TEST_CASE("plugins: check --all gives models a place on the Earth and the other sources") {
  const RunResult result = run({"check", "--all", "--plugin", module_file("located"), "--json"});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
  const auto rows = nlohmann::json::parse(result.out).at("conformance");
  REQUIRE(rows.size() == 2);  // what others register is not tried
  CHECK(rows[0].at("name") == "EDGE_SAMPLE");
  CHECK(rows[1].at("name") == "located");
  CHECK(rows[1].at("passed") == true);
  CHECK(rows[1].at("note") == "");
}

TEST_CASE("derivatives: a false kRelative is named by each check, with and without a graph") {
  const std::string promise =
      "EDGE_SAMPLE of sample: it says kRelative, but row 0 of its error changes by 1 per m if all its "
      "vertices move along x";
  const std::string module = module_file("falsely_relative");
  for (const char* how : {"--derivatives", "--all"}) {
    const RunResult result = run({"check", how, "--plugin", module});
    INFO(how << result.out);
    CHECK(result.code == 3);
    CHECK(contains(result.out, promise));
  }
  const std::string graph = write_text(fresh_folder() + "a.graph",
                                       "GRAPH 1\nVERTEX_SE2 7 1 2 0\nEDGE_SAMPLE 7 3 4 1 0 1\n"
                                       "EDGE_PRIOR_SE2 7 0 0 0.5 1 0 0 1 0 1\n");
  const RunResult result = run({"check", graph, "--plugin", module});
  CHECK(result.code == 3);
  CHECK(contains(result.out, "problem: EDGE_SAMPLE number 1 (vertex 7): it says kRelative, but row 0"));
}

TEST_CASE("derivatives: every registered type is checked without a graph, and a wrong Jacobian named") {
  const RunResult sound = run({"check", "--derivatives"});
  INFO(sound.out);
  CHECK(sound.code == 0);
  CHECK(contains(sound.out, "EDGE_SE2_ODOMETRY_CALIBRATED"));
  CHECK(contains(sound.out, "no problems found"));
  const RunResult wrong = run({"check", "--derivatives", "--plugin", module_file("wrong_jacobian")});
  CHECK(wrong.code == 3);
  CHECK(contains(wrong.out, "problem: EDGE_SAMPLE of sample, scenario"));
  CHECK(contains(wrong.out,
                 "Jacobian by vertex 1 (VERTEX_SE2 0), row 1, column 1 (y): given -1, differences "
                 "of the error give 1"));
  // The same entry, in a graph.
  const std::string graph = write_text(fresh_folder() + "a.graph",
                                       "GRAPH 1\nVERTEX_SE2 7 1 2 0\nEDGE_SAMPLE 7 3 4 1 0 1\n"
                                       "EDGE_PRIOR_SE2 7 0 0 0.5 1 0 0 1 0 1\n");
  const RunResult in_graph = run({"check", graph, "--plugin", module_file("wrong_jacobian")});
  CHECK(in_graph.code == 3);
  CHECK(contains(in_graph.out,
                 "EDGE_SAMPLE number 1: Jacobian by vertex 1 (VERTEX_SE2 7), row 1, column 1 (y)"));
  CHECK(run({"check"}).code == 2);
}

}  // namespace plugins_test

// `waymark doctor`: the build, the self-test, and its texts about plugins, inputs and the folder.
#include <filesystem>

#include <unistd.h>

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <waymark/core/registry/plugin.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace doctor_test {

using Json = nlohmann::json;

namespace {

std::string module_file(const std::string& name) {
  return waymark_test::test_module_dir() + "/" + name + ".so";
}

/// A variable of the environment for one test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

Json names_of(const Json& list) {
  Json names = Json::array();
  for (const Json& entry : list) names.push_back(entry.at("name"));
  return names;
}

}  // namespace

TEST_CASE("doctor: everything that was built in reaches the minimum that theory gives") {
  const RunResult result = run({"doctor", "--json"});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
  CHECK(result.err.empty());
  const Json json = Json::parse(result.out);
  CHECK(json.at("schema") == "waymark-doctor");
  CHECK(json.at("version") == 1);
  CHECK(json.at("problems").empty());
  const Json& test = json.at("self_test");
  const Json info = Json::parse(run({"info", "--json"}).out);
  CHECK(names_of(test.at("solvers")) == names_of(info.at("solvers")));
  CHECK(names_of(test.at("algorithms")) == names_of(info.at("algorithms")));
  for (const char* kind : {"solvers", "algorithms"}) {
    for (const Json& entry : test.at(kind)) {
      INFO(entry);
      CHECK(entry.at("works") == true);
      CHECK(entry.at("chi2").get<double>() == Approx(test.at("minimum").get<double>()).epsilon(1e-9));
    }
  }
}

TEST_CASE("doctor: the licence that results is the strictest of what was linked") {
  const Json json = Json::parse(run({"doctor", "--json"}).out);
  const Json names = names_of(json.at("libraries"));
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  CHECK(has("Eigen"));
  const std::string mode = json.at("licence").at("mode");
  // CHOLMOD is GPL, and so are the libraries that Debian's Ceres links; NLopt and CXSparse are LGPL.
  CHECK(mode == (has("CHOLMOD") || has("Ceres") ? "GPL" : has("NLopt") ? "LGPL" : "permissive"));
  for (const Json& name : json.at("licence").at("because")) CHECK(has(name.get<std::string>().c_str()));
  for (const Json& library : json.at("libraries")) {
    INFO(library);
    CHECK(std::isdigit(library.at("version").get<std::string>().at(0)) != 0);
    CHECK_FALSE(library.at("licence").get<std::string>().empty());
  }
}

TEST_CASE("doctor: the text has the verdict last") {
  const RunResult result = run({"doctor"});
  CHECK(result.code == 0);
  CHECK(result.out.ends_with("\nno problems found\n"));
  CHECK(contains(result.out, "block_cholesky       works"));
  CHECK(contains(result.out, "WAYMARK_PLUGIN_PATH is not set"));
}

TEST_CASE("doctor: broken plugins in a folder are named with reason and remedy, and are no failure") {
  const std::string folder = fresh_folder();
  std::filesystem::copy(module_file("sound"), folder + "sound.so");
  std::filesystem::copy(module_file("other_abi"), folder + "old.so");
  write_text(folder + "text.so", "no library\n");
  const Variable path("WAYMARK_PLUGIN_PATH", folder + ":/nowhere");
  const RunResult result = run({"doctor", "--json"});
  CHECK(result.code == 0);
  const Json plugins = Json::parse(result.out).at("plugins");
  CHECK(plugins.at("value") == folder + ":/nowhere");
  CHECK(plugins.at("folders").back().at("problem") == "No such file or directory");
  CHECK(plugins.at("loaded").back().at("name") == "sample");
  CHECK(plugins.at("loaded").back().at("version") == "1.2.3");
  CHECK(plugins.at("loaded").back().at("abi") == waymark::kPluginAbi);
  CHECK(plugins.at("loaded").back().at("brings") == Json::array({"EDGE_SAMPLE"}));
  REQUIRE(plugins.at("left_out").size() == 2);
  CHECK(plugins.at("left_out")[0].at("file") == folder + "old.so");
  CHECK(contains(plugins.at("left_out")[0].at("problem"),
                 "plugin ABI number differs (plugin " + std::to_string(waymark::kPluginAbi - 1) +
                     ", waymark " + std::to_string(waymark::kPluginAbi) + "); build the plugin again"));
  CHECK(contains(plugins.at("left_out")[1].at("problem"), "text.so: is no shared object for this machine"));
  const RunResult text = run({"doctor"});
  CHECK(contains(text.out, "warning: plugin left out: " + folder + "old.so"));
  CHECK(contains(text.out, "warning: no plugins from /nowhere: No such file or directory"));
}

TEST_CASE(
    "doctor: a plugin that was asked for and cannot be loaded is a problem, and all else is still said") {
  for (const std::string& plugin : {module_file("other_abi"), module_file("throws"), std::string("nobody")}) {
    const RunResult result = run({"doctor", "--json", "--plugin", plugin});
    INFO(plugin << result.err);
    CHECK(result.code == 3);
    const Json json = Json::parse(result.out);
    CHECK(json.at("problems").size() == 1);
    CHECK(json.at("plugins").at("left_out").back().at("asked_for") == true);
    CHECK(json.at("terminal").at("stdout") == false);
  }
}

TEST_CASE("doctor: drives and graphs are read with the plugins that they need") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  const std::string graph =
      write_text(folder + "a.graph", "GRAPH 1\nVERTEX_SE2 0 1 2 0\nEDGE_SAMPLE 0 3 4 1 0 1\n");
  const RunResult without = run({"doctor", drive, graph, folder + "gone.graph"});
  CHECK(without.code == 3);
  CHECK(contains(without.out, "problem: " + graph + ":3:1: unknown tag 'EDGE_SAMPLE'"));
  CHECK(contains(without.out, "gone.graph: cannot read: No such file or directory"));
  const RunResult with = run({"doctor", drive, graph, "--plugin", module_file("sound")});
  INFO(with.out);
  CHECK(with.code == 0);
  CHECK(contains(with.out, drive + ": 3 logs, all found"));
  CHECK(contains(with.out, graph + ": 1 vertices, 1 edges"));
  std::filesystem::remove(folder + "gnss.csv");
  const RunResult lost = run({"doctor", drive});
  CHECK(lost.code == 3);
  CHECK(contains(lost.out, "gnss.csv: this log does not exist"));
  write_text(folder + "broken.yaml", "plugins: [");
  CHECK(run({"doctor", folder + "broken.yaml"}).code == 3);
}

TEST_CASE("doctor: a drive and a graph from a pipe are read once, with the drive's plugins") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  write_text(drive, "folder: " + folder + "\nplugins: [" + module_file("sound") + "]\n" + read_text(drive));
  write_text(folder + "a.graph", "GRAPH 1\nVERTEX_SE2 0 1 2 0\nEDGE_SAMPLE 0 3 4 1 0 1\n");
  const RunResult result =
      run({"-c", "\"$0\" doctor <(cat drive.yaml) <(cat a.graph)", waymark_test::program_path()},
          {.folder = folder, .program = "/bin/bash"});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.out, ": 3 logs, all found"));
  CHECK(contains(result.out, ": 1 vertices, 1 edges"));
}

TEST_CASE("doctor: a solver that does not reach the minimum is named, and the exit code is 1") {
  const RunResult result = run({"doctor", "--plugin", module_file("broken_solver")});
  INFO(result.out);
  CHECK(result.code == 1);
  CHECK(contains(result.out, "refusing [sample]    FAILED: did not converge"));
  CHECK(contains(result.out, "problem: solver refusing: did not converge"));
}

TEST_CASE("doctor: a drive.yaml's plugin that is missing is a problem") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  write_text(drive, read_text(drive) + "\nplugins: [gone.so]\n");
  const RunResult result = run({"doctor", drive});
  CHECK(result.code == 3);
  CHECK(contains(result.out, "problem: plugin: " + folder + "gone.so: cannot read the plugin"));
}

TEST_CASE("doctor: a folder that cannot be written to is told, and none is left behind in one that can") {
  const std::string folder = fresh_folder();
  CHECK(run({"doctor"}, {.folder = folder}).code == 0);
  CHECK(names_in(folder).empty());
  const RunResult result = run({"doctor", "--json"}, {.folder = "/proc"});
  CHECK(result.code == 5);
  CHECK(Json::parse(result.out).at("folder").at("writable") == false);
}

TEST_CASE("doctor: what is known of the terminal") {
  const Variable no_color("NO_COLOR", "1");
  const Variable locale("LC_ALL", "C.UTF-8");
  const Json terminal = Json::parse(run({"doctor", "--json"}).out).at("terminal");
  CHECK(terminal.at("no_color") == true);
  CHECK(terminal.at("locale") == "C.UTF-8");
  CHECK(terminal.at("utf8") == true);
  CHECK(terminal.at("stdout") == false);
}

}  // namespace doctor_test

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include <waymark/core/base/detail/processor.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/detail/dense_kernels.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/doctor/doctor.hpp>
#include <waymark/tools/program/doctor/input_files.hpp>
#include <waymark/tools/program/doctor/libraries.hpp>
#include <waymark/tools/program/doctor/self_test.hpp>
#include <waymark/tools/program/jobs/plugin_list.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

using Json = nlohmann::ordered_json;

std::string environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

Json build_json() {
#if defined(__clang__)
  const char* compiler = "Clang " __clang_version__;
#else
  const char* compiler = "GCC " __VERSION__;
#endif
  const BuildTraits traits = build_traits();
  return {{"compiler", compiler},
          {"type", WAYMARK_BUILD_TYPE},
          {"plugin_abi", kPluginAbi},
          {"eigen_alignment", traits.eigen_max_align}};
}

Json processor_json() {
  Json features = Json::array();
  if (has_fused_multiply()) features.insert(features.end(), {"avx2", "fma"});
  if (has_wide_vectors()) features.push_back("avx512");
  return {{"threads", std::thread::hardware_concurrency()},
          {"features", features},
          {"kernels", dense_kernels().name}};
}

/// Returns the licence of the whole, and the libraries that cause it.
Json licence_json(const std::vector<Library>& libraries) {
  const LicenceTerms mode = licence_mode(libraries);
  Json because = Json::array();
  for (const Library& library : libraries) {
    if (mode != LicenceTerms::permissive && library.terms == mode) because.push_back(library.name);
  }
  return {{"own", "BSD-3-Clause"}, {"mode", to_string(mode)}, {"because", because}};
}

Json libraries_json(const std::vector<Library>& libraries) {
  Json json = Json::array();
  for (const Library& l : libraries)
    json.push_back({{"name", l.name}, {"version", l.version}, {"licence", l.licence}, {"use", l.use}});
  return json;
}

/// Adds the outcome of a test to its list, and to the problems if it failed.
template <typename Table>
Json tests_json(const std::vector<SelfTest>& tests, const Table& table, const char* what,
                Diagnosis& diagnosis) {
  Json json = Json::array();
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const SelfTest& test = tests[i];
    json.push_back({{"name", test.name},
                    {"origin", table[i].origin},
                    {"works", test.problem.empty()},
                    {"chi2", test.chi2},
                    {"problem", test.problem}});
    if (test.problem.empty()) continue;
    diagnosis.json["problems"].push_back(fmt::format("{} {}: {}", what, test.name, test.problem));
    diagnosis.code = kInternalError;
  }
  return json;
}

void worsen(Diagnosis& diagnosis, ExitCode code, const std::string& problem) {
  diagnosis.json["problems"].push_back(problem);
  if (diagnosis.code == kSuccess) diagnosis.code = code;
}

Json plugin_search_json(const PluginSearch& search, Diagnosis& diagnosis) {
  Json folders = Json::array();
  for (const PluginFolder& folder : search.folders) {
    folders.push_back({{"path", folder.path},
                       {"from", folder.installed ? "installation" : "WAYMARK_PLUGIN_PATH"},
                       {"problem", folder.problem}});
    if (!folder.installed && !folder.problem.empty())
      diagnosis.json["warnings"].push_back("no plugins from " + folder.path + ": " + folder.problem);
  }
  Json loaded = plugins_json(search.registry);
  // plugins with another one are not loaded
  for (Json& plugin : loaded) plugin["abi"] = kPluginAbi;
  Json left_out = Json::array();
  for (const PluginModule& module : search.modules) {
    if (module.state == PluginModule::State::loaded) continue;
    left_out.push_back({{"file", module.file}, {"asked_for", module.asked_for}, {"problem", module.problem}});
    if (module.asked_for) {
      worsen(diagnosis, kInputError, "plugin: " + module.problem);
    } else {
      diagnosis.json["warnings"].push_back("plugin left out: " + module.problem);
    }
  }
  return {{"variable", "WAYMARK_PLUGIN_PATH"},
          {"value", environment("WAYMARK_PLUGIN_PATH")},
          {"folders", folders},
          {"loaded", loaded},
          {"left_out", left_out}};
}

Json inputs_json(const std::vector<ReadInput>& inputs, const TypeRegistry& registry, Diagnosis& diagnosis) {
  Json json = Json::array();
  for (const ReadInput& input : inputs) {
    std::string holds;
    std::string problem;
    try {
      holds = describe_input(input, registry);
    } catch (const Error& error) {
      problem = error.what();
      worsen(diagnosis, kInputError, problem);
    }
    json.push_back({{"file", input.path}, {"holds", holds}, {"problem", problem}});
  }
  return json;
}

Json folder_json(Diagnosis& diagnosis) {
  std::error_code unknown;
  const std::string folder = std::filesystem::current_path(unknown).string();
  std::string problem;
  try {
    formats::try_to_write_in(".");
  } catch (const OutputError& error) {
    problem = error.what();
    worsen(diagnosis, kOutputError, "this folder cannot be written to: " + problem);
  }
  return {{"path", folder}, {"writable", problem.empty()}, {"problem", problem}};
}

/// Returns the locale that decides on characters: the first of these that is set.
std::string locale_name() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    if (const std::string value = environment(variable); !value.empty()) return value;
  }
  return "C";
}

Json terminal_json() {
  const auto is_terminal = [](int descriptor) { return ::isatty(descriptor) == 1; };
  winsize size{};
  const bool known =
      ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 || ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0;
  const std::string locale = locale_name();
  const std::string term = environment("TERM");
  return {{"stdout", is_terminal(STDOUT_FILENO)},
          {"stderr", is_terminal(STDERR_FILENO)},
          {"columns", known && size.ws_col > 0 ? Json(size.ws_col) : Json(nullptr)},
          {"term", term},
          {"no_color", !environment("NO_COLOR").empty()},
          {"locale", locale},
          {"utf8", locale.find("UTF-8") != std::string::npos || locale.find("utf8") != std::string::npos}};
}

}  // namespace

Diagnosis diagnose(const CommonOptions& options, const std::vector<std::string>& paths) {
  Diagnosis diagnosis;
  Json& json = diagnosis.json;
  json = {{"schema", "waymark-doctor"}, {"version", 1}, {"program_version", WAYMARK_VERSION}};
  json["problems"] = Json::array();
  json["warnings"] = Json::array();
  json["build"] = build_json();
  json["processor"] = processor_json();
  const std::vector<Library> libraries = built_in_libraries();
  json["licence"] = licence_json(libraries);
  json["libraries"] = libraries_json(libraries);
  const std::vector<ReadInput> inputs = read_inputs(paths);
  std::vector<std::string> wanted = options.plugins;
  for (std::string& plugin : plugins_of(inputs)) wanted.push_back(std::move(plugin));
  const PluginSearch search = search_plugins(wanted);
  const TypeRegistry& registry = search.registry;
  json["self_test"] = {{"minimum", known_problem().minimum}};
  json["self_test"]["solvers"] =
      tests_json(test_solvers(registry), registry.linear_solvers(), "solver", diagnosis);
  json["self_test"]["algorithms"] =
      tests_json(test_algorithms(registry), registry.algorithms(), "algorithm", diagnosis);
  json["plugins"] = plugin_search_json(search, diagnosis);
  json["inputs"] = inputs_json(inputs, registry, diagnosis);
  json["folder"] = folder_json(diagnosis);
  json["terminal"] = terminal_json();
  return diagnosis;
}

}  // namespace waymark::program

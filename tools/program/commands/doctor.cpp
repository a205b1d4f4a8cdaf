#include <waymark/tools/program/doctor/doctor.hpp>

#include <memory>

#include <fmt/format.h>

#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

using Json = nlohmann::ordered_json;

std::string words(const Json& list, const char* separator) {
  std::string text;
  for (const Json& word : list) text += (text.empty() ? "" : separator) + word.get<std::string>();
  return text;
}

std::string string_of(const Json& json, const char* key) {
  return json.at(key).get<std::string>();
}

std::string line(const std::string& label, const std::string& value) {
  return fmt::format("{:<12}{}\n", label, value);
}

std::string listed(const text::Table& table) {
  return text::indented(text::table_text(table), 2);
}

std::string program_text(const Json& json) {
  const Json& build = json["build"];
  const Json& processor = json["processor"];
  const Json& licence = json["licence"];
  const std::string features = words(processor["features"], " ");
  const std::string because = words(licence["because"], ", ");
  return line("waymark", string_of(json, "program_version")) +
         line("build", fmt::format("{}, {}; plugin ABI {}, Eigen's alignment {}",
                                   string_of(build, "compiler"), string_of(build, "type"),
                                   build["plugin_abi"].get<int>(), build["eigen_alignment"].get<int>())) +
         line("processor", fmt::format("{} threads; {}; kernels used: {}", processor["threads"].get<int>(),
                                       features.empty() ? "no vector extensions known" : features,
                                       string_of(processor, "kernels"))) +
         line("licence", "own code " + string_of(licence, "own") + "; as built: " +
                             string_of(licence, "mode") + (because.empty() ? "" : ", because of " + because));
}

std::string libraries_text(const Json& json) {
  text::Table table{.columns = {"library", "version", "use", "licence"}, .words = true};
  for (const Json& l : json["libraries"])
    table.rows.push_back(
        {string_of(l, "name"), string_of(l, "version"), string_of(l, "use"), string_of(l, "licence")});
  return "\nbuilt in\n" + listed(table);
}

std::string self_test_text(const Json& test) {
  text::Table table{.words = true};
  for (const char* kind : {"solvers", "algorithms"}) {
    for (const Json& entry : test[kind]) {
      const std::string origin = string_of(entry, "origin");
      table.rows.push_back({std::string(kind, std::string_view(kind).size() - 1),
                            string_of(entry, "name") + (origin == "waymark" ? "" : " [" + origin + "]"),
                            entry["works"].get<bool>() ? "works" : "FAILED: " + string_of(entry, "problem")});
    }
  }
  return fmt::format("\nself-test: a graph whose minimum is known, chi2 {:.10g}\n",
                     test["minimum"].get<double>()) +
         listed(table);
}

std::string plugins_text(const Json& plugins) {
  std::string text = "\nplugin folders, in the order in which they are searched\n";
  text::Table folders{.words = true};
  for (const Json& folder : plugins["folders"]) {
    folders.rows.push_back(
        {string_of(folder, "path"), string_of(folder, "from"), string_of(folder, "problem")});
  }
  text += listed(folders);
  if (string_of(plugins, "value").empty())
    text += "  " + string_of(plugins, "variable") + " is not set; it may name more, separated by ':'\n";
  text += "\nplugins: version, ABI, file, registered names\n";
  text::Table loaded{.words = true};
  for (const Json& plugin : plugins["loaded"])
    loaded.rows.push_back({string_of(plugin, "name"), string_of(plugin, "version"), plugin["abi"].dump(),
                           string_of(plugin, "place"), words(plugin["brings"], " ")});
  text += listed(loaded);
  for (const Json& module : plugins["left_out"]) text += "  left out: " + string_of(module, "problem") + "\n";
  return text;
}

std::string surroundings_text(const Json& json) {
  std::string text = "\n";
  for (const Json& input : json["inputs"]) {
    const std::string problem = string_of(input, "problem");
    text += line("input",
                 problem.empty() ? string_of(input, "file") + ": " + string_of(input, "holds") : problem);
  }
  const Json& folder = json["folder"];
  text +=
      line("folder", string_of(folder, "path") +
                         (folder["writable"].get<bool>() ? ": can be written to" : ": CANNOT be written to"));
  const Json& terminal = json["terminal"];
  const auto is_terminal = [&](const char* stream) {
    return std::string(terminal[stream].get<bool>() ? "" : "no ") + "terminal";
  };
  return text +
         line("terminal",
              fmt::format("output: {}, messages: {}, {} columns; TERM {}, NO_COLOR {}; "
                          "locale {}",
                          is_terminal("stdout"), is_terminal("stderr"),
                          terminal["columns"].is_null() ? "unknown" : terminal["columns"].dump(),
                          string_of(terminal, "term").empty() ? "not set" : string_of(terminal, "term"),
                          terminal["no_color"].get<bool>() ? "set" : "not set",
                          string_of(terminal, "locale")));
}

std::string verdict_text(const Json& json) {
  std::string text = "\n";
  for (const Json& warning : json["warnings"]) text += "warning: " + warning.get<std::string>() + "\n";
  for (const Json& problem : json["problems"]) text += "problem: " + problem.get<std::string>() + "\n";
  return text + (json["problems"].empty() ? "no problems found\n" : "");
}

struct DoctorOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
};

ExitCode examine(const DoctorOptions& options) {
  const Diagnosis diagnosis = diagnose(options.common, options.inputs);
  Console(options.common)
      .result(options.common.json ? json_text(diagnosis.json) : diagnosis_text(diagnosis.json));
  return diagnosis.code;
}

}  // namespace

std::string diagnosis_text(const Json& json) {
  return program_text(json) + libraries_text(json) + self_test_text(json["self_test"]) +
         plugins_text(json["plugins"]) + surroundings_text(json) + verdict_text(json);
}

void add_doctor(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "doctor",
      "Show how the program was built and test it here\n\n"
      "Prints version, compiler, processor, libraries with their licences, the licence of the "
      "program, and plugins with the folders that are searched. A plugin that cannot be loaded is "
      "listed with the reason. Every solver and algorithm must reach the known minimum of a small "
      "graph. A file is written to the current folder and removed again. Drives and graphs that are "
      "named are checked with all plugins.");
  const auto options = std::make_shared<DoctorOptions>();
  command->add_option("inputs", options->inputs, "Drives and graphs to check")->type_name("DRIVE.yaml|GRAPH");
  add_common_options(*command, options->common);
  command->footer(
      "The exit code is 1 if a solver or an algorithm fails, 3 if a requested plugin cannot be "
      "loaded or an input cannot be read, 5 if the folder cannot be written to.\n"
      "Example:\n  waymark doctor\n"
      "  waymark doctor --plugin ./my_sensor.so drive.yaml");
  command->callback([options, &action] { action = [options] { return examine(*options); }; });
}

}  // namespace waymark::program

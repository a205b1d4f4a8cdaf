#include <waymark/tools/program/jobs/conformance/conformance.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/graph/checks/vertex_type_check.hpp>
#include <waymark/tools/program/jobs/conformance/trials.hpp>
#include <waymark/tools/program/jobs/graph/derivatives.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

/// Returns the names of the plugins that come from some files.
std::set<std::string> plugins_in(std::span<const std::string> files, const TypeRegistry& registry) {
  std::set<std::string> names;
  for (const PluginRecord& plugin : registry.plugins()) {
    const bool wanted = std::any_of(files.begin(), files.end(), [&](const std::string& file) {
      std::error_code none;
      return plugin.name == file || std::filesystem::equivalent(plugin.place, file, none);
    });
    if (wanted) names.insert(plugin.name);
  }
  return names;
}

/// Tries what the types of graphs promise.
std::vector<Trial> try_types(const TypeRegistry& registry, const Wanted& wanted) {
  std::vector<Trial> trials;
  const auto add = [&](const char* kind, const std::string& name, const std::string& origin,
                       const auto& steps) {
    if (wanted(origin)) run_trial(trials.emplace_back(Trial{kind, name, origin, {}, {}}), steps);
  };
  for (const auto& entry : registry.vertices())
    add("vertex type", entry.type.tag, entry.origin,
        [&](Trial& trial) { trial.problems = broken_promises(entry.type); });
  for (const auto& entry : registry.edges())
    add("edge type", entry.type.tag, entry.origin, [&](Trial& trial) {
      const EdgeTypeCheck check = check_edge_type(registry, entry.type);
      if (!check.sound()) trial.problems.push_back(problem_of(check, entry.type.tag, entry.origin));
    });
  for (const auto& entry : registry.losses())
    add("loss", entry.type.name, entry.origin,
        [&](Trial& trial) { trial.problems = broken_promises(entry.type); });
  return trials;
}

}  // namespace

ConformanceReport check_conformance(const TypeRegistry& registry, std::span<const std::string> files,
                                    const text::TextLook& look) {
  const std::set<std::string> plugins = plugins_in(files, registry);
  const Wanted wanted = [&](const std::string& origin) { return files.empty() || plugins.contains(origin); };
  std::vector<Trial> trials;
  for (auto* kit : {&try_types, &try_solvers, &try_models, &try_readers})
    for (Trial& trial : (*kit)(registry, wanted)) trials.push_back(std::move(trial));

  ConformanceReport report;
  report.json = nlohmann::ordered_json::array();
  text::Table table{.columns = {"type", "kind", "from", "result", "note"}};
  std::string problems;
  for (const Trial& trial : trials) {
    const bool passed = trial.problems.empty();
    table.rows.push_back({trial.name, trial.kind, trial.origin, passed ? "passed" : "WRONG", trial.note});
    if (!passed) table.tones[{table.rows.size() - 1, 3}] = text::Tone::error;
    for (const std::string& problem : trial.problems)
      problems += fmt::format("problem: {} '{}' of {}: {}\n", trial.kind, trial.name, trial.origin, problem);
    report.passed = report.passed && passed;
    report.json.push_back({{"kind", trial.kind},
                           {"name", trial.name},
                           {"origin", trial.origin},
                           {"passed", passed},
                           {"problems", trial.problems},
                           {"note", trial.note}});
  }
  report.text =
      trials.empty() ? "nothing to try: the plugin registers nothing\n" : text::table_text(table, look);
  report.text += report.passed ? "no problems found\n" : problems;
  return report;
}

}  // namespace waymark::program

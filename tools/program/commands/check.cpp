#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/graph/checks/finite_check.hpp>
#include <waymark/core/graph/checks/gradient_check.hpp>
#include <waymark/core/graph/checks/relative_check.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/graph/graph_text.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/conformance/conformance.hpp>
#include <waymark/tools/program/jobs/graph/derivatives.hpp>
#include <waymark/tools/program/jobs/graph/graph_files.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

struct CheckOptions {
  CommonOptions common;
  std::string input;
  bool derivatives = false;
  bool all = false;
  std::string input_format = "graph";
};

constexpr std::size_t kCheckedEdges = 50;  // per type

/// Checks every registered edge type without a graph.
ExitCode check_types(const CheckOptions& options, const TypeRegistry& registry) {
  const Console console(options.common);
  const DerivativeReport report = check_derivatives(registry, console.look());
  std::string text = report.text;
  for (const std::string& problem : report.problems) text += "problem: " + problem + "\n";
  if (report.problems.empty()) text += "no problems found\n";
  const nlohmann::ordered_json json = {{"derivatives", report.json}, {"problems", report.problems}};
  console.result(options.common.json ? json_document("derivatives", json) : text);
  return report.problems.empty() ? kSuccess : kInputError;
}

/// Tries every type of the plugins that are named; without --plugin, of all.
ExitCode check_kit(const CheckOptions& options, const TypeRegistry& registry) {
  const Console console(options.common);
  const ConformanceReport report = check_conformance(registry, options.common.plugins, console.look());
  console.result(options.common.json ? json_document("conformance", {{"conformance", report.json}})
                                     : report.text);
  return report.passed ? kSuccess : kInputError;
}

ExitCode check_file(const CheckOptions& options, const TypeRegistry& registry) {
  const Console console(options.common);
  formats::ReadReport report;
  constexpr bool kLenient = true;  // reports the first ten wrong lines, not only one
  const formats::GraphDocument document = formats::read_graph_as(
      *formats::graph_format_from_string(options.input_format),
      formats::read_graph_text(options.input, registry), options.input, registry, kLenient, &report);
  const Graph& graph = document.graph;
  std::vector<std::string> problems = report.examples;
  if (report.skipped > problems.size()) {
    problems.push_back(fmt::format("{} more wrong lines", report.skipped - problems.size()));
  }
  nlohmann::ordered_json json = {{"file", options.input}, {"vertices", graph.vertex_count()}};
  json["edges"] = nlohmann::ordered_json::array();
  json["notes"] = nlohmann::ordered_json::array();
  std::string text = fmt::format("{}: {} vertices, {} edges, {} GNSS records\n", options.input,
                                 graph.vertex_count(), graph.edge_count(), document.fixes.size());
  text::Table table{.columns = {"edge type", "edges", "chi2", "error", "Jacobians off by"}};
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    stop_if_interrupted();
    console.progress("derivatives of " + graph.edge_type(b).tag);
    const GradientCheck gradients = check_gradients(graph, b, kCheckedEdges);
    const EdgeType& type = graph.edge_type(b);
    table.rows.push_back({type.tag, std::to_string(graph.batch(b).size()),
                          fmt::format("{:.8g}", graph.batch(b).chi2(graph.view())), type.form,
                          fmt::format("{:.1e}", gradients.error)});
    json["edges"].push_back({{"type", type.tag},
                             {"count", graph.batch(b).size()},
                             {"chi2", text::number_or_null(graph.batch(b).chi2(graph.view()))},
                             {"jacobian_error", gradients.error}});
    if (gradients.error > kGradientTolerance) problems.push_back(describe(graph, b, gradients));
    const RelativeCheck relative = check_relative(graph, b, kCheckedEdges);
    if (relative.error > kRelativeTolerance) problems.push_back(describe(graph, b, relative));
  }
  if (!table.rows.empty()) text += text::table_text(table, console.look());
  if (const auto flaw = find_not_finite(graph)) problems.push_back(*flaw);
  console.progress("factorising");
  try {
    (void)marginal_covariances(graph, {});  // this factorises without damping
    for (const std::string& message : find_gauge(graph).messages) {
      text += "note: " + message + "\n";
      json["notes"].push_back(message);
    }
  } catch (const InputError& error) {
    problems.push_back(error.what());
  }
  for (const std::string& problem : problems) text += "problem: " + problem + "\n";
  if (problems.empty()) text += "no problems found\n";
  json["problems"] = problems;
  console.result(options.common.json ? json_document("check", json) : text);
  return problems.empty() ? kSuccess : kInputError;
}

ExitCode check(const CheckOptions& options) {
  const TypeRegistry registry = make_registry(options.common);
  if (options.all) {
    if (!options.input.empty())
      throw UsageError("--all tries the registered types without a graph; leave out " + options.input);
    return check_kit(options, registry);
  }
  if (options.derivatives) {
    if (!options.input.empty())
      throw UsageError("--derivatives checks the types without a graph; leave out " + options.input);
    return check_types(options, registry);
  }
  if (options.input.empty())
    throw UsageError("a graph is required (or --derivatives or --all, to check types)");
  return check_file(options, registry);
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("check",
                         "Check a graph file: lines, gauge, Jacobians\n\n"
                         "Reads every line, compares the Jacobians with differences of the errors "
                         "and looks for vertices that the edges do not determine. The exit code is "
                         "3 if there is a problem.");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("graph", options->input, "Graph file: .graph, g2o, or as --input-format says")
      ->type_name("GRAPH");
  add_input_format(*command, options->input_format);
  command->add_flag("--derivatives", options->derivatives,
                    "Check the Jacobians of every registered edge type instead of a "
                    "graph, plugins included");
  command->add_flag("--all", options->all,
                    "Try everything that the plugins of --plugin register (without --plugin: everything that "
                    "is registered): derivatives and promises, solvers, algorithms, initial guesses, models, "
                    "log readers");
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark check drive.graph\n  waymark check --plugin ./my_sensor.so --all");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace waymark::program

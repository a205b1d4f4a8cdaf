#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/formats/graph/graph_text.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/evaluation/output/summary_json.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/graph/covariance.hpp>
#include <waymark/tools/program/jobs/graph/graph_files.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/graph/robust.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct OptimizeOptions {
  CommonOptions common;
  drive::Minimization minimization;
  RobustChoice robust;
  std::string input;
  std::string output;
  std::string covariance_file;
  std::string input_format = "graph";
  OutputFormat format;
  bool lenient = false;
};

/// A minimum of least squares with a few wrong edges is the minimum, and wrong.
void warn_of_wrong_edges(const Summary& summary, const Graph& graph, bool is_graduated,
                         const Console& console) {
  constexpr double kFar = 4;
  const double plausible = plausible_chi2(graph);
  if (!summary.converged() || !(summary.final_chi2 > kFar * plausible) || has_losses(graph)) return;
  console.warning(fmt::format(
      "chi2 is {:.4g} at the minimum, where edges that are as good as they say have at most {:.4g}: some edges are "
      "wrong{}, all of them say too much, or a lower minimum exists (try another --start or --algorithm)",
      summary.final_chi2, plausible, is_graduated ? "" : " (try --loss cauchy:1, or --robust gnc)"));
}

ExitCode optimize_file(const OptimizeOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry = make_registry(options.common);
  drive::check_minimization(options.minimization, registry);
  check_robust(options.robust, registry);
  require_output_place(options.output);
  check_covariance_file(options.covariance_file, options.minimization.covariances);
  console.progress("reading " + options.input);
  formats::GraphDocument document =
      read_graph_file(formats::read_graph_text(options.input, registry), options.input, options.input_format,
                      options.lenient, registry, console);
  attach_losses(document.graph, options.robust, registry);
  announce_output(options.format, document, options.input, console);  // before the work
  stop_if_interrupted();

  std::optional<Graduated> graduated;
  const Minimizer minimizer = options.robust.method == "gnc"
                                  ? graduating_minimizer(options.robust, registry, graduated)
                                  : Minimizer();
  const MultiStartSummary result =
      optimize_document(document, options.minimization, registry, console, minimizer);
  record_optimization(result, document);
  warn_of_wrong_edges(result.summary, document.graph, graduated.has_value(), console);
  if (graduated) {
    for (const std::string& note : graduated->notes) warn(note, document, console);
    document.provenance.emplace_back(
        "outliers", std::to_string(graduated->result.outliers.size()) + " edges left out by gnc");
    if (!options.robust.outliers.empty()) {
      formats::write_file_atomically(options.robust.outliers, graduated->outlier_lines);
    }
  }
  const std::vector<evaluation::StateReport> states = states_of_minimum(document, result.summary, console);
  const bool to_stdout = is_stdout(options.output) || is_stdout(options.robust.outliers);
  write_graph_file(options.output, options.format, document, options.input, registry);
  std::string written = options.output;
  if (!options.covariance_file.empty()) {
    if (document.covariances.empty()) console.note(options.covariance_file + " has no covariances");
    write_covariances(options.covariance_file, document, result.summary);
    written += " " + options.covariance_file;
  }
  if (options.common.json) {
    nlohmann::ordered_json json = evaluation::summary_json(result);
    json["states"] = evaluation::states_json(states);
    if (graduated) json["graduation"] = graduation_json(*graduated);
    console.result(json_document("optimize", json), to_stdout);
  } else {
    const std::string outliers = graduated ? graduation_text(graduated->result) : "";
    console.result(result.full() + evaluation::states_text(states, console.look(to_stdout)) + outliers +
                       "written     " + written + "\n",
                   to_stdout);
  }
  return exit_code(result.summary);
}

}  // namespace

void add_optimize(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "optimize",
      "Minimise chi2 of a graph\n\n"
      "Reads a graph, finds the poses with the smallest chi2 and writes the graph with them. It "
      "reports whether a minimum was reached. If the graph has neither a fixed vertex nor a prior, "
      "the first vertex is held. A note says so; the file that is written gets no FIX.");
  const auto options = std::make_shared<OptimizeOptions>();
  command->add_option("graph", options->input, "Graph file: .graph, g2o, or as --input-format says")
      ->required()
      ->type_name("GRAPH");
  command->add_option("-o,--output", options->output, "File to write ('-': standard output)")
      ->required()
      ->type_name("FILE");
  add_input_format(*command, options->input_format);
  add_output_format(*command, options->format, false);
  options->minimization.start = "auto";
  command
      ->add_option("--start", options->minimization.start,
                   "Initial guess: 'file' (the values of the file), one that `waymark info` lists, "
                   "or 'auto': the most promising one, and others if the minimum "
                   "found is implausible")
      ->type_name("START|file|auto")
      ->capture_default_str();
  command->add_flag("--lenient", options->lenient, "Skip and count wrong lines");
  add_optimization_options(*command, options->minimization);
  {
    const OptionHeading heading(*command, "Optimisation");
    command
        ->add_option("--covariance-file", options->covariance_file,
                     "The covariances as a table too: FILE.csv or FILE.json")
        ->type_name("FILE.csv|FILE.json");
  }
  add_robust_options(*command, options->robust);
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark optimize drive.graph -o fused.graph --algorithm dogleg");
  command->callback([options, &action] { action = [options] { return optimize_file(*options); }; });
}

}  // namespace waymark::program

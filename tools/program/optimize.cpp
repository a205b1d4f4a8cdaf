#include <waymark/core/error.hpp>
#include <waymark/formats/text_file.hpp>
#include <waymark/tools/program/commands.hpp>
#include <waymark/tools/program/drive_options.hpp>
#include <waymark/tools/program/output.hpp>
#include <waymark/tools/program/robust.hpp>

namespace waymark {
namespace {

struct OptimizeOptions {
  CommonOptions common;
  OptimizationChoice choice;
  RobustChoice robust;
  std::string input;
  std::string output;
  std::string format = "graph";
  std::string start = "file";
  bool lenient = false;
};

ExitCode optimize_file(const OptimizeOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry = make_registry(options.common);
  check_choice(options.choice, registry);
  check_robust(options.robust, registry);
  require_output_place(options.output);
  ReadReport report;
  console.progress("reading " + options.input);
  GraphDocument document =
      read_graph(read_text_file(options.input), options.input, registry, options.lenient, &report);
  if (report.skipped > 0) {
    console.note("warning: " + std::to_string(report.skipped) + " lines were skipped; the first ones:");
    for (const std::string& example : report.examples) console.note("  " + example);
  }
  if (report.edges_only) console.note("note: the file has edges only; started along the odometry chain");
  if (options.start == "odometry") report.unreached = start_from_odometry_chain(document.graph);
  if (report.unreached > 0) {
    console.note(
        "note: " + std::to_string(report.unreached) +
        " vertices are not reached by relative edges (EDGE_SE2, EDGE_SE2_LOG) and start where they are");
  }
  attach_losses(document.graph, options.robust, registry);
  const bool g2o = options.format == "g2o";
  if (g2o) check_g2o(document);  // before the work
  if (g2o && (document.frame || !document.fixes.empty())) {
    console.note("note: g2o has no place for the frame, stamps and GNSS records; they are left out");
  }
  stop_if_interrupted();

  std::optional<Graduated> graduated;
  const Minimizer minimizer = options.robust.method == "gnc"
                                  ? graduating_minimizer(options.robust, registry, graduated)
                                  : Minimizer(&optimize);
  const Summary summary = optimize_document(document, options.choice, registry, console, minimizer);
  document.provenance.emplace_back("optimized", describe_optimization(summary));
  if (graduated) {
    document.provenance.emplace_back(
        "outliers", std::to_string(graduated->result.outliers.size()) + " edges left out by gnc");
    if (!options.robust.outliers.empty()) {
      write_file_atomically(options.robust.outliers, graduated->outlier_lines);
    }
  }
  const bool to_stdout = is_stdout(options.output) || is_stdout(options.robust.outliers);
  write_file_atomically(options.output, [&](const TextSink& sink) {
    g2o ? write_g2o(document, sink) : write_graph(document, registry, sink);
  });
  if (options.common.json) {
    nlohmann::ordered_json json = summary_json(summary);
    if (graduated) json["graduation"] = graduation_json(*graduated);
    console.result(json_text(json), to_stdout);
  } else {
    const std::string outliers = graduated ? graduation_text(graduated->result) : "";
    console.result(summary_text(summary) + outliers + "written     " + options.output + "\n", to_stdout);
  }
  return exit_code(summary);
}

}  // namespace

void add_optimize(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("optimize", "Minimise chi2 of a graph");
  const auto options = std::make_shared<OptimizeOptions>();
  command->add_option("graph", options->input, ".graph or g2o file")->required();
  command->add_option("-o,--output", options->output, "File to write ('-': standard output)")->required();
  command->add_option("--format", options->format, "Format to write")
      ->check(CLI::IsMember({"graph", "g2o"}))
      ->capture_default_str();
  command->add_option("--start", options->start, "Start from the file's values or from the odometry chain")
      ->check(CLI::IsMember({"file", "odometry"}))
      ->capture_default_str();
  command->add_flag("--lenient", options->lenient, "Skip and count wrong lines");
  add_optimization_options(*command, options->choice);
  add_robust_options(*command, options->robust);
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark optimize drive.graph -o fused.graph --algorithm dogleg");
  command->callback([options, &action] { action = [options] { return optimize_file(*options); }; });
}

}  // namespace waymark

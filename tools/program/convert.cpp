#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/error.hpp>
#include <waymark/formats/text_file.hpp>
#include <waymark/tools/program/commands.hpp>
#include <waymark/tools/program/drive_options.hpp>
#include <waymark/tools/program/output.hpp>
#include <waymark/tools/program/program_registry.hpp>

namespace waymark {
namespace {

struct ConvertOptions {
  CommonOptions common;
  DriveOverrides overrides;
  std::string input;
  std::string output;
};

ExitCode convert(const ConvertOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry = make_registry_for(options.input, options.common);
  require_output_place(options.output);
  const LoadedDrive loaded = load_drive_for(options.input, options.overrides, registry, console);
  if (loaded.modelings.size() != 1)
    throw UsageError("convert writes one graph: name one modeling ('run' takes many)");
  const GraphDocument document =
      build_document(loaded, loaded.modelings.front(),
                     known_options(loaded.modelings.front(), options.overrides, registry), registry);
  stop_if_interrupted();
  write_file_atomically(options.output, [&](const TextSink& sink) { write_graph(document, registry, sink); });
  if (options.common.json) {
    const GateSummary& gate = loaded.skeleton.gate;
    const nlohmann::ordered_json json = {{"output", options.output},
                                         {"modeling", loaded.modelings.front()},
                                         {"vertices", document.graph.vertex_count()},
                                         {"edges", document.graph.edge_count()},
                                         {"fixes", document.fixes.size()},
                                         {"accepted", gate.accepted},
                                         {"rejected", gate.rejected},
                                         {"withheld", gate.withheld},
                                         {"reasons", gate.reasons},
                                         {"distance_m", loaded.skeleton.distance_m},
                                         {"start_chi2", document.graph.chi2()}};
    console.result(json_text(json), is_stdout(options.output));
    return kSuccess;
  }
  console.result(describe_drive(loaded) + fmt::format("written     {}: {} vertices, {} edges, modeling {}\n",
                                                      options.output, document.graph.vertex_count(),
                                                      document.graph.edge_count(), loaded.modelings.front()),
                 is_stdout(options.output));
  return kSuccess;
}

}  // namespace

void add_convert(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("convert", "Raw logs to a .graph file");
  const auto options = std::make_shared<ConvertOptions>();
  command->add_option("drive", options->input, "Description of the drive and its logs (drive.yaml)")
      ->required();
  command->add_option("-o,--output", options->output, "Graph file to write ('-': standard output)")
      ->required();
  add_drive_options(*command, options->overrides);
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark convert drive.yaml -o drive.graph --modeling g2");
  command->callback([options, &action] { action = [options] { return convert(*options); }; });
}

}  // namespace waymark

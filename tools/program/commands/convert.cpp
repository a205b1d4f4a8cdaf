#include <filesystem>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/graph/graph_text.hpp>
#include <waymark/formats/text/hash.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/drive/drive_job.hpp>
#include <waymark/tools/program/jobs/drive/drive_text.hpp>
#include <waymark/tools/program/jobs/graph/graph_files.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/jobs/trajectory_files.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

struct ConvertOptions {
  CommonOptions common;
  DriveChoice choice;
  std::string input;
  std::string output;
  std::string input_format = "graph";
  OutputFormat format;
  bool lenient = false;
  std::vector<std::string> of_drives;  ///< given options that apply only to logs
  std::vector<std::string> of_graphs;  ///< given options that apply only to graph files
};

void refuse_options(const std::vector<std::string>& given, const std::string& what) {
  if (given.empty()) return;
  const std::vector<std::string_view> names(given.begin(), given.end());
  throw UsageError(joined(names) + ": the input is " + what +
                   " (a file whose name ends in .yaml or .yml is a drive, any other a graph)");
}

/// Returns "graph", or "g2o for GTSAM's load2D".
std::string describe(const OutputFormat& output) {
  const std::string format(to_string(chosen_format(output)));
  const formats::Recipient* profile = formats::find_profile(output.profile);
  return profile == nullptr ? format : format + " for " + std::string(profile->reader);
}

nlohmann::ordered_json graph_json(const ConvertOptions& options, const formats::GraphDocument& document) {
  return {{"output", options.output},
          {"format", to_string(chosen_format(options.format))},
          {"vertices", document.graph.vertex_count()},
          {"edges", document.graph.edge_count()},
          {"fixes", document.fixes.size()}};
}

ExitCode convert_drive(const ConvertOptions& options, const drive::DriveFile& file,
                       const TypeRegistry& registry, const Console& console) {
  refuse_options(options.of_graphs, "a drive");
  const LoadedDrive loaded = load_drive_for(file, options.choice, registry, console);
  if (loaded.settings.size() != 1)
    throw UsageError("convert writes one graph: name one modeling ('run' takes several)");
  const std::string& modeling = loaded.settings.front().modeling;
  require_not_read(options.output, loaded.files);
  drive::Fusion fusion(loaded.drive, registry, stop_if_interrupted);
  std::set<std::string> told;
  const drive::ModeledDrive modeled = at_drive(
      loaded, [&] { return model_loaded(fusion, loaded.settings.front(), registry, console, told); });
  const formats::GraphDocument& document = modeled.document;
  stop_if_interrupted();
  announce_output(options.format, document, options.input, console);
  write_graph_file(options.output, options.format, document, options.input, registry);
  if (options.common.json) {
    const drive::GateSummary& gate = modeled.placed.gate;
    nlohmann::ordered_json json = graph_json(options, document);
    json["modeling"] = modeling;
    json["accepted"] = gate.accepted;
    json["rejected"] = gate.rejected;
    json["withheld"] = gate.withheld;
    json["reasons"] = gate.reasons;
    json["distance_m"] = modeled.distance_m;
    json["noise"] = noise_json(modeled.noise);
    json["start_chi2"] = document.graph.chi2();
    console.result(json_document("convert", json), is_stdout(options.output));
    return kSuccess;
  }
  console.result(describe_drive(loaded.drive) +
                     describe_model(modeled, console.look(is_stdout(options.output))) +
                     fmt::format("written     {}: {} vertices, {} edges, modeling {}\n", options.output,
                                 document.graph.vertex_count(), document.graph.edge_count(), modeling),
                 is_stdout(options.output));
  return kSuccess;
}

/// A stated format is that of a graph, whatever the file is called.
bool is_trajectory(const ConvertOptions& options) {
  return options.format.format.empty() && options.format.profile.empty() &&
         is_trajectory_file(options.output);
}

ExitCode write_trajectory(const ConvertOptions& options, const formats::GraphDocument& document,
                          const Console& console) {
  const std::size_t poses = write_trajectory_file(document, options.output);
  if (options.common.json) {
    nlohmann::ordered_json json = graph_json(options, document);
    json["format"] = "trajectory";
    json["poses"] = poses;
    console.result(json_document("convert", json), false);
    return kSuccess;
  }
  console.result(fmt::format("written     {}: {} poses\n", options.output, poses), false);
  return kSuccess;
}

ExitCode convert_graph(const ConvertOptions& options, const TypeRegistry& registry, const Console& console) {
  refuse_options(options.of_drives, "a graph file");
  console.progress("reading " + options.input);
  const std::string text = formats::read_graph_text(options.input, registry);
  formats::GraphDocument document =
      read_graph_file(text, options.input, options.input_format, options.lenient, registry, console);
  stop_if_interrupted();
  if (is_trajectory(options)) return write_trajectory(options, document, console);
  announce_output(options.format, document, options.input, console);
  document.provenance.emplace_back("converted",
                                   fmt::format("waymark {} from {} fnv1a64:{} read as {}", WAYMARK_VERSION,
                                               std::filesystem::path(options.input).filename().string(),
                                               formats::fnv1a64_hex(text), options.input_format));
  write_graph_file(options.output, options.format, document, options.input, registry);
  if (options.common.json) {
    nlohmann::ordered_json json = graph_json(options, document);
    json["input_format"] = options.input_format;
    if (!options.format.profile.empty()) json["profile"] = options.format.profile;
    json["chi2"] = document.graph.chi2();
    console.result(json_document("convert", json), is_stdout(options.output));
    return kSuccess;
  }
  console.result(fmt::format("written     {}: {} vertices, {} edges, chi2 {:.10g}, format {}\n",
                             options.output, document.graph.vertex_count(), document.graph.edge_count(),
                             document.graph.chi2(), describe(options.format)),
                 is_stdout(options.output));
  return kSuccess;
}

ExitCode convert(const ConvertOptions& options) {
  const Console console(options.common);
  std::optional<drive::DriveFile> file;
  if (drive::is_drive_file(options.input)) file = read_drive_file(options.input, options.choice);
  const TypeRegistry registry =
      make_registry(options.common, file ? file->description.plugins : std::vector<std::string>());
  (void)chosen_format(options.format);
  if (file && is_trajectory(options))
    throw UsageError(
        "a trajectory is written from an optimised graph: name a .graph file in place of the drive");
  require_output_place(options.output);
  return file ? convert_drive(options, *file, registry, console) : convert_graph(options, registry, console);
}

/// Returns the options that `add` adds to a command.
template <typename Add>
std::vector<const CLI::Option*> added_by(CLI::App& command, Add add) {
  const std::size_t before = command.get_options().size();
  add();
  const std::vector<CLI::Option*> all = command.get_options();
  return {all.begin() + static_cast<std::ptrdiff_t>(before), all.end()};
}

/// Returns the names of those that are on the command line.
std::vector<std::string> given_of(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> given;
  for (const CLI::Option* option : options) {
    if (option->count() > 0) given.push_back(option->get_name());
  }
  return given;
}

}  // namespace

void add_convert(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "convert",
      "Convert raw logs to a graph file, or a graph file to another format\n\n"
      "For a drive.yaml it reads the logs, puts them on one clock and into one "
      "frame, checks the fixes and writes the graph. A graph file is written in "
      "another format. It is refused if its minimum would move in that format. "
      "Statements that the format lacks are left out and counted. An output that ends "
      "in .bag (ROS 1), .mcap (ROS 2), .tum or .kitti (evo) gets the trajectory of a graph.");
  const auto options = std::make_shared<ConvertOptions>();
  command->add_option("input", options->input, "drive.yaml of a drive, or a graph file (any other name)")
      ->required()
      ->type_name("DRIVE.yaml|GRAPH");
  command->add_option("-o,--output", options->output, "Graph file to write ('-': standard output)")
      ->required()
      ->type_name("FILE");
  const auto of_graphs = added_by(*command, [&] {
    add_input_format(*command, options->input_format);
    command->add_flag("--lenient", options->lenient, "Skip and count wrong lines of a graph file");
  });
  add_output_format(*command, options->format, true);
  const auto of_drives = added_by(*command, [&] { add_drive_options(*command, options->choice); });
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n  waymark convert drive.yaml -o drive.graph --modeling g2\n"
      "  waymark convert toro.graph --input-format toro -o for_gtsam.g2o --profile gtsam\n"
      "  waymark convert fused.graph -o fused.bag");
  command->callback([options, of_drives, of_graphs, &action] {
    options->of_drives = given_of(of_drives);
    options->of_graphs = given_of(of_graphs);
    action = [options] { return convert(*options); };
  });
}

}  // namespace waymark::program

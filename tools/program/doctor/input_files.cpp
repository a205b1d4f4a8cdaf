#include <filesystem>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/doctor/input_files.hpp>

namespace waymark::program {
namespace {

std::string describe_graph(const ReadInput& input, const TypeRegistry& registry) {
  const formats::GraphDocument document = formats::read_graph(input.graph, input.path, registry);
  return fmt::format("{} vertices, {} edges, every tag is known", document.graph.vertex_count(),
                     document.graph.edge_count());
}

std::string describe_drive_file(const drive::DriveFile& file, const TypeRegistry& registry) {
  const drive::DriveDescription& drive = file.description;
  std::vector<drive::LogConfig> logs;
  for (const drive::OdometryConfig& odometry : drive.odometry)
    logs.insert(logs.end(), odometry.logs.begin(), odometry.logs.end());
  logs.insert(logs.end(), drive.gnss.begin(), drive.gnss.end());
  if (drive.truth) logs.push_back(*drive.truth);
  for (const drive::SensorConfig& sensor : drive.sensors) {
    if (sensor.log) logs.push_back(*sensor.log);
  }
  for (const drive::LogConfig& log : logs) {
    std::error_code unknown;
    if (!std::filesystem::exists(log.file, unknown))
      throw InputError(log.place + log.file + ": this log does not exist");
  }
  (void)registry.gnss_modeling(file.settings.modeling);
  return fmt::format("{} logs, all found (`waymark inspect` reads them); modeling {}", logs.size(),
                     file.settings.modeling);
}

}  // namespace

std::vector<ReadInput> read_inputs(const std::vector<std::string>& paths) {
  std::vector<ReadInput> inputs;
  for (const std::string& path : paths) {
    ReadInput& input = inputs.emplace_back();
    input.path = path;
    try {
      std::string text = formats::read_text_file(path, {.check = formats::require_digits(path)});
      if (drive::is_drive_text(path, text)) {
        input.drive = drive::parse_drive_file(text, path);
      } else {
        input.graph = std::move(text);
      }
    } catch (const Error& error) {
      input.problem = error.what();
    }
  }
  return inputs;
}

std::vector<std::string> plugins_of(const std::vector<ReadInput>& inputs) {
  std::vector<std::string> all;
  for (const ReadInput& input : inputs) {
    if (!input.drive) continue;
    const std::vector<std::string>& plugins = input.drive->description.plugins;
    all.insert(all.end(), plugins.begin(), plugins.end());
  }
  return all;
}

std::string describe_input(const ReadInput& input, const TypeRegistry& registry) {
  if (!input.problem.empty()) throw InputError(input.problem);
  return input.drive ? describe_drive_file(*input.drive, registry) : describe_graph(input, registry);
}

}  // namespace waymark::program

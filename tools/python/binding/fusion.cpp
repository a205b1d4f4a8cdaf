#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/logs/memory_log.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/python/binding/choices.hpp>
#include <waymark/tools/python/binding/fused.hpp>
#include <waymark/tools/python/binding/host.hpp>
#include <waymark/tools/python/binding/numpy.hpp>

namespace waymark::python {
namespace {

using program::DriveChoice;
using Logs = std::map<std::string, std::shared_ptr<const drive::MemoryLog>>;

constexpr const char* kMemory = "memory://";  // begins the `file` of a log that is in memory

/// Converts seconds, which a log of numbers has. @throws InputError for one that is no time
std::vector<Stamp> stamps_from_seconds(const std::string& name, const Numbers& seconds) {
  constexpr double kLargest = 9.2e9;  // of int64 nanoseconds
  std::vector<Stamp> stamps;
  const double* numbers = seconds.data();
  for (py::ssize_t i = 0; i < seconds.size(); ++i) {
    if (!(std::abs(numbers[i]) < kLargest))
      throw InputError(fmt::format("{}:{}: {} is no time in seconds", name, i + 1, numbers[i]));
    stamps.push_back(Stamp::from_seconds(numbers[i]));
  }
  return stamps;
}

std::vector<Stamp> stamps_from_nanoseconds(const Integers& nanoseconds) {
  std::vector<Stamp> stamps;
  for (py::ssize_t i = 0; i < nanoseconds.size(); ++i) stamps.push_back({nanoseconds.data()[i]});
  return stamps;
}

/// Takes a log from arrays. They are copied once, because the job works without the lock of the
/// interpreter and Python may change them.
std::shared_ptr<const drive::MemoryLog> log_of(const std::string& name, const py::dict& columns) {
  auto log = std::make_shared<drive::MemoryLog>();
  for (const auto& [key, array] : columns) {
    const auto column = py::cast<std::string>(key);
    if (column == "time") {
      log->stamps = stamps_from_seconds(name, py::cast<Numbers>(array));
    } else if (column == "time_ns") {
      log->stamps = stamps_from_nanoseconds(py::cast<Integers>(array));
    } else {
      const auto numbers = py::cast<Numbers>(array);
      log->columns[column] = {numbers.data(), numbers.data() + numbers.size()};
    }
  }
  return log;
}

Logs logs_of(const py::dict& given) {
  Logs logs;
  for (const auto& [key, columns] : given) {
    const auto name = py::cast<std::string>(key);
    logs[name] = log_of(name, py::cast<py::dict>(columns));
  }
  return logs;
}

/// Puts the samples into a log that is in memory.
void fill(drive::LogConfig& log, const Logs& logs) {
  if (!log.file.starts_with(kMemory)) return;
  log.file = log.file.substr(std::string_view(kMemory).size());
  log.samples = logs.at(log.file);
}

void fill(drive::DriveDescription& description, const Logs& logs) {
  for (drive::OdometryConfig& source : description.odometry)
    for (drive::LogConfig& log : source.logs) fill(log, logs);
  for (drive::GnssConfig& source : description.gnss) {
    fill(source, logs);
    if (source.velocity) fill(*source.velocity, logs);
  }
  if (description.truth) fill(*description.truth, logs);
  for (drive::SensorConfig& sensor : description.sensors)
    if (sensor.log) fill(*sensor.log, logs);
}

void require_word(const char* name, const std::string& word, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  throw UsageError(fmt::format("{}: expected {}, got '{}'", name, fmt::join(known, " or "), word));
}

void require_seconds(const char* name, double seconds) {
  if (!(seconds >= 0 && std::isfinite(seconds)))
    throw UsageError(fmt::format("{}: must be a number of seconds, at least 0, got {}", name, seconds));
}

/// Adds an edit for an entry if it is there.
template <typename Value, typename Apply>
void add_edit(const py::dict& given, const char* key, DriveChoice& choice, const Apply& apply) {
  Value value;
  if (!take(given, key, value)) return;
  choice.edits.emplace_back([apply, value](drive::DriveFile& file) { apply(file, value); });
}

/// The choices of the command line, by the same names.
DriveChoice choice_of(const py::dict& given) {
  DriveChoice choice;
  take(given, "data_folder", choice.data_folder);
  take(given, "modelings", choice.modelings);
  take(given, "modeling_options", choice.modeling_options);
  take(given, "sync", choice.sync);
  add_edit<double>(given, "from_s", choice, [](drive::DriveFile& file, double s) {
    require_seconds("from_s", s);
    file.description.from_s = s;
  });
  add_edit<double>(given, "to_s", choice, [](drive::DriveFile& file, double s) {
    require_seconds("to_s", s);
    file.description.to_s = s;
  });
  add_edit<int>(given, "withhold", choice, [](drive::DriveFile& file, int every) {
    if (every < 0 || every == 1)
      throw UsageError(fmt::format("withhold: must be 0 (none) or at least 2, got {}", every));
    program::set_withheld(file, every);
  });
  add_edit<std::string>(given, "outage", choice, [](drive::DriveFile& file, const std::string& text) {
    file.description.outage = program::parse_outage(text);
  });
  add_edit<std::string>(given, "initial_guess", choice, [](drive::DriveFile& file, const std::string& way) {
    require_word("initial_guess", way, {"anchored", "dead_reckoning"});
    program::set_initial_guess(file, way);
  });
  add_edit<std::string>(given, "gnss_loss", choice, program::set_loss);
  add_edit<std::vector<std::string>>(given, "calibrate", choice,
                                     [](drive::DriveFile& file, const std::vector<std::string>& words) {
                                       program::set_calibration(words, file.settings);
                                     });
  add_edit<std::string>(given, "noise", choice, [](drive::DriveFile& file, const std::string& way) {
    require_word("noise", way, {"estimate", "stated"});
    file.settings.estimates_noise = way == "estimate";
  });
  add_edit<bool>(given, "gate", choice,
                 [](drive::DriveFile& file, bool is_on) { file.settings.gate.enabled = is_on; });
  return choice;
}

/// What fuse() of Python hands over.
struct Request {
  drive::DriveFile file;
  DriveChoice choice;
  program::DriveRunOptions options;
  std::vector<std::string> plugins;
};

/// @param text of a drive.yaml; None: it is read from `path`
Request request_of(const std::string& path, const std::optional<std::string>& text, const py::dict& logs,
                   const py::dict& choice) {
  Request request;
  request.choice = choice_of(choice);
  const std::string& folder = request.choice.data_folder;
  request.file = text ? drive::parse_drive_file(*text, path, folder) : drive::load_drive_file(path, folder);
  fill(request.file.description, logs_of(logs));
  request.file = program::edited(std::move(request.file), request.choice);
  request.file.settings.minimization = minimization_of(choice);
  take(choice, "plugins", request.plugins);
  take(choice, "causal", request.options.causal);
  std::string out;
  if (take(choice, "out", out)) request.options.folder = out;
  request.options.keeps_models = true;
  return request;
}

std::vector<Fused> fuse(const std::string& path, const std::optional<std::string>& text, const py::dict& logs,
                        const py::dict& choice, const py::object& progress) {
  const Request request = request_of(path, text, logs, choice);
  Host host(progress);
  const auto finished = host.run([&] {
    const program::CommonOptions common{.quiet = true, .plugins = request.plugins};
    const program::Console console(common, host.listener());
    auto result = std::make_shared<FinishedRun>();
    const auto registry = std::make_shared<const TypeRegistry>(
        program::make_registry(common, request.file.description.plugins, console));
    result->registry = registry;
    result->run = program::run_drive(request.file, request.choice, request.options, *registry, console);
    return result;
  });
  finished->warnings = host.warnings();
  finished->notes = host.notes();
  std::vector<Fused> results;
  for (std::size_t i = 0; i < finished->run.modelings.size(); ++i) results.push_back({finished, i});
  return results;
}

}  // namespace

void bind_fusion(py::module_& module) {
  module.def("fuse", &fuse, py::arg("path"), py::arg("text"), py::arg("logs"), py::arg("choice"),
             py::arg("progress"));
}

}  // namespace waymark::python

#include <waymark/tools/fleet/table/fleet_table.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/registry/options.hpp>

namespace waymark::fleet {
namespace {

namespace fs = std::filesystem;

/// Every digit, so that the table reads back exactly; nothing for an undefined number.
std::string exact(double value) {
  return std::isfinite(value) ? shortest(value) : "";
}

/// Each drive of a worker has a folder there, whose name says nothing about its own.
std::size_t count_running(const FleetFolder& folder) {
  std::size_t running = 0;
  std::error_code none;
  for (const auto& worker : fs::directory_iterator(folder.all_running(), none)) {
    std::error_code gone;
    running += static_cast<std::size_t>(
        std::distance(fs::directory_iterator(worker.path(), gone), fs::directory_iterator()));
  }
  return running;
}

}  // namespace

std::size_t Fleet::count(DriveState state) const {
  return static_cast<std::size_t>(std::count_if(
      records.begin(), records.end(), [&](const DriveRecord& record) { return record.state == state; }));
}

Fleet read_fleet(const std::string& path) {
  const FleetFolder folder(path);
  Fleet fleet{.plan = read_plan(folder), .records = {}};
  for (const PlannedDrive& drive : fleet.plan.drives) {
    const std::string file = folder.record(drive.name);
    std::error_code unknown;
    if (fs::is_regular_file(file, unknown)) fleet.records.push_back(read_record(file));
  }
  fleet.running = count_running(folder);
  return fleet;
}

std::vector<std::string> word_columns() {
  return {"drive", "modeling", "state", "exit_code", "reason", "title", "environment", "label", "program"};
}

std::vector<std::string> words_of(const DriveRecord& record, const std::string& modeling) {
  return {record.drive,  modeling,     to_string(record.state), std::to_string(record.exit_code),
          record.reason, record.title, record.environment,      record.label,
          record.program};
}

text::Table merged_table(const Fleet& fleet) {
  text::Table table{.columns = word_columns()};
  for (const Column& column : columns()) table.columns.emplace_back(column.name);
  for (const DriveRecord& record : fleet.records) {
    if (record.rows.empty()) table.rows.push_back(words_of(record, ""));
    for (const ModelingRow& row : record.rows) {
      table.rows.push_back(words_of(record, row.modeling));
      for (const double number : row.numbers) table.rows.back().push_back(exact(number));
    }
  }
  for (text::Row& row : table.rows) row.resize(table.columns.size());
  return table;
}

text::Table cost_table(const Fleet& fleet) {
  text::Table table{.columns = {"drive", "wall_s", "processor_s", "memory_mb", "machine", "ended_s"}};
  for (const DriveRecord& record : fleet.records)
    table.rows.push_back({record.drive, fmt::format("{:.3f}", record.cost.wall_s),
                          fmt::format("{:.3f}", record.cost.processor_s),
                          fmt::format("{:.1f}", static_cast<double>(record.cost.memory_bytes) / 1e6),
                          record.cost.machine, fmt::format("{:.3f}", record.cost.ended_s)});
  return table;
}

}  // namespace waymark::fleet

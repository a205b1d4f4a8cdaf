/// The merged table of a fleet: a row for each drive and modeling, as CSV, and the costs beside it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/tools/fleet/folder/fleet_plan.hpp>
#include <waymark/tools/fleet/table/drive_record.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::fleet {

/// A fleet as it stands now.
struct Fleet {
  FleetPlan plan;
  std::vector<DriveRecord> records;  ///< of the drives that have ended, ordered by name
  std::size_t running = 0;           ///< begun and not ended; of workers that were killed too

  [[nodiscard]] std::size_t waiting() const { return plan.drives.size() - records.size(); }
  [[nodiscard]] std::size_t count(DriveState state) const;
};

/// Reads plan and records. Records of drives that the plan does not name are left out.
/// @throws InputError
[[nodiscard]] Fleet read_fleet(const std::string& folder);

/// Returns the merged table. It depends on drives, options and program only: not on the machine, the
/// order, or how often the work was interrupted. A failed drive has one row, without a modeling.
[[nodiscard]] text::Table merged_table(const Fleet& fleet);
/// Returns what each drive cost: times, memory, machine. These differ from run to run.
[[nodiscard]] text::Table cost_table(const Fleet& fleet);

/// The words of the merged table, before its columns of numbers.
[[nodiscard]] std::vector<std::string> word_columns();
[[nodiscard]] std::vector<std::string> words_of(const DriveRecord& record, const std::string& modeling);

}  // namespace waymark::fleet

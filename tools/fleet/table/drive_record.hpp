/// What a fleet keeps of one drive: how it ended, its numbers, and what it cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/evaluation/output/summary_json.hpp>

namespace waymark::fleet {

enum class DriveState {
  done,
  not_converged,  ///< there are results, but no minimum
  failed          ///< there are no results
};
[[nodiscard]] std::string to_string(DriveState state);

/// A column of numbers of the merged table.
struct Column {
  const char* name;   ///< with its unit: "rmse_m"
  const char* about;  ///< one sentence
  /// @param ending null: not known. @return kUndefined if the drive has no such number
  double (*value)(const evaluation::Evaluation& evaluation, const evaluation::RunEnding* ending);
};
[[nodiscard]] std::span<const Column> columns();

/// The numbers of one modeling of a drive, in the order of columns().
struct ModelingRow {
  std::string modeling;
  std::vector<double> numbers;

  /// @param column a name in columns()
  [[nodiscard]] double number(std::string_view column) const;
  /// Returns the error by which drives are judged: rmse_m if there is truth, else held_out_rmse_m.
  [[nodiscard]] double error_m() const;
  /// Returns "truth", "held-out fixes", or nothing if there is no error.
  [[nodiscard]] std::string error_measure() const;
};

/// What a drive cost. Differs from run to run, so it is no part of the merged table.
struct DriveCost {
  double wall_s = 0;
  double processor_s = 0;
  std::uint64_t memory_bytes = 0;  ///< largest resident set
  std::string machine;
  double ended_s = 0;  ///< POSIX time
};

struct DriveRecord {
  std::string drive;        ///< its name in the fleet
  std::string fingerprint;  ///< of its drive.yaml
  std::string label;        ///< of the fleet when it ran
  std::string program;      ///< "waymark 0.1.0"
  DriveState state = DriveState::failed;
  int exit_code = 0;
  std::string reason{};             ///< for a state other than done
  std::string title{};              ///< the name that the drive.yaml gives
  std::string environment{};        ///< as the drive.yaml states it
  std::vector<ModelingRow> rows{};  ///< a failed drive has none
  DriveCost cost{};
};

/// Adds title, environment and rows from the folder that `waymark run` wrote.
/// @throws InputError if it is incomplete
void add_results(const std::string& folder, DriveRecord& record);

[[nodiscard]] std::string record_json(const DriveRecord& record);
/// Reads a record. Numbers that it lacks, because an earlier version wrote it, are undefined.
/// @throws InputError
[[nodiscard]] DriveRecord read_record(const std::string& file);

}  // namespace waymark::fleet

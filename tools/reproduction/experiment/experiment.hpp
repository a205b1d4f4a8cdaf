/// An experiment: the settings that run on every drive, and the report of their outcomes.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// A way of withholding fixes, for a drive without truth.
struct Way {
  std::string name;
  int withhold_every = 0;
  drive::OutagePattern outage{};
};

struct Experiment {
  std::vector<Setting> settings{};  ///< on the whole drive
  bool truth_only = false;          ///< those run only if there is truth
  /// on a drive without truth, with each way of withholding fixes
  std::vector<Setting> withheld_settings{};
  std::vector<Way> ways{};
  ReproductionReport (*report)(const std::vector<DriveResult>& drives,
                               const std::string& introduction) = nullptr;
};

/// Returns the experiment of the paper, with the default model beside it. The ways are every 10th
/// fix, outages of 30 s and outages of 60 s.
[[nodiscard]] Experiment paper_experiment();
/// Returns the ablation, one ingredient at a time (ablation.hpp), with outages of 60 s.
[[nodiscard]] Experiment ablation_experiment();
/// Returns the study of stated against actual errors (consistency_study.hpp).
[[nodiscard]] Experiment consistency_experiment();

/// Returns how many settings run on a drive, including those with withheld fixes.
[[nodiscard]] std::size_t run_count(const Experiment& experiment, bool has_truth);

/// Runs an experiment on a drive.
/// @param dataset number in the paper, or 0
/// @param description fixes that it withholds itself are not withheld here
[[nodiscard]] DriveResult run_experiment(const Experiment& experiment, int dataset,
                                         drive::DriveDescription description, const drive::DriveLogs& logs,
                                         const Laboratory& laboratory);

}  // namespace waymark::reproduction

/// An experiment: which settings are run on every drive, and what is made of their outcomes.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// How fixes are kept out of a drive without truth.
struct Way {
  std::string name;
  int withhold_every = 0;
  drive::OutagePattern outage{};
};

struct Experiment {
  std::vector<Setting> settings{};           ///< on the whole drive
  bool truth_only = false;                   ///< those only where there is truth
  std::vector<Setting> withheld_settings{};  ///< on a drive without truth, in each of the ways
  std::vector<Way> ways{};
  ReproductionReport (*report)(const std::vector<DriveResult>& drives,
                               const std::string& introduction) = nullptr;
};

/// The paper's, with the default model beside it: every 10th fix kept out, outages of 30 s and of 60 s.
[[nodiscard]] Experiment paper_experiment();
/// One ingredient at a time (ablation.hpp); outages of 60 s.
[[nodiscard]] Experiment ablation_experiment();
/// Stated against actual errors (consistency_study.hpp).
[[nodiscard]] Experiment consistency_experiment();

/// Settings that are run on a drive, those with fixes kept out included.
[[nodiscard]] std::size_t run_count(const Experiment& experiment, bool has_truth);

/// Runs an experiment on a drive. @param dataset of the paper, or 0
/// @param description  what it keeps out itself is not kept out here
[[nodiscard]] DriveResult run_experiment(const Experiment& experiment, int dataset,
                                         drive::DriveDescription description, const drive::DriveLogs& logs,
                                         const Laboratory& laboratory);

}  // namespace waymark::reproduction

/// What each ingredient of the default model is worth, and what the field's alternatives are: one thing
/// switched at a time.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// A line of the ablation.
struct Ablation {
  std::string title;
  Setting setting;
};

/// The default model and it with one ingredient switched; then the reference of the field, g1 with the
/// paper's gate (kWhiteReference), and its alternatives: white noise as stated, calibration states, no gate
/// but where the title says so.
[[nodiscard]] const std::vector<Ablation>& ablations();
[[nodiscard]] std::vector<Setting> ablation_settings();
inline constexpr const char* kWhiteReference = "ours_g1";

/// 100 (exp(mean of log(error / reference)) - 1), percent, over the drives where both are known: a factor up
/// in one drive and the same factor down in another cancel. NaN without any.
[[nodiscard]] double mean_change_percent(const std::vector<double>& errors,
                                         const std::vector<double>& references);

/// Errors of a setting against truth, else at the withheld fixes; no numbers where it gave no result.
[[nodiscard]] evaluation::PositionMetrics judged_errors(const DriveResult& drive, const std::string& setting);
/// The same for stated against actual errors, which need a truth.
[[nodiscard]] evaluation::ConsistencyStatistics judged_stated_errors(const DriveResult& drive,
                                                                     const std::string& setting);

/// Errors, Max, NEES and coverage: a table each, a line for each setting, a column for each drive. Drives
/// with truth are judged by it; the others by the first way in which fixes were kept out.
[[nodiscard]] ReproductionReport ablation_report(const std::vector<DriveResult>& drives,
                                                 const std::string& introduction);

}  // namespace waymark::reproduction

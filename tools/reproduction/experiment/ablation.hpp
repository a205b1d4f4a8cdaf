/// The ablation: switches one thing at a time, to show the value of each ingredient of the default
/// model and of the field's alternatives.
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

/// Returns the default model and its variants with one ingredient switched. Then it returns the
/// reference of the field, g1 with the gate of the paper (kWhiteReference), and its alternatives.
/// These have white noise as stated and calibration states, and no gate unless the title says so.
[[nodiscard]] const std::vector<Ablation>& ablations();
[[nodiscard]] std::vector<Setting> ablation_settings();
inline constexpr const char* kWhiteReference = "ours_g1";

/// Returns 100 (exp(mean of log(error / reference)) - 1), percent, over the drives with both
/// numbers. A factor up in one drive and the same factor down in another cancel. NaN if
/// there are none.
[[nodiscard]] double mean_change_percent(const std::vector<double>& errors,
                                         const std::vector<double>& references);

/// Returns the errors of a setting against truth, or else at the withheld fixes. They are undefined
/// if there is no result.
[[nodiscard]] evaluation::PositionMetrics judged_errors(const DriveResult& drive, const std::string& setting);
/// Returns the consistency of stated with actual errors, which needs a truth.
[[nodiscard]] evaluation::ConsistencyStatistics judged_stated_errors(const DriveResult& drive,
                                                                     const std::string& setting);

/// Returns one table each of errors, Max, NEES and coverage, with a line for each setting and a
/// column for each drive. Drives with truth are judged by it, the others by the first way of
/// withholding fixes.
[[nodiscard]] ReproductionReport ablation_report(const std::vector<DriveResult>& drives,
                                                 const std::string& introduction);

}  // namespace waymark::reproduction

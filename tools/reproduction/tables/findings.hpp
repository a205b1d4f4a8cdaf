/// Which of the paper's findings hold on the drives at hand, and what the default model adds: computed from
/// the numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>

namespace waymark::reproduction {

/// What one source says of a finding.
struct Evidence {
  std::string source;  ///< "paper", "literal", "minimum", "ours", "default model"
  std::string figures;
  std::optional<bool> holds;  ///< empty: the source is no judge of it
};

struct Finding {
  std::string statement;  ///< what the paper found, or what lies beyond it
  std::vector<Evidence> evidence;
};

/// Largest change of the average accuracy that counts as none, percent: what the paper has in a single drive
/// (2) and calls no change.
inline constexpr double kUnchangedPercent = 10;

/// Mean coverage of 95 % regions from which covariances are called honest.
inline constexpr double kHonestCoverage = 0.9;

/// The paper's, and after them what lies beyond it. Drives without truth have no part in it. Empty where no
/// drive has truth.
[[nodiscard]] std::vector<Finding> findings(const std::vector<DriveResult>& drives);

/// A paragraph for each, for the terminal and Markdown alike.
[[nodiscard]] std::string findings_text(const std::vector<Finding>& findings);

}  // namespace waymark::reproduction

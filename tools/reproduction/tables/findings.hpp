/// Tests which findings of the paper hold on the present drives, and what the default model adds.
/// Everything is computed from the numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>

namespace waymark::reproduction {

/// The verdict of one source on a finding.
struct Evidence {
  std::string source;  ///< "paper", "literal", "minimum", "ours", "default model"
  std::string figures;
  std::optional<bool> holds;  ///< empty: the source cannot judge it
};

struct Finding {
  std::string statement;  ///< a finding of the paper, or one beyond it
  std::vector<Evidence> evidence;
};

/// A smaller change of the average accuracy counts as no change, percent. In the paper, a single
/// drive (2) changes by this much, and the text calls it no change.
inline constexpr double kUnchangedPercent = 10;

/// Covariances with at least this mean coverage of their 95 % regions are called consistent.
inline constexpr double kConsistentCoverage = 0.9;

/// Returns the findings of the paper, and then those beyond it. Only drives with truth are used;
/// empty if there are none.
[[nodiscard]] std::vector<Finding> findings(const std::vector<DriveResult>& drives);

/// Returns a paragraph for each finding, for the terminal and for Markdown.
[[nodiscard]] std::string findings_text(const std::vector<Finding>& findings);

}  // namespace waymark::reproduction

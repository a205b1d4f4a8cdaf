/// Which of the paper's findings hold on the drives at hand: computed from the numbers.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/reproduction/drive_result.hpp>

namespace waymark {

struct Finding {
  std::string statement;  ///< what the paper found
  std::string paper;      ///< its figures
  std::string literal;    ///< the same with the paper's settings on these drives
  std::string ours;       ///< and with ours
  bool literal_holds = false;
  bool ours_holds = false;
};

/// Largest change of the average accuracy that counts as none, percent; the paper calls 2.3 % no change.
inline constexpr double kUnchangedPercent = 5;

/// Drives without truth have no part in it. Empty where no drive has truth.
[[nodiscard]] std::vector<Finding> findings(const std::vector<DriveResult>& drives);

/// A paragraph for each, for the terminal and Markdown alike.
[[nodiscard]] std::string findings_text(const std::vector<Finding>& findings);

}  // namespace waymark

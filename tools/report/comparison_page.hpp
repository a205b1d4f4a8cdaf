/// The page that compares runs: modelings, algorithms, settings, drives.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/report/compared_run.hpp>
#include <waymark/tools/report/page.hpp>

namespace waymark {

/// Errors beside each other and beside raw GNSS, their distribution and course, stated against actual errors,
/// how the minimisations ended, and what was done differently. Runs of several drives stand in groups: only
/// within one are errors comparable. What no run has is left out.
/// @param runs     labels differ
/// @param version  of the program, for the footer
/// @throws UsageError for no runs
[[nodiscard]] Page comparison_page(const std::vector<ComparedRun>& runs, const std::string& version);

/// Provenance that is not the same in all runs, a row for each key, a column for each run.
[[nodiscard]] PageTable provenance_differences(const std::vector<ComparedRun>& runs);

}  // namespace waymark

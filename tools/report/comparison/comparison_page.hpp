/// The page that compares runs: modelings, algorithms, settings, drives.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/comparison/compared_run.hpp>

namespace waymark::report {

/// Errors beside each other and beside raw GNSS, their distribution and course, stated against actual errors,
/// how the minimisations ended, and what was done differently. Runs of several drives stand in groups: only
/// within one are errors comparable. What no run has is left out.
/// @param runs     labels differ
/// @param version  of the program, for the footer
/// @throws UsageError for no runs
[[nodiscard]] drawing::Page comparison_page(const std::vector<ComparedRun>& runs, const std::string& version);

/// Provenance that is not the same in all runs, a row for each key, a column for each run.
[[nodiscard]] drawing::PageTable provenance_differences(const std::vector<ComparedRun>& runs);

}  // namespace waymark::report

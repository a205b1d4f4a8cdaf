/// The page that compares runs with different modelings, algorithms, settings or drives.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/comparison/compared_run.hpp>

namespace waymark::report {

/// Returns the page. It shows errors beside each other and beside raw GNSS, their distribution and
/// course, stated against actual errors, how the optimisations ended, and the differences in
/// settings. Runs of several drives are grouped, because errors are comparable only within one
/// drive. Parts for which no run has data are left out.
/// @param runs with different labels
/// @param version version of the program, for the footer
/// @throws UsageError if there are no runs
[[nodiscard]] drawing::Page comparison_page(const std::vector<ComparedRun>& runs, const std::string& version);

/// Returns the provenance that differs between runs: a row for each key, a column for each run.
[[nodiscard]] text::Table provenance_differences(const std::vector<ComparedRun>& runs);

}  // namespace waymark::report

/// The page of a fleet, and the page that compares two fleets.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/fleet/comparison/regression.hpp>
#include <waymark/tools/fleet/table/fleet_table.hpp>

namespace waymark::fleet {

/// Returns the page of a fleet: how the drives ended, the distribution of their errors, the worst
/// drives with links to their reports, and groups by environment and by version. It has no times and
/// no machines, so it is the same wherever the drives were run.
/// @param version of the program, for the footer
[[nodiscard]] drawing::Page fleet_page(const Fleet& fleet, const std::string& version);

/// Returns the page of a regression: the verdict and its rule, the drives that got worse and better, and
/// the errors of both fleets against each other.
[[nodiscard]] drawing::Page regression_page(const Regression& regression, const std::string& version);

/// Returns one sentence: "f00d is worse than 0.1.0: 12 of 200 drives got worse, ...".
[[nodiscard]] std::string verdict_sentence(const Regression& regression);

/// Returns the pairs of one kind, the largest change first.
[[nodiscard]] std::vector<const PairedDrive*> pairs_of(const Regression& regression,
                                                       const std::vector<Change>& kinds);

/// The pairs as a table of every digit: drive, modeling, environment, measure, both errors, change, reason.
[[nodiscard]] text::Table regression_table(const Regression& regression);

}  // namespace waymark::fleet

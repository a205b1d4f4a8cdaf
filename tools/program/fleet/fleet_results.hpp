/// What the command `fleet` tells and writes of a fleet.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/tools/fleet/comparison/regression.hpp>
#include <waymark/tools/fleet/table/fleet_table.hpp>
#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/program/terminal/exit_codes.hpp>

namespace waymark::program {

/// Writes the merged table (CSV and SQLite), the costs and the page. Returns their files.
std::vector<std::string> write_merged(const fleet::Fleet& fleet, const std::string& folder,
                                      const Console& console);

/// Returns how far a fleet is, why drives failed, and how fast it goes.
[[nodiscard]] std::string status_text(const fleet::Fleet& fleet, const std::string& folder,
                                      const text::TextLook& look);
/// Returns the keys of waymark-fleet. @param files that were written
[[nodiscard]] nlohmann::ordered_json status_json(const fleet::Fleet& fleet, const std::string& folder,
                                                 const std::vector<std::string>& files);

/// Writes page and table of a comparison into a folder. Returns the files.
std::vector<std::string> write_regression(const fleet::Regression& regression, const std::string& folder);
[[nodiscard]] std::string regression_text(const fleet::Regression& regression, const text::TextLook& look);
/// Returns the keys of waymark-fleet-comparison.
[[nodiscard]] nlohmann::ordered_json regression_json(const fleet::Regression& regression,
                                                     const std::vector<std::string>& files);

/// Returns bad input if a drive failed, no convergence if one has no minimum, else success.
[[nodiscard]] ExitCode exit_code_of(const fleet::Fleet& fleet);

}  // namespace waymark::program

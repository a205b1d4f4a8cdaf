#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/reproduction/tables/convergence_tables.hpp>

namespace waymark::reproduction {
namespace {

using Drives = std::vector<DriveResult>;

bool is_common_minimum(const Outcome& outcome) {
  return at_minimum(outcome) && outcome.ending.converged;
}

template <typename Condition>
Reached count(const Drives& drives, const std::string& setting, Condition condition) {
  Reached count;
  for (const DriveResult& drive : drives) {
    const Outcome* outcome = find_outcome(drive.outcomes, setting);
    if (outcome == nullptr) continue;
    ++count.of;
    if (condition(*outcome)) ++count.reached;
  }
  return count;
}

std::string short_length(double metres) {
  if (metres >= 1000) return fmt::format("{:.1f} km", metres / 1000);
  return metres >= 1 ? fmt::format("{:.1f} m", metres) : fmt::format("{:.0f} mm", metres * 1000);
}

/// Returns "12" if the minimum was reached in 12 steps, or else "x 50: 3.2 m".
std::string ending_cell(const Outcome* outcome) {
  if (outcome == nullptr) return "-";
  if (!outcome->failure.empty()) return "failed";
  if (near_minimum(*outcome)) return std::to_string(outcome->ending.iterations);
  return fmt::format("x {}: {}", outcome->ending.iterations, short_length(outcome->from_minimum.position_m));
}

std::string reached_text(const Reached& count) {
  return count.of == 0 ? "-" : fmt::format("{} of {}", count.reached, count.of);
}

std::string reached_cell(const Drives& drives, const std::string& setting) {
  const Reached count = count_reached(drives, setting);
  return reached_text(count);
}

/// The smallest and largest number of steps, and the distance between the ends.
struct Spread {
  int fewest = 1 << 30;
  int most = 0;
  double position_m = 0;
  double heading_rad = 0;
};

Spread spread_of(const Drives& drives, const std::string& setting) {
  Spread spread;
  for (const DriveResult& drive : drives) {
    const Outcome* outcome = find_outcome(drive.outcomes, setting);
    if (outcome == nullptr || !is_common_minimum(*outcome)) continue;
    const int steps = outcome->ending.iterations + outcome->ending.rejected_steps;
    spread.fewest = std::min(spread.fewest, steps);
    spread.most = std::max(spread.most, steps);
    spread.position_m = std::max(spread.position_m, outcome->from_minimum.position_m);
    spread.heading_rad = std::max(spread.heading_rad, outcome->from_minimum.heading_rad);
  }
  return spread;
}

}  // namespace

Reached count_reached(const Drives& drives, const std::string& setting) {
  return count(drives, setting, [](const Outcome& outcome) { return near_minimum(outcome); });
}

Reached count_common_minimum(const Drives& drives, const std::string& setting) {
  return count(drives, setting, is_common_minimum);
}

text::Table cause_table(const Drives& drives) {
  text::Table table;
  table.file = "convergence_literal";
  table.title = "The paper's literal settings: their results, and with one cause at a time removed";
  table.columns = {"Drive", "modeling", "literal"};
  for (const Cause& cause : causes()) table.columns.push_back(cause.title);
  const auto add_row = [&](const std::string& label, const std::string& modeling, const auto& cell_of) {
    const std::string name = "paper_" + modeling;
    text::Row row{label, modeling, cell_of(name)};
    for (const Cause& cause : causes()) row.push_back(cell_of(name + "/" + cause.name));
    table.rows.push_back(row);
  };
  for (const DriveResult& drive : drives) {
    for (const std::string modeling : kModelings)
      add_row(drive.label(), modeling,
              [&](const std::string& name) { return ending_cell(find_outcome(drive.outcomes, name)); });
  }
  for (const std::string modeling : kModelings)
    add_row("reached", modeling, [&](const std::string& name) { return reached_cell(drives, name); });
  table.notes = {
      fmt::format("A number: the steps to the minimum (chi2 less than {} above it). \"x 50: 3.0 m\": stopped "
                  "after 50 steps, a pose 3.0 m from the minimum of the same errors and weights.",
                  kReachedChi2),
      fmt::format("literal: g2o's dogleg (norm over metres and radians, initial radius 1e4), "
                  "initial guess by dead reckoning, log error with heading 0, 1.1 % per odometry "
                  "edge. It ends if a step lowers chi2 by less than {:g} of it, truncated or not, "
                  "or after {} steps.",
                  kGain, kGainIterations),
      "scaled radius: the norm of diag(H), the initial radius from the first Newton step.",
      "no dummy heading: the decoupled error instead of the logarithm.",
      fmt::format("full steps only: convergence is tested on full Newton steps; at most {} steps are tried.",
                  kBareIterations),
      "anchored guess: the fixes anchor place and heading instead of dead reckoning.",
      "first three: scaled radius, no dummy heading and full steps only, from dead reckoning.",
      "guess to the east: literal, but dead reckoning begins with heading 0, because odometry alone "
      "does not know north.",
      "nodes at fixes: literal, but the nodes of G2 begin at their fixes instead of the poses."};
  return table;
}

text::Table common_minimum_table(const Drives& drives) {
  text::Table table;
  table.file = "convergence_ours";
  table.title = "Our settings: number of drives that reach the common minimum, and their steps";
  table.columns = {"start", "modeling"};
  for (const char* algorithm : kConvergenceAlgorithms) table.columns.push_back(algorithm);
  double position_m = 0;
  double heading_rad = 0;
  for (const std::string start : kConvergenceStarts) {
    std::vector<Reached> totals(std::size(kConvergenceAlgorithms));
    for (const std::string modeling : kModelings) {
      text::Row row{start, modeling};
      for (std::size_t a = 0; a < totals.size(); ++a) {
        const std::string name = "ours_" + modeling + "/" + start + "/" + kConvergenceAlgorithms[a];
        const Reached count = count_common_minimum(drives, name);
        const Spread spread = spread_of(drives, name);
        totals[a].reached += count.reached;
        totals[a].of += count.of;
        position_m = std::max(position_m, spread.position_m);
        heading_rad = std::max(heading_rad, spread.heading_rad);
        std::string text = reached_text(count);
        if (spread.most > 0) text += fmt::format(" in {}-{}", spread.fewest, spread.most);
        row.push_back(text);
      }
      table.rows.push_back(row);
    }
    text::Row row{start, "together"};
    for (const Reached& total : totals) row.push_back(reached_text(total));
    table.rows.push_back(row);
  }
  table.notes = {
      fmt::format("Each drive has one minimum for all modelings, algorithms and initial guesses: "
                  "the lowest found. Reached: converged, with all poses within {:.0f} mm and {:.1f} "
                  "degrees of it. Largest difference among those: {:.2g} mm, {:.2g} degrees (G2's "
                  "identity edges raise each fix's variance by 1e-6 m^2).",
                  kSamePoses.position_m * 1000, kSamePoses.heading_rad * 180 / std::numbers::pi,
                  position_m * 1000, heading_rad * 180 / std::numbers::pi),
      "+starts, and default (dogleg): as `waymark optimize` runs them: if a minimum is implausible, "
      "other initial guesses are tried. The others are the bare algorithms, at most 100 steps; "
      "Levenberg-Marquardt with initial_damping=1e-12.",
      "east: dead reckoning that begins with heading 0."};
  return table;
}

text::Table run_table(const Drives& drives) {
  text::Table table;
  table.file = "runs";
  table.title = "Every run";
  table.columns = {"drive", "setting",      "steps",          "rejected_steps",   "initial_chi2",
                   "chi2",  "minimum_chi2", "from_minimum_m", "from_minimum_rad", "converged",
                   "ending"};
  const auto exact = [](double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
  };
  for (const DriveResult& drive : drives) {
    for (const Outcome& outcome : drive.outcomes) {
      const Ending& ending = outcome.ending;
      table.rows.push_back({drive.label(), outcome.setting.name, std::to_string(ending.iterations),
                            std::to_string(ending.rejected_steps), exact(ending.initial_chi2),
                            exact(ending.chi2), exact(outcome.minimum_chi2),
                            exact(outcome.from_minimum.position_m), exact(outcome.from_minimum.heading_rad),
                            ending.converged ? "yes" : "no",
                            outcome.failure.empty() ? ending.message : outcome.failure});
    }
  }
  return table;
}

}  // namespace waymark::reproduction

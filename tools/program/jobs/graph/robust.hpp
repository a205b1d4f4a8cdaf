/// Robust estimation from the command line: losses on edges, and the search for outliers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <waymark/core/robust/graduation.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>

namespace waymark::program {

/// The user's choices for `optimize`.
struct RobustChoice {
  std::vector<std::string> losses;   ///< NAME:SCALE, or TAG=NAME:SCALE
  std::string method = "none";       ///< none, gnc
  std::string trusted = "odometry";  ///< odometry, none, or a tag
  /// file for the edges that are found to be outliers; empty: none
  std::string outliers;
};

/// Adds --loss, --robust, --trusted and --outliers.
void add_robust_options(CLI::App& command, RobustChoice& choice);

/// Checks before anything is read that losses and tags exist and fit together. @throws UsageError
void check_robust(const RobustChoice& choice, const TypeRegistry& registry);

/// Gives the chosen losses to all edges that are not trusted (with method none; gnc
/// graduates them).
void attach_losses(Graph& graph, const RobustChoice& choice, const TypeRegistry& registry);

/// The result of graduated non-convexity.
struct Graduated {
  GraduationResult result;
  /// the outliers as lines of a graph file: tag, ids, fields, information
  std::string outlier_lines;
  nlohmann::ordered_json outlier_edges = nlohmann::ordered_json::array();
  std::vector<std::string> notes;  ///< about trusted edges that contradict the others
};

/// Returns a minimiser for optimize_document that finds outliers and removes them from the graph.
/// @param found filled when the minimiser has run; it must outlive the minimiser
[[nodiscard]] Minimizer graduating_minimizer(const RobustChoice& choice, const TypeRegistry& registry,
                                             std::optional<Graduated>& found);

/// Returns one line for the terminal.
[[nodiscard]] std::string graduation_text(const GraduationResult& result);
[[nodiscard]] nlohmann::ordered_json graduation_json(const Graduated& graduated);

}  // namespace waymark::program

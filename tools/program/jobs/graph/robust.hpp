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

/// What `optimize` lets the user choose.
struct RobustChoice {
  std::vector<std::string> losses;   ///< NAME:SCALE, or TAG=NAME:SCALE
  std::string method = "none";       ///< none, gnc
  std::string trusted = "odometry";  ///< odometry, none, or a tag
  std::string outliers;              ///< file for the edges judged outliers; empty: none
};

/// --loss, --robust, --trusted, --outliers.
void add_robust_options(CLI::App& command, RobustChoice& choice);

/// Whether losses and tags exist and fit together, before anything is read. @throws UsageError
void check_robust(const RobustChoice& choice, const TypeRegistry& registry);

/// Gives the losses asked for to all edges that are not trusted (method none; with gnc they are graduated).
void attach_losses(Graph& graph, const RobustChoice& choice, const TypeRegistry& registry);

/// What graduated non-convexity found.
struct Graduated {
  GraduationResult result;
  std::string outlier_lines;  ///< the outliers as lines of a graph file: tag, ids, fields, information
  nlohmann::ordered_json outlier_edges = nlohmann::ordered_json::array();
};

/// A minimiser for optimize_document that looks for outliers and takes them out of the graph.
/// @param found filled when the minimiser has run; must outlive it
[[nodiscard]] drive::Minimizer graduating_minimizer(const RobustChoice& choice, const TypeRegistry& registry,
                                                    std::optional<Graduated>& found);

/// One line for the terminal.
[[nodiscard]] std::string graduation_text(const GraduationResult& result);
[[nodiscard]] nlohmann::ordered_json graduation_json(const Graduated& graduated);

}  // namespace waymark::program

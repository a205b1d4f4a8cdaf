/// Closures that are wrong for one reason: a vehicle at one place takes it for another.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/optimize/optimizer.hpp>

namespace waymark::detail {

/// Tells what it costs to call edges wrong, where those that see one wrong place cost little more than one.
///
/// Places look alike from more than one pose, so false closures come in groups: (i, j), (i + 1, j + 1), ...
/// that agree with each other and with nothing else. Each edge of a group only repeats the mistake of the
/// first one. A group therefore costs the price of one edge, chi2 of its edges and of the odometry along its
/// two ways alone (as if they were kept, and nothing else), and per further edge -2 log of the probability
/// that a mistake goes on. The chi2 is the same inside and outside, so that only the contradiction to the
/// rest decides.
///
/// Two edges of a group have ends at most two poses apart by the order of ids, and their chi2 alone is within the
/// price of one, or a chain of such edges leads from one to the other. Without odometry between their ends nothing
/// tells that they are one mistake. Edges of other than two vertices are alone.
class WrongPlaces {
 public:
  /// @param odometry the edges along the ways @param price of an edge alone
  WrongPlaces(const Graph& graph, std::span<const EdgePlace> odometry, Algorithm& algorithm,
              LinearSolver& solver, std::function<double(EdgePlace)> price);

  /// Returns the edges of two vertices by group, those that are alone as groups of one; every list is ascending.
  /// @param values_of as below
  [[nodiscard]] std::vector<std::vector<EdgePlace>> groups(Graph& values_of,
                                                           std::span<const EdgePlace> edges);

  /// @param values_of the graph, at values at which ways are right over a few poses; it gets them back
  [[nodiscard]] double price(Graph& values_of, std::span<const EdgePlace> edges);

 private:
  [[nodiscard]] double price_of_group(const Graph& values_of, const std::vector<EdgePlace>& group);
  [[nodiscard]] double chi2_alone(const Graph& values_of, const std::vector<EdgePlace>& group);
  [[nodiscard]] double computed_chi2(const Graph& values_of, const std::vector<EdgePlace>& group) const;

  Algorithm& algorithm_;
  LinearSolver& solver_;
  std::function<double(EdgePlace)> price_;
  std::vector<std::int64_t> order_;                  // place of each vertex
  std::multimap<std::int64_t, EdgePlace> odometry_;  // by the place of the earlier end
  std::map<std::vector<EdgePlace>, double> known_;   // chi2 alone: it hardly depends on the values
};

}  // namespace waymark::detail

/// Tests whether solvers and algorithms work here, including those of plugins. It uses a small
/// graph whose minimum is known from theory.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark::program {

/// A graph with its lowest chi2.
///
/// The poses are on a circle. Between neighbours there are two measurements (t1, a1), (t2, a2) of
/// the relative pose, each with information diag(w, w, v). The minimum of w |t1 - t|^2 + w |t2 -
/// t|^2 + ... is at their mean and equals w |t1 - t2|^2 / 2 + v (a1 - a2)^2 / 2, wherever the other
/// poses are. Closures across the circle measure exactly what follows from these means. So they
/// fill the matrix and add nothing to the minimum.
struct KnownProblem {
  Graph graph;  ///< its initial guess is elsewhere
  double minimum = 0;
};
[[nodiscard]] KnownProblem known_problem();

/// One solver or algorithm on that graph.
struct SelfTest {
  std::string name;
  double chi2 = 0;
  std::string problem;  ///< empty: it reached the minimum
};
/// Tests each registered solver with the default algorithm, and each algorithm with the
/// first solver.
[[nodiscard]] std::vector<SelfTest> test_solvers(const TypeRegistry& registry);
[[nodiscard]] std::vector<SelfTest> test_algorithms(const TypeRegistry& registry);

}  // namespace waymark::program

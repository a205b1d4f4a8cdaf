/// Optimisation from an initial guess that is chosen by name.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/registry/registry.hpp>

namespace WAYMARK_EXPORT waymark {

/// A search around optimize() that replaces it, for example one for outliers among the edges.
using Minimizer = std::function<Summary(Graph&, Algorithm&, LinearSolver&, const OptimizerOptions&)>;

/// Checks that the name is that of a registered start or one of the others.
/// @throws UsageError with the most similar name or all of them
void check_start(std::string_view start, const TypeRegistry& registry,
                 std::vector<std::string_view> others = {kAutoStart, kFileStart});

/// Optimises from the start with this name. Afterwards the graph holds the best values found.
/// kAutoStart is optimize_from_best_start, but a search begins at the values of the graph, because
/// chi2 over all edges cannot judge a start if some edges are false.
/// @param search in place of optimize(); empty: use optimize()
/// @throws UsageError for an unknown name; InputError if the start cannot be computed; errors of
/// optimize()
MultiStartSummary optimize_from(std::string_view start, Graph& graph, const TypeRegistry& registry,
                                Algorithm& algorithm, LinearSolver& solver, const OptimizerOptions& options,
                                const Minimizer& search = {});

/// Returns the note about vertices that nothing joins to the rest (InitialValues::apart).
[[nodiscard]] std::string apart_note(std::size_t vertices);

}  // namespace waymark

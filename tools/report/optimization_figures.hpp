/// What a report shows of the graph and its optimisation.
#pragma once

#include <functional>
#include <vector>

#include <waymark/core/stamp.hpp>
#include <waymark/core/summary.hpp>
#include <waymark/tools/evaluation/estimated_states.hpp>
#include <waymark/tools/evaluation/residuals.hpp>
#include <waymark/tools/evaluation/sparsity.hpp>
#include <waymark/tools/report/page.hpp>
#include <waymark/tools/report/view.hpp>

namespace waymark {

/// chi2 at every proposed step, by the kind of step; rejected ones marked.
[[nodiscard]] Figure convergence_figure(const Summary& summary);

/// Whitened residuals of each edge type against a normal distribution: on the line, the noise is as stated.
[[nodiscard]] Figure residual_figure(const GraphResiduals& residuals);
/// Their numbers by component.
[[nodiscard]] PageTable residual_table(const GraphResiduals& residuals);
/// The largest edges of each type. @param seconds since the drive's start
[[nodiscard]] PageTable largest_residuals(const GraphResiduals& residuals,
                                          const std::function<double(Stamp)>& seconds);

[[nodiscard]] PageTable state_table(const std::vector<StateReport>& states);
/// States that wander, each over time; `time` is the extent of the drive, in seconds.
[[nodiscard]] std::vector<Figure> state_figures(const std::vector<StateReport>& states,
                                                const std::function<double(Stamp)>& seconds, Range time);

/// H in the order of the graph, H and its factor in the order of elimination.
[[nodiscard]] FigureRow sparsity_figures(const Sparsity& sparsity);
/// How much they hold, in words.
[[nodiscard]] std::string describe_sparsity(const Sparsity& sparsity);

}  // namespace waymark

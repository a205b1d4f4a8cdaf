/// What a report shows of the graph and its optimisation.
#pragma once

#include <functional>
#include <vector>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/optimize/summary.hpp>
#include <waymark/tools/drawing/figure/view.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/document/residuals.hpp>
#include <waymark/tools/evaluation/document/sparsity.hpp>

namespace waymark::report {

/// chi2 at every proposed step, by the kind of step; rejected ones marked.
[[nodiscard]] drawing::Figure convergence_figure(const Summary& summary);

/// Whitened residuals of each edge type against a normal distribution: on the line, the noise is as stated.
[[nodiscard]] drawing::Figure residual_figure(const evaluation::GraphResiduals& residuals);
/// Their numbers by component.
[[nodiscard]] drawing::PageTable residual_table(const evaluation::GraphResiduals& residuals);
/// The largest edges of each type. @param seconds since the drive's start
[[nodiscard]] drawing::PageTable largest_residuals(const evaluation::GraphResiduals& residuals,
                                                   const std::function<double(Stamp)>& seconds);

[[nodiscard]] drawing::PageTable state_table(const std::vector<evaluation::StateReport>& states);
/// States that wander, each over time; `time` is the extent of the drive, in seconds.
[[nodiscard]] std::vector<drawing::Figure> state_figures(const std::vector<evaluation::StateReport>& states,
                                                         const std::function<double(Stamp)>& seconds,
                                                         drawing::Range time);

/// H in the order of the graph, H and its factor in the order of elimination.
[[nodiscard]] drawing::FigureRow sparsity_figures(const evaluation::Sparsity& sparsity);
/// How much they hold, in words.
[[nodiscard]] std::string describe_sparsity(const evaluation::Sparsity& sparsity);

}  // namespace waymark::report

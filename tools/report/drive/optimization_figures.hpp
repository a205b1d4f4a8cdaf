/// The figures of a report about the graph and its optimisation.
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

/// Shows chi2 at every proposed step, by the kind of step. Rejected steps are marked.
[[nodiscard]] drawing::Figure convergence_figure(const Summary& summary);

/// Compares the whitened residuals of each edge type with a normal distribution. Points on the line
/// mean that the noise is as stated.
[[nodiscard]] drawing::Figure residual_figure(const evaluation::GraphResiduals& residuals);
/// Returns their numbers for each component.
[[nodiscard]] text::Table residual_table(const evaluation::GraphResiduals& residuals);
/// Returns the largest edges of each type. @param seconds since the start of the drive
[[nodiscard]] text::Table largest_residuals(const evaluation::GraphResiduals& residuals,
                                            const std::function<double(Stamp)>& seconds);

[[nodiscard]] text::Table state_table(const std::vector<evaluation::StateReport>& states);
/// Shows each state that wanders over time. `time` is the extent of the drive in seconds.
[[nodiscard]] std::vector<drawing::Figure> state_figures(const std::vector<evaluation::StateReport>& states,
                                                         const std::function<double(Stamp)>& seconds,
                                                         drawing::Range time);

/// Shows H in the order of the graph, and H and its factor in the order of elimination.
[[nodiscard]] drawing::FigureRow sparsity_figures(const evaluation::Sparsity& sparsity);
/// Describes in words how many entries they hold.
[[nodiscard]] std::string describe_sparsity(const evaluation::Sparsity& sparsity);

}  // namespace waymark::report

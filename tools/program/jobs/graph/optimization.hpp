/// Optimises a document from the command line: options, progress, and the outcome as text and JSON.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/program/terminal/exit_codes.hpp>

namespace waymark::program {

/// Optimises; fills document.covariances as the settings ask for. Iterations are shown by the
/// console. A result that is no minimum is said on stderr. @param search instead of optimize().
/// @param work of which it is a part, shown beside the iterations. @throws InputError where the
/// start asked for cannot be made
MultiStartSummary optimize_document(formats::GraphDocument& document, const drive::Minimization& how,
                                    const TypeRegistry& registry, const Console& console,
                                    const drive::Minimizer& search = {}, const std::string& work = {});

/// Says what a minimisation noted, and that it reached no minimum if that is so.
void tell_ending(const Summary& summary, const Console& console);

/// What is said of a minimisation that reached no minimum.
[[nodiscard]] std::string no_minimum_warning(const Summary& summary);

/// Says a warning on the console, and in the document's provenance.
void warn(const std::string& warning, formats::GraphDocument& document, const Console& console);

/// Returns the line about the optimisation for the header of the graph.
[[nodiscard]] std::string describe_optimization(const MultiStartSummary& result);

/// The estimated states of an optimised document: empty without a minimum; if their sigmas cannot
/// be had, a warning is said.
[[nodiscard]] std::vector<evaluation::StateReport> states_of_minimum(formats::GraphDocument& document,
                                                                     const Summary& summary,
                                                                     const Console& console);

/// Returns 0, 4 or 130.
[[nodiscard]] ExitCode exit_code(const Summary& summary);

/// Converts "name=value" pairs to Options. @throws UsageError
[[nodiscard]] Options parse_options(const std::vector<std::string>& pairs);

/// Returns a few lines for the terminal.
[[nodiscard]] std::string summary_text(const MultiStartSummary& result);

}  // namespace waymark::program

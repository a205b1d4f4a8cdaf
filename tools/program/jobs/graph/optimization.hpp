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

/// Optimises, and fills document.covariances as the settings request. The console shows iterations.
/// A result that is no minimum is reported on stderr, and so is a minimum whose covariances cannot be
/// computed, with the vertex that is not determined.
/// @param search in place of optimize()
/// @param work name of the work that this is a part of, shown beside the iterations
/// @throws InputError if the chosen start cannot be computed
MultiStartSummary optimize_document(formats::GraphDocument& document, const drive::Minimization& how,
                                    const TypeRegistry& registry, const Console& console,
                                    const Minimizer& search = {}, const std::string& work = {});

/// Returns the warning about a minimisation that reached no minimum.
[[nodiscard]] std::string no_minimum_warning(const Summary& summary);

/// Prints a warning on the console, and adds it to the provenance of the document.
void warn(const std::string& warning, formats::GraphDocument& document, const Console& console);

/// Adds the optimisation to the provenance of the document, and the warning if it reached no
/// minimum.
void record_optimization(const MultiStartSummary& result, formats::GraphDocument& document);

/// Returns the estimated states of an optimised document. Empty without a minimum. If their sigmas
/// cannot be computed, there is a warning.
[[nodiscard]] std::vector<evaluation::StateReport> states_of_minimum(formats::GraphDocument& document,
                                                                     const Summary& summary,
                                                                     const Console& console);

/// Returns 0, 4 or 130.
[[nodiscard]] ExitCode exit_code(const Summary& summary);

/// Converts "name=value" pairs to Options. @throws UsageError
[[nodiscard]] Options parse_options(const std::vector<std::string>& pairs);

}  // namespace waymark::program

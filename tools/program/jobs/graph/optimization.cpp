#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/terminal/iteration_table.hpp>
#include <waymark/version.hpp>

namespace waymark::program {

Options parse_options(const std::vector<std::string>& pairs) {
  Options options;
  for (const std::string& pair : pairs) {
    const auto equals = pair.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("expected NAME=VALUE, got '" + pair + "'");
    }
    options[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return options;
}

std::string no_minimum_warning(const Summary& summary) {
  return "no minimum was reached: " + summary.message +
         (summary.termination == Termination::interrupted ? "; the best state so far is kept" : "");
}

namespace {

// The minimum stands without its covariances, and costs far more than they do.
void add_covariances_or_warn(formats::GraphDocument& document, const std::string& which,
                             const Console& console) {
  try {
    drive::add_covariances(document, which);
    console.end_progress();
  } catch (const InputError& error) {
    console.end_progress();
    document.covariances.clear();
    warn("the result has no covariances: " + std::string(error.what()), document, console);
  }
}

}  // namespace

MultiStartSummary optimize_document(formats::GraphDocument& document, const drive::Minimization& how,
                                    const TypeRegistry& registry, const Console& console,
                                    const Minimizer& search, const std::string& work) {
  IterationTable iterations(console, work);
  const drive::MinimizationWatch watch{
      .observer = [&](const IterationRecord& record) { iterations.add(record); },
      .cancel = &console.cancel()};
  MultiStartSummary result = drive::minimize(document.graph, how, registry, watch, search);
  console.end_progress();
  for (const std::string& note : result.summary.notes) console.note(note);
  if (!result.summary.converged()) console.warning(no_minimum_warning(result.summary));
  document.covariances.clear();
  if (result.summary.converged() && how.covariances != "none") {
    console.progress(work + (work.empty() ? "" : "  ") + "covariances");
    add_covariances_or_warn(document, how.covariances, console);
  }
  return result;
}

std::vector<evaluation::StateReport> states_of_minimum(formats::GraphDocument& document,
                                                       const Summary& summary, const Console& console) {
  if (!summary.converged()) return {};
  try {
    return evaluation::report_states(document);
  } catch (const InputError& error) {
    warn("the estimated states have no sigmas: " + std::string(error.what()), document, console);
    return {};
  }
}

void record_optimization(const MultiStartSummary& result, formats::GraphDocument& document) {
  const Summary& summary = result.summary;
  document.provenance.emplace_back("optimized", fmt::format("waymark {} algorithm {} start {} solver {} {}",
                                                            WAYMARK_VERSION, summary.algorithm, result.start,
                                                            summary.solver, to_string(summary.termination)));
  if (!summary.converged()) document.provenance.emplace_back("warning", no_minimum_warning(summary));
}

void warn(const std::string& warning, formats::GraphDocument& document, const Console& console) {
  console.warning(warning);
  document.provenance.emplace_back("warning", warning);
}

ExitCode exit_code(const Summary& summary) {
  if (summary.termination == Termination::interrupted) return kInterrupted;
  return summary.converged() ? kSuccess : kNotConverged;
}

}  // namespace waymark::program

#include <waymark/tools/evaluation/output/summary_json.hpp>

#include <algorithm>

#include <nlohmann/json.hpp>

#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/json_place.hpp>

namespace waymark::evaluation {
namespace {

RunEnding read_ending(const text::JsonPlace& json) {
  RunEnding ending;
  ending.converged = json.at("converged").flag();
  ending.message = json.text("message");
  ending.iterations = json.count("iterations");
  ending.seconds = json.number("total_seconds");
  ending.initial_chi2 = json.number("initial_chi2");
  ending.final_chi2 = json.number("final_chi2");
  ending.chi2 = {ending.initial_chi2};
  for (const text::JsonPlace& record : json.at("records").items())
    if (record.at("accepted").flag()) ending.chi2.push_back(record.number("chi2"));
  return ending;
}

}  // namespace

nlohmann::ordered_json summary_json(const MultiStartSummary& result) {
  const Summary& s = result.summary;
  nlohmann::ordered_json json = {{"termination", to_string(s.termination)},
                                 {"converged", s.converged()},
                                 {"message", s.message},
                                 {"initial_chi2", text::number_or_null(s.initial_chi2)},
                                 {"final_chi2", text::number_or_null(s.final_chi2)},
                                 {"error_forms", s.error_forms},
                                 {"iterations", s.iterations},
                                 {"start", result.start},
                                 {"algorithm", s.algorithm},
                                 {"solver", s.solver},
                                 {"ordering", s.ordering},
                                 {"vertices", s.vertices},
                                 {"edges", s.edges},
                                 {"unknowns", s.unknowns},
                                 {"factor_size", s.factor_size},
                                 {"structure_seconds", s.structure_seconds},
                                 {"linearize_seconds", s.linearize_seconds},
                                 {"solve_seconds", s.solve_seconds},
                                 {"total_seconds", s.total_seconds},
                                 {"notes", s.notes}};
  json["starts"] = nlohmann::ordered_json::array();
  for (const StartTrial& trial : result.trials) {
    json["starts"].push_back({{"start", trial.start},
                              {"termination", to_string(trial.termination)},
                              {"initial_chi2", text::number_or_null(trial.initial_chi2)},
                              {"final_chi2", text::number_or_null(trial.final_chi2)},
                              {"iterations", trial.iterations},
                              {"seconds", trial.seconds}});
  }
  json["records"] = nlohmann::ordered_json::array();
  for (const IterationRecord& r : s.records) {
    json["records"].push_back({{"iteration", r.iteration},
                               {"kind", r.kind},
                               {"accepted", r.accepted},
                               {"chi2", text::number_or_null(r.chi2)},
                               {"decrease", text::number_or_null(r.decrease)},
                               {"predicted_decrease", text::number_or_null(r.predicted_decrease)},
                               {"newton_decrement", text::number_or_null(r.newton_decrement)},
                               {"gradient", text::number_or_null(r.gradient)},
                               {"step", text::number_or_null(r.step)},
                               {"control", text::number_or_null(r.control)},
                               {"seconds", r.seconds}});
  }
  return json;
}

nlohmann::ordered_json run_summary_json(const std::vector<RunSummary>& runs) {
  nlohmann::ordered_json summaries;
  for (const RunSummary& run : runs) {
    nlohmann::ordered_json& summary = summaries[run.label];
    summary = summary_json(run.result);
    summary["states"] = states_json(run.states);
    summary["noise"] = run.noise;
    summary["without_delay"] = run.without_delay;
  }
  return summaries;
}

RunEnding run_ending(const MultiStartSummary& result) {
  const Summary& summary = result.summary;
  RunEnding ending;
  ending.converged = summary.converged();
  ending.message = summary.message;
  ending.iterations = static_cast<std::size_t>(std::max(summary.iterations, 0));
  ending.seconds = summary.total_seconds;
  ending.initial_chi2 = summary.initial_chi2;
  ending.final_chi2 = summary.final_chi2;
  ending.chi2 = {summary.initial_chi2};
  for (const IterationRecord& record : summary.records)
    if (record.accepted) ending.chi2.push_back(record.chi2);
  return ending;
}

std::map<std::string, RunEnding> read_run_summary(std::string_view content, const std::string& file) {
  const nlohmann::ordered_json document = text::parse_json(content, file);
  const text::JsonPlace json(document, file);
  std::map<std::string, RunEnding> endings;
  for (const std::string& label : json.keys()) {
    if (json.has(label)) endings.emplace(label, read_ending(json.at(label)));
  }
  return endings;
}

}  // namespace waymark::evaluation

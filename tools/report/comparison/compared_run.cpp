#include <map>

#include <waymark/tools/report/comparison/compared_run.hpp>

namespace waymark::report {
namespace {

/// Returns "input" for "input.2"; empty if it is no key of this label ("b.input" of a label "a.b").
std::string key_without_number(const std::string& key) {
  const std::size_t dot = key.find('.');
  if (dot == std::string::npos) return key;
  return key.find_first_not_of("0123456789", dot + 1) == std::string::npos ? key.substr(0, dot) : "";
}

/// Splits entries under one key into several keys if they are about different things. "start=file"
/// under "option" becomes "option start"; the fingerprint of a log is stored under its name.
std::pair<std::string, std::string> parted(const std::string& key, const std::string& text) {
  const std::size_t place = key == "input" ? text.find_last_of(' ') : text.find('=');
  if (place == std::string::npos || key == "assumed") return {key, text};
  return {key + " " + text.substr(0, place), text.substr(place + 1)};
}

/// Returns the word behind another one in "waymark 0.1.0 algorithm dogleg start file solver
/// block_cholesky, ...".
std::string word_behind(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(" " + word + " ");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + word.size() + 2;
  return text.substr(begin, text.find_first_of(" ,", begin) - begin);
}

std::vector<std::pair<std::string, std::string>> provenance_of(const std::string& label,
                                                               const evaluation::ReportHeader& header) {
  std::map<std::string, std::string> entries;
  for (const auto& [name, text] : header.provenance) {
    if (!name.starts_with(label + ".")) continue;
    const std::string key = key_without_number(name.substr(label.size() + 1));
    if (key.empty()) continue;
    if (key == "optimized") {  // RunEnding holds this
      entries["algorithm"] = word_behind(text, "algorithm");
      entries["linear solver"] = word_behind(text, "solver");
      entries["initial guess of the optimisation"] = word_behind(text, "start");
      continue;
    }
    const auto [part, value] = parted(key, text);
    std::string& entry = entries[part];
    entry.append(entry.empty() ? "" : "; ").append(value);
  }
  return {entries.begin(), entries.end()};
}

}  // namespace

ComparedRun compared_run(const evaluation::LabelledEvaluation& evaluation,
                         const evaluation::ReportHeader& header, const MultiStartSummary* result) {
  ComparedRun run;
  run.label = evaluation.label;
  run.drive = header.drive;
  run.evaluation = evaluation.evaluation;
  run.provenance = provenance_of(evaluation.label, header);
  for (const auto& [key, text] : run.provenance)
    if (key == "drive") run.drive = text;
  if (result != nullptr) run.ending = evaluation::run_ending(*result);
  return run;
}

}  // namespace waymark::report

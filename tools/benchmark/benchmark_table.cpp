#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/benchmark/benchmark_report.hpp>

namespace waymark::benchmark {
namespace {

std::string milliseconds(double seconds) {
  return fmt::format("{:.1f}", 1e3 * seconds);
}

std::string megabytes(const std::optional<double>& value) {
  return value ? fmt::format("{:.1f}", *value) : "-";
}

/// Returns "reached", or the distance relative to the optimum: "above by 3.1e-05".
std::string describe_optimality(const CellSummary& cell, double optimum) {
  std::string text(to_string(cell.optimality));
  if (cell.optimality != Optimality::reached && optimum > 0)
    text += fmt::format(" by {:.2g}", std::abs(cell.final_chi2 / optimum - 1));
  return text;
}

/// Returns the peers that were measured with the file, each once.
std::vector<std::string> peers_of(const FileSummary& file) {
  std::vector<std::string> names;
  for (const CellSummary& cell : file.cells) {
    if (cell.peer && std::find(names.begin(), names.end(), cell.name) == names.end())
      names.push_back(cell.name);
  }
  return names;
}

std::string ratio_to(const CellSummary& cell, const std::string& peer) {
  for (const auto& [name, ratio] : cell.peer_ratios)
    if (name == peer) return fmt::format("{:.2f}", ratio);
  return "-";
}

/// Returns each sentence once, however many cells it holds for.
std::vector<std::string> remarks_of(const FileSummary& file) {
  std::vector<std::string> remarks;
  const auto add = [&](std::string text) {
    if (std::find(remarks.begin(), remarks.end(), text) == remarks.end()) remarks.push_back(std::move(text));
  };
  for (const CellSummary& c : file.cells) {
    for (const std::string& note : c.notes) add("note: " + note);
    if (c.converged) continue;
    const std::string who = c.solver.empty() ? c.name : c.name + " with " + c.solver;
    add("! start " + c.start + ", " + who + ": " + c.message);
  }
  return remarks;
}

}  // namespace

text::Table file_table(const FileSummary& file) {
  const std::vector<std::string> peers = peers_of(file);
  text::Row heading = {"start",          "algorithm",  "solver",   "iterations",
                       "median [ms]",    "min [ms]",   "max [ms]", "structure [ms]",
                       "linearise [ms]", "solve [ms]", "rest [ms]"};
  if (!peers.empty()) heading.emplace_back("setup [ms]");
  heading.insert(heading.end(), {"before [MB]", "peak [MB]", "chi2", "optimum"});
  for (const std::string& peer : peers) heading.push_back(peer + "/this");
  text::Table table{
      fmt::format("{}: {} vertices, {} edges; optimum {:.9g} ({})", file.file, file.vertices, file.edges,
                  file.optimum, file.optimum_listed ? "listed" : "lowest chi2 of this run, none is listed"),
      std::move(heading),
      {},
      remarks_of(file)};
  for (const CellSummary& c : file.cells) {
    text::Row row = {c.start,
                     c.name,
                     c.solver,
                     std::to_string(c.iterations) + (c.converged ? "" : "!"),
                     milliseconds(c.seconds.median),
                     milliseconds(c.seconds.least),
                     milliseconds(c.seconds.largest),
                     milliseconds(c.structure_seconds),
                     milliseconds(c.linearize_seconds),
                     milliseconds(c.solve_seconds),
                     milliseconds(c.rest_seconds)};
    if (!peers.empty()) row.push_back(c.peer ? milliseconds(c.setup_seconds.median) : "");
    row.push_back(megabytes(c.memory_before_mb));
    row.push_back(megabytes(c.memory_peak_mb));
    row.push_back(fmt::format("{:.9g}", c.final_chi2));
    row.push_back(describe_optimality(c, file.optimum));
    for (const std::string& peer : peers) row.push_back(ratio_to(c, peer));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string benchmark_table(const std::vector<FileSummary>& files, const text::TextLook& look) {
  std::string text;
  for (const FileSummary& file : files) {
    const text::Table table = file_table(file);
    text.append(text.empty() ? "" : "\n").append(table.title).append("\n");
    text.append(text::aligned_columns(table, look));
    for (const std::string& remark : table.notes) text.append(remark).append("\n");
  }
  return text;
}

}  // namespace waymark::benchmark

/// The results of a benchmark, file by file: statistics, and the table, CSV and JSON
/// made from them.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <waymark/tools/benchmark/known_optima.hpp>
#include <waymark/tools/benchmark/measure.hpp>
#include <waymark/tools/benchmark/statistics.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::benchmark {

/// The statistics of one cell. Its phases are those of the median run, so they sum to the time
/// of that run.
struct CellSummary {
  std::string start;
  std::string name;  ///< of the algorithm or the peer
  std::string solver;
  std::string solver_description;
  bool peer = false;
  std::vector<double> run_seconds;  ///< every repetition, in order
  Spread seconds;
  Spread setup_seconds;  ///< only for a peer
  double structure_seconds = 0;
  double linearize_seconds = 0;
  double solve_seconds = 0;
  double rest_seconds = 0;
  int iterations = 0;
  bool converged = false;
  std::string message;
  std::vector<std::string> notes;
  double initial_chi2 = 0;
  double final_chi2 = 0;
  std::optional<double> memory_before_mb;
  std::optional<double> memory_peak_mb;
  Optimality optimality = Optimality::above;
  /// For each peer: the median over the repetitions of (seconds of the peer / seconds of this cell
  /// in that repetition).
  std::vector<std::pair<std::string, double>> peer_ratios;
};

/// All cells of one file.
struct FileSummary {
  std::string file;         ///< without folder
  std::string fingerprint;  ///< fingerprint of its bytes
  std::size_t vertices = 0;
  std::size_t edges = 0;
  double optimum = 0;
  bool optimum_listed = false;  ///< false: the optimum is the lowest chi2 of this run
  std::vector<CellSummary> cells{};
};

/// The request and the machine: key, text.
using BenchmarkHeader = std::vector<std::pair<std::string, std::string>>;

/// Summarises cells that were measured together, in turn. @param cells from measure(), not empty
[[nodiscard]] std::vector<CellSummary> summarize_cells(const std::string& start,
                                                       const std::vector<Cell>& cells);

/// Sets the optimum (from the list, or else the lowest chi2 of the cells) and compares every
/// cell with it.
void judge_cells(FileSummary& file, const KnownOptima& known);

/// Returns the cells of a file, one per row. The title names the file, its size and its optimum;
/// the notes are remarks about single cells, each sentence once.
[[nodiscard]] text::Table file_table(const FileSummary& file);

/// Returns the tables for the terminal, one per file. Remarks about single cells follow each table.
[[nodiscard]] std::string benchmark_table(const std::vector<FileSummary>& files,
                                          const text::TextLook& look = {});
/// Returns one line per cell. Unknown values are empty fields.
[[nodiscard]] std::string benchmark_csv(const std::vector<FileSummary>& files);
[[nodiscard]] std::string benchmark_json(const std::vector<FileSummary>& files,
                                         const BenchmarkHeader& header);

}  // namespace waymark::benchmark

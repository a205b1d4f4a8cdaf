/// Figures for the page of a benchmark.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::benchmark {

/// Names every cell of a benchmark: the algorithm, and solver and start if they are not the same in
/// all cells. Cells with the same name in different files are one contestant.
class ContestantNames {
 public:
  explicit ContestantNames(const std::vector<FileSummary>& files);

  [[nodiscard]] std::string name_of(const CellSummary& cell) const;
  /// Returns all names, in the order of their first cells.
  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  bool several_solvers_ = false;
  bool several_starts_ = false;
  std::vector<std::string> all_;
};

/// Median times with their spread.
[[nodiscard]] std::vector<drawing::Figure> time_figures(const std::vector<FileSummary>& files,
                                                        const ContestantNames& names);
[[nodiscard]] std::vector<drawing::Figure> memory_figures(const std::vector<FileSummary>& files,
                                                          const ContestantNames& names);
[[nodiscard]] std::vector<drawing::Figure> iteration_figures(const std::vector<FileSummary>& files,
                                                             const ContestantNames& names);
/// Shows how far above the optimum cells ended that did not reach it. Empty if all
/// cells reached it.
[[nodiscard]] std::vector<drawing::Figure> excess_figures(const std::vector<FileSummary>& files,
                                                          const ContestantNames& names);
/// Shows the time of a peer over the time of each contestant, one figure per peer.
[[nodiscard]] std::vector<drawing::Figure> ratio_figures(const std::vector<FileSummary>& files,
                                                         const ContestantNames& names);
/// Shows time against the number of edges, with seven contestants per figure. Empty if all files
/// have one size.
[[nodiscard]] std::vector<drawing::Figure> size_figures(const std::vector<FileSummary>& files,
                                                        const ContestantNames& names);

}  // namespace waymark::benchmark

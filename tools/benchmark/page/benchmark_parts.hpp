/// Figures of a benchmark's page.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::benchmark {

/// Names every cell of a benchmark: the algorithm, and the solver and the start where they are not the same
/// in all cells. Cells of one name in different files are one contestant.
class ContestantNames {
 public:
  explicit ContestantNames(const std::vector<FileSummary>& files);

  [[nodiscard]] std::string name_of(const CellSummary& cell) const;
  /// All of them, in order of their first cells.
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
/// How far above the optimum the cells ended that did not reach it; empty where all did.
[[nodiscard]] std::vector<drawing::Figure> excess_figures(const std::vector<FileSummary>& files,
                                                          const ContestantNames& names);
/// Peer's time over each contestant's, a figure for each peer.
[[nodiscard]] std::vector<drawing::Figure> ratio_figures(const std::vector<FileSummary>& files,
                                                         const ContestantNames& names);
/// Time against the number of edges, seven contestants a figure; empty for files of one size.
[[nodiscard]] std::vector<drawing::Figure> size_figures(const std::vector<FileSummary>& files,
                                                        const ContestantNames& names);

}  // namespace waymark::benchmark

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/benchmark/page/benchmark_page.hpp>
#include <waymark/tools/benchmark/page/benchmark_parts.hpp>

namespace waymark::benchmark {
namespace {

using Files = std::vector<FileSummary>;

/// Tells whether a result counts: it converged, and it is no higher than the best known chi2.
bool counts(const CellSummary& cell) {
  return cell.converged && cell.optimality != Optimality::above;
}

/// Returns the cells that count, fastest first.
std::vector<const CellSummary*> ranking(const FileSummary& file) {
  std::vector<const CellSummary*> cells;
  for (const CellSummary& cell : file.cells)
    if (counts(cell)) cells.push_back(&cell);
  std::stable_sort(cells.begin(), cells.end(), [](const CellSummary* a, const CellSummary* b) {
    return a->seconds.median < b->seconds.median;
  });
  return cells;
}

text::Table winners_table(const Files& files, const ContestantNames& names) {
  text::Table table{
      .title = "Fastest contestants",
      .columns = {"file", "vertices", "edges", "fastest", "median [ms]", "next", "its time / the fastest"}};
  table.notes = {
      "By median time of the results that converged at the optimum. Ratios near 1 mean little if "
      "the brackets of the times overlap."};
  for (const FileSummary& file : files) {
    const auto ranked = ranking(file);
    text::Row row{file.file, std::to_string(file.vertices), std::to_string(file.edges)};
    row.push_back(ranked.empty() ? "none" : names.name_of(*ranked[0]));
    row.push_back(ranked.empty() ? "-" : fmt::format("{:.1f}", 1e3 * ranked[0]->seconds.median));
    row.push_back(ranked.size() < 2 ? "-" : names.name_of(*ranked[1]));
    row.push_back(ranked.size() < 2
                      ? "-"
                      : fmt::format("{:.2f}", ranked[1]->seconds.median / ranked[0]->seconds.median));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Returns "default in 3 of 4 files".
std::string winners_sentence(const Files& files, const ContestantNames& names) {
  std::map<std::string, int> wins;
  for (const FileSummary& file : files) {
    const auto ranked = ranking(file);
    if (!ranked.empty()) ++wins[names.name_of(*ranked[0])];
  }
  std::string text;
  for (const std::string& name : names.all()) {
    if (wins.contains(name))
      text += fmt::format("{}{} in {} of {}", text.empty() ? "" : ", ", name, wins[name], files.size());
  }
  if (text.empty()) return "No result counts: none converged at the optimum.";
  return "Fastest: " + text + (files.size() == 1 ? " file." : " files.");
}

std::string convergence_sentence(const Files& files) {
  std::size_t cells = 0;
  std::size_t missed = 0;
  std::size_t above = 0;
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells) {
      ++cells;
      if (!cell.converged) ++missed;
      if (cell.optimality == Optimality::above) ++above;
    }
  }
  if (missed == 0 && above == 0)
    return fmt::format(" All {} measurements converged and reached the optimum.", cells);
  if (missed == 0) return fmt::format(" All {} measurements converged, {} above the optimum.", cells, above);
  return fmt::format(" Of {} measurements {} did not converge (marked !) and {} ended above the optimum.",
                     cells, missed, above);
}

/// Lists the results that do not count, and why.
text::Table missed_table(const Files& files, const ContestantNames& names) {
  text::Table table{.title = "Not converged, or above the optimum",
                    .columns = {"file", "contestant", "ended", "chi2 / optimum - 1", "message"}};
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells) {
      if (counts(cell)) continue;
      const double excess = cell.final_chi2 / file.optimum - 1;
      table.rows.push_back({file.file, names.name_of(cell),
                            cell.converged ? "above the optimum" : "! not converged",
                            std::isfinite(excess) ? fmt::format("{:.2g}", excess) : "-", cell.message});
    }
  }
  return table;
}

text::Table header_table(const BenchmarkHeader& header) {
  text::Table table{.title = "Settings and machine", .columns = {"", ""}, .words = true};
  for (const auto& [key, text] : header) table.rows.push_back({key, text});
  return table;
}

drawing::Section tables_section(const Files& files) {
  drawing::Section section{"tables", "All numbers", {}};
  section.blocks.emplace_back(drawing::Paragraph{
      "A ! behind the iterations: the run did not converge; the reason is below the table. The "
      "phases are of the median run, in ms. MB are resident memory, 1e6 bytes. A ratio above 1: "
      "faster than the peer."});
  for (const FileSummary& file : files) section.blocks.emplace_back(file_table(file));
  return section;
}

std::string text_of(const BenchmarkHeader& header, const std::string& key) {
  for (const auto& [name, text] : header)
    if (name == key) return text;
  return "unknown";
}

}  // namespace

drawing::Page benchmark_page(const Files& files, const BenchmarkHeader& header) {
  if (files.empty()) throw UsageError("a benchmark page needs at least one file");
  const ContestantNames names(files);
  drawing::Page page;
  page.title = "Benchmark";
  page.subtitle =
      fmt::format("{} file{}, {} contestant{}, {} timed runs of each, on {}", files.size(),
                  files.size() == 1 ? "" : "s", names.all().size(), names.all().size() == 1 ? "" : "s",
                  text_of(header, "repetitions"), text_of(header, "processor"));
  page.summary = winners_sentence(files, names) + convergence_sentence(files);
  page.footer = "Made by waymark " + text_of(header, "waymark") + ".";
  drawing::Section times{"times", "Times", {winners_table(files, names)}};
  drawing::add_figures(time_figures(files, names), times);
  drawing::add_figures(size_figures(files, names), times);
  drawing::add_figures(ratio_figures(files, names), times);
  drawing::Section results{"results", "Results", {}};
  text::Table missed = missed_table(files, names);
  if (!missed.rows.empty()) results.blocks.emplace_back(std::move(missed));
  drawing::add_figures(excess_figures(files, names), results);
  drawing::add_figures(iteration_figures(files, names), results);
  drawing::add_figures(memory_figures(files, names), results);
  drawing::Section conditions{"conditions", "Conditions", {header_table(header)}};
  page.sections = {std::move(times), std::move(results), tables_section(files), std::move(conditions)};
  return page;
}

}  // namespace waymark::benchmark

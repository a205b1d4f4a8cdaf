/// The page of a benchmark.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/drawing/page/page.hpp>

namespace waymark::benchmark {

/// Who was fastest where, times with their spread, time against size, ratios to peers, memory, iterations,
/// optima, and the tables of the terminal.
/// @param header  what was asked for, and on what it ran
/// @throws UsageError for no files
[[nodiscard]] drawing::Page benchmark_page(const std::vector<FileSummary>& files,
                                           const BenchmarkHeader& header);

}  // namespace waymark::benchmark

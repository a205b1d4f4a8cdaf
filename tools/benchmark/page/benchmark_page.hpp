/// The page of a benchmark.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/drawing/page/page.hpp>

namespace waymark::benchmark {

/// Returns the page: the fastest contestant per file, times with their spread, time against size,
/// ratios to peers, memory, iterations, optima, and the tables of the terminal.
/// @param header the request and the machine
/// @throws UsageError if there are no files
[[nodiscard]] drawing::Page benchmark_page(const std::vector<FileSummary>& files,
                                           const BenchmarkHeader& header);

}  // namespace waymark::benchmark

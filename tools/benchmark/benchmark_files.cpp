#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/text/json_number.hpp>

namespace waymark::benchmark {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the shortest text that reads back to the same number; empty if it is undefined.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}
std::string number(const std::optional<double>& value) {
  return value ? number(*value) : "";
}

Json number_or_null(const std::optional<double>& value) {
  return value ? text::number_or_null(*value) : Json(nullptr);
}

Json cell_json(const CellSummary& c) {
  Json json = {{"start", c.start},
               {"algorithm", c.name},
               {"solver", c.solver},
               {"solver_description", c.solver_description},
               {"peer", c.peer},
               {"iterations", c.iterations},
               {"converged", c.converged},
               {"message", c.message},
               {"median_seconds", c.seconds.median},
               {"min_seconds", c.seconds.least},
               {"max_seconds", c.seconds.largest},
               {"structure_seconds", c.structure_seconds},
               {"linearize_seconds", c.linearize_seconds},
               {"solve_seconds", c.solve_seconds},
               {"rest_seconds", c.rest_seconds},
               {"setup_seconds", c.setup_seconds.median},
               {"run_seconds", c.run_seconds},
               {"memory_before_mb", number_or_null(c.memory_before_mb)},
               {"memory_peak_mb", number_or_null(c.memory_peak_mb)},
               {"initial_chi2", number_or_null(c.initial_chi2)},
               {"chi2", number_or_null(c.final_chi2)},
               {"optimality", to_string(c.optimality)}};
  json["peer_ratios"] = Json::object();
  for (const auto& [peer, ratio] : c.peer_ratios) json["peer_ratios"][peer] = ratio;
  json["notes"] = c.notes;
  return json;
}

constexpr const char* kCsvColumns[] = {"file",
                                       "vertices",
                                       "edges",
                                       "start",
                                       "algorithm",
                                       "solver",
                                       "peer",
                                       "repetitions",
                                       "iterations",
                                       "converged",
                                       "median_s",
                                       "min_s",
                                       "max_s",
                                       "structure_s",
                                       "linearize_s",
                                       "solve_s",
                                       "rest_s",
                                       "setup_s",
                                       "memory_before_mb",
                                       "memory_peak_mb",
                                       "initial_chi2",
                                       "chi2",
                                       "optimum",
                                       "optimum_listed",
                                       "optimality",
                                       "peer_ratios",
                                       "message"};

text::Row csv_row(const FileSummary& file, const CellSummary& c) {
  std::vector<std::string> ratios;
  for (const auto& [peer, ratio] : c.peer_ratios) ratios.push_back(fmt::format("{}={}", peer, ratio));
  return {file.file,
          std::to_string(file.vertices),
          std::to_string(file.edges),
          c.start,
          c.name,
          c.solver,
          c.peer ? "1" : "0",
          std::to_string(c.run_seconds.size()),
          std::to_string(c.iterations),
          c.converged ? "1" : "0",
          number(c.seconds.median),
          number(c.seconds.least),
          number(c.seconds.largest),
          number(c.structure_seconds),
          number(c.linearize_seconds),
          number(c.solve_seconds),
          number(c.rest_seconds),
          number(c.setup_seconds.median),
          number(c.memory_before_mb),
          number(c.memory_peak_mb),
          number(c.initial_chi2),
          number(c.final_chi2),
          number(file.optimum),
          file.optimum_listed ? "1" : "0",
          std::string(to_string(c.optimality)),
          fmt::format("{}", fmt::join(ratios, ";")),
          c.message};
}

}  // namespace

std::string benchmark_csv(const std::vector<FileSummary>& files) {
  text::Table table{.columns = {std::begin(kCsvColumns), std::end(kCsvColumns)}};
  for (const FileSummary& file : files) {
    for (const CellSummary& cell : file.cells) table.rows.push_back(csv_row(file, cell));
  }
  return text::table_csv(table);
}

std::string benchmark_json(const std::vector<FileSummary>& files, const BenchmarkHeader& header) {
  Json json = {{"schema", "waymark-bench"}, {"version", 1}};
  for (const auto& [key, text] : header) json["header"][key] = text;
  json["files"] = Json::array();
  for (const FileSummary& file : files) {
    Json entry = {{"file", file.file},
                  {"fingerprint", file.fingerprint},
                  {"vertices", file.vertices},
                  {"edges", file.edges},
                  {"optimum", number_or_null(file.optimum)},
                  {"optimum_source", file.optimum_listed ? "listed" : "lowest of this run"}};
    entry["cells"] = Json::array();
    for (const CellSummary& cell : file.cells) entry["cells"].push_back(cell_json(cell));
    json["files"].push_back(std::move(entry));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace waymark::benchmark

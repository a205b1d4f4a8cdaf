#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/named_start.hpp>
#include <waymark/formats/graph/graph_text.hpp>
#include <waymark/formats/text/hash.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/benchmark/contestants.hpp>
#include <waymark/tools/benchmark/page/benchmark_page.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/graph/graph_files.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

using Names = std::vector<std::string>;

struct BenchOptions {
  CommonOptions common;
  drive::Minimization
      minimization;  ///< the defaults of `optimize`; the command line sets only the stopping rules
  Names files;
  std::string input_format = "graph";
  Names algorithms;
  Names solvers;
  Names starts = {"file"};
  Names peers;
  int repeat = 5;
  std::string optima;
  std::string folder;
};

template <typename Type>
Names all_names(const RegistryTable<Type>& table) {
  Names names;
  for (const auto& entry : table) names.push_back(entry.type.name);
  return names;
}

/// Returns the names to use. Empty: that of `optimize`; "all": every registered one.
Names chosen(const Names& asked, const std::string& by_default, const Names& all) {
  if (asked.empty()) return {by_default};
  return std::find(asked.begin(), asked.end(), "all") == asked.end() ? asked : all;
}

std::vector<benchmark::Contestant> make_contestants(const BenchOptions& options,
                                                    const TypeRegistry& registry) {
  const OptimizerOptions rules = drive::optimizer_options(options.minimization, {.cancel = &interrupted});
  const Names all_solvers = all_names(registry.linear_solvers());
  const std::string solver = drive::solver_name(options.minimization, registry);
  Names backends = chosen(options.solvers, solver, all_solvers);
  std::replace(backends.begin(), backends.end(), std::string("auto"), solver);
  std::vector<benchmark::Contestant> contestants;
  for (const std::string& algorithm : chosen(options.algorithms, std::string(benchmark::kDefaultContestant),
                                             all_names(registry.algorithms()))) {
    for (const std::string& backend : backends) {
      contestants.push_back(
          algorithm == benchmark::kDefaultContestant
              ? benchmark::default_contestant(options.minimization.algorithm, backend, rules, registry)
              : benchmark::waymark_contestant(algorithm, backend, rules, registry));
    }
  }
  for (const std::string& peer : options.peers)
    contestants.push_back(benchmark::peer_contestant(peer, rules));
  return contestants;
}

/// A file in memory.
struct LoadedGraph {
  std::string name;  ///< without folder
  std::string fingerprint;
  Graph graph;
  bool edges_only = false;
};

LoadedGraph load(const std::string& path, const std::string& format, const TypeRegistry& registry) {
  const std::string text = formats::read_graph_text(path, registry);
  formats::ReadReport report;
  formats::GraphDocument document = formats::read_graph_as(*formats::graph_format_from_string(format), text,
                                                           path, registry, false, &report);
  return {std::filesystem::path(path).filename().string(), formats::fnv1a64_hex(text),
          std::move(document.graph), report.edges_only};
}

/// Puts the values of a start into the graph. @throws InputError if it cannot be computed
void apply_start(const std::string& name, LoadedGraph& loaded, const TypeRegistry& registry,
                 const Console& console) {
  if (name == kFileStart) return;
  InitialValues start = registry.make_start(name, loaded.graph);
  if (start.values.empty()) {
    throw InputError(loaded.name + ": initial guess " + name + " cannot be made: " + start.note);
  }
  loaded.graph.set_values(std::move(start.values));
  if (start.apart > 0) console.note(loaded.name + ", initial guess " + name + ": " + apart_note(start.apart));
}

/// Returns the starts that differ for this file. A file without vertices has no values of its own.
Names starts_of(const LoadedGraph& loaded, const Names& asked, const Console& console) {
  Names starts = asked;
  const bool both = std::find(asked.begin(), asked.end(), "odometry") != asked.end();
  if (loaded.edges_only) {
    console.note(loaded.name + " has edges only: its initial guess 'file' is the odometry chain");
    if (both) starts.erase(std::remove(starts.begin(), starts.end(), kFileStart), starts.end());
  }
  return starts;
}

/// Measures all starts of a file. @return nothing if interrupted
std::optional<benchmark::FileSummary> bench_file(const std::string& path, const BenchOptions& options,
                                                 std::span<const benchmark::Contestant> contestants,
                                                 const TypeRegistry& registry, const Console& console,
                                                 StepProgress& progress) {
  console.progress("reading " + path);
  LoadedGraph loaded = load(path, options.input_format, registry);
  benchmark::FileSummary file{loaded.name, loaded.fingerprint, loaded.graph.vertex_count(),
                              loaded.graph.edge_count()};
  const std::vector<double> values = loaded.graph.values();
  for (const std::string& start : starts_of(loaded, options.starts, console)) {
    loaded.graph.set_values(values);
    apply_start(start, loaded, registry, console);
    const std::string what = loaded.name + " from " + start;
    console.detail("measuring " + what);
    const benchmark::MeasureOptions measuring{
        options.repeat, &interrupted, [&](const std::string& run) { progress.next(what + "  " + run); }};
    const std::vector<benchmark::Cell> cells = benchmark::measure(loaded.graph, contestants, measuring);
    if (cells.empty()) return std::nullopt;
    for (benchmark::CellSummary& cell : benchmark::summarize_cells(start, cells))
      file.cells.push_back(std::move(cell));
  }
  return file;
}

/// Returns "AMD EPYC" from "model name : AMD EPYC" of /proc/cpuinfo; a time means
/// nothing without it.
std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  }
  return "unknown";
}

benchmark::BenchmarkHeader make_header(const BenchOptions& options) {
  const drive::Minimization& minimization = options.minimization;
  benchmark::BenchmarkHeader header = {{"waymark", WAYMARK_VERSION},
                                       {"processor", processor()},
                                       {"repetitions", std::to_string(options.repeat)},
                                       {"max_iterations", std::to_string(minimization.max_iterations)},
                                       {"decrement_tolerance", fmt::format("{}", minimization.tolerance)}};
  for (const std::string& peer : benchmark::built_in_peers()) header.emplace_back("peer", peer);
  return header;
}

ExitCode bench(const BenchOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry = make_registry(options.common);
  const std::vector<benchmark::Contestant> contestants = make_contestants(options, registry);
  for (const std::string& start : options.starts) check_start(start, registry, {kFileStart});
  benchmark::KnownOptima known;
  if (!options.optima.empty())
    known = benchmark::read_known_optima(
        formats::read_text_file(options.optima, {.check = formats::require_digits(options.optima)}),
        options.optima);
  if (!options.folder.empty()) formats::make_folder(options.folder);
  // A wrong file at the end of the list is found before hours of work.
  for (std::size_t i = 1; i < options.files.size(); ++i) {
    console.progress("reading " + options.files[i]);
    (void)load(options.files[i], options.input_format, registry);
  }

  std::vector<benchmark::FileSummary> files;
  const std::size_t runs_of_start = contestants.size() * (1 + static_cast<std::size_t>(options.repeat));
  StepProgress progress(console, options.files.size() * options.starts.size() * runs_of_start);
  for (const std::string& path : options.files) {
    auto file = bench_file(path, options, contestants, registry, console, progress);
    if (!file) break;
    benchmark::judge_cells(*file, known);
    files.push_back(std::move(*file));
  }
  if (files.empty()) throw Interrupted();
  const benchmark::BenchmarkHeader header = make_header(options);
  const std::string json = benchmark::benchmark_json(files, header);
  if (!options.folder.empty()) {
    formats::write_file_atomically(options.folder + "/bench.csv", benchmark::benchmark_csv(files));
    formats::write_file_atomically(options.folder + "/bench.json", json);
    drawing::write_page(benchmark::benchmark_page(files, header), options.folder, "bench");
  }
  console.result(options.common.json ? json : benchmark::benchmark_table(files, console.look()));
  if (!interrupted) return kSuccess;
  console.warning("interrupted; only files that were finished are reported");
  return kInterrupted;
}

/// @param type type of one name, for the help
void add_name_list(CLI::App& command, const std::string& flags, Names& names, const std::string& type,
                   const std::string& about) {
  command.add_option(flags, names, about)
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name(type + "[,...]");
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "bench",
      "Measure algorithms, solvers and peers on a list of graphs\n\n"
      "Runs each contestant on each graph in turn. Prints the median time with its spread, "
      "iterations, memory, and whether the known optimum was reached.");
  const auto options = std::make_shared<BenchOptions>();
  command->add_option("graphs", options->files, "Graph files: .graph, g2o, or as --input-format says")
      ->required()
      ->type_name("GRAPH");
  add_input_format(*command, options->input_format);
  add_name_list(
      *command, "-a,--algorithm", options->algorithms, "ALGORITHM|all|default",
      "Algorithms, 'all', or 'default': the configuration of 'optimize' with its initial guesses (default)");
  add_name_list(*command, "-s,--solver", options->solvers, "SOLVER|all|auto",
                "Linear solvers, 'all' or 'auto' (default)");
  add_name_list(*command, "--start", options->starts, "START|file",
                "Initial guesses: file (default), and those that `waymark info` lists");
  add_name_list(*command, "--peer", options->peers, "ceres|ceres_dogleg",
                "Peers to measure in turn with: ceres (Levenberg-Marquardt), ceres_dogleg");
  command->add_option("--repeat", options->repeat, "Timed runs of each contestant on each graph")
      ->check(CLI::Validator(
          [](const std::string& text) {
            int value = 0;
            const bool number = CLI::detail::lexical_cast(text, value);
            return number && value >= 1 ? std::string() : "must be at least 1, got " + text;
          },
          ""))
      ->capture_default_str();
  command
      ->add_option("--optima", options->optima,
                   "Known optima, CSV 'file,chi2' (examples/benchmarks/standard_graphs.csv)")
      ->type_name("FILE.csv");
  add_stopping_options(*command, options->minimization);
  command
      ->add_option("-o,--out", options->folder,
                   "Folder for bench.html with its figures, bench.csv and bench.json")
      ->type_name("DIR");
  add_common_options(*command, options->common);
  command->footer(
      "A run that does not converge is marked '!' and does not change the exit code.\n"
      "Example:\n  waymark bench city10000.g2o intel.g2o --start file,odometry --peer "
      "ceres --out results");
  command->callback([options, &action] { action = [options] { return bench(*options); }; });
}

}  // namespace waymark::program

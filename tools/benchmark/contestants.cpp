#include <waymark/tools/benchmark/contestants.hpp>

#include <array>
#include <chrono>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/optimize/multi_start.hpp>
#ifdef WAYMARK_WITH_CERES
#include <waymark/tools/benchmark/ceres/ceres_peer.hpp>
#endif

namespace waymark::benchmark {
namespace {

constexpr std::array<std::string_view, 2> kPeerNames = {"ceres", "ceres_dogleg"};

RunOutcome describe(const Summary& summary, std::chrono::steady_clock::time_point begin) {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  return {.total_seconds = elapsed.count(),
          .structure_seconds = summary.structure_seconds,
          .linearize_seconds = summary.linearize_seconds,
          .solve_seconds = summary.solve_seconds,
          .iterations = summary.iterations,
          .initial_chi2 = summary.initial_chi2,
          .final_chi2 = summary.final_chi2,
          .converged = summary.converged(),
          .message = summary.message,
          .solver_description = summary.solver,
          .notes = summary.notes};
}

/// @param minimize (graph, algorithm, solver) -> Summary; creating the last two is timed too
template <typename Minimize>
Contestant make_contestant(std::string name, const std::string& algorithm, const std::string& solver,
                           const TypeRegistry& registry, Minimize minimize) {
  (void)registry.make_algorithm(algorithm);  // refuses an unknown name before anything is measured
  (void)registry.make_linear_solver(solver);
  return {std::move(name), solver, false, [=, &registry](Graph& graph) {
            const auto begin = std::chrono::steady_clock::now();
            const auto method = registry.make_algorithm(algorithm);
            const auto backend = registry.make_linear_solver(solver);
            return describe(minimize(graph, *method, *backend), begin);
          }};
}

}  // namespace

Contestant waymark_contestant(const std::string& algorithm, const std::string& solver,
                              const OptimizerOptions& options, const TypeRegistry& registry) {
  return make_contestant(algorithm, algorithm, solver, registry,
                         [=](Graph& graph, Algorithm& method, LinearSolver& backend) {
                           return optimize(graph, method, backend, options);
                         });
}

Contestant default_contestant(const std::string& algorithm, const std::string& solver,
                              const OptimizerOptions& options, const TypeRegistry& registry) {
  return make_contestant(
      std::string(kDefaultContestant), algorithm, solver, registry,
      [=, &registry](Graph& graph, Algorithm& method, LinearSolver& backend) {
        return optimize_from_best_start(graph, registry.starts(), method, backend, options).summary;
      });
}

Contestant peer_contestant(std::string_view name, const OptimizerOptions& options) {
  if (name != kPeerNames[0] && name != kPeerNames[1]) {
    throw UsageError("unknown peer '" + std::string(name) + "'" + suggestion(name, kPeerNames));
  }
#ifdef WAYMARK_WITH_CERES
  const CeresOptions ceres{name == "ceres" ? CeresMethod::levenberg_marquardt : CeresMethod::dogleg,
                           options.max_iterations, options.cancel};
  return {std::string(name), "", true, [=](Graph& graph) { return optimize_with_ceres(graph, ceres); }};
#else
  (void)options;
  throw UsageError("peer '" + std::string(name) +
                   "': this program was built without Ceres; install the Debian package libceres-dev "
                   "and build again with -DWAYMARK_WITH_CERES=ON");
#endif
}

std::vector<std::string> built_in_peers() {
#ifdef WAYMARK_WITH_CERES
  return {ceres_version()};
#else
  return {};
#endif
}

}  // namespace waymark::benchmark

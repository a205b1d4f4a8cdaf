/// The contestants of a benchmark: algorithms of Waymark with their solvers, and the peers that
/// were built in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/benchmark/measure.hpp>

namespace waymark::benchmark {

/// @param registry must outlive the contestant. @throws UsageError for an unknown name.
[[nodiscard]] Contestant waymark_contestant(const std::string& algorithm, const std::string& solver,
                                            const OptimizerOptions& options, const TypeRegistry& registry);

/// The name of the default configuration.
inline constexpr std::string_view kDefaultContestant = "default";

/// Returns the default configuration as `optimize` runs it. It takes the present values or a
/// better initial guess. If the minimum is implausible, it tries further ones. The time includes
/// computing them.
[[nodiscard]] Contestant default_contestant(const std::string& algorithm, const std::string& solver,
                                            const OptimizerOptions& options, const TypeRegistry& registry);

/// Returns "ceres" (Levenberg-Marquardt) or "ceres_dogleg". Both stop by Ceres's own rule (see
/// ceres_peer.hpp). Of the options they use max_iterations and cancel.
/// @throws UsageError for an unknown name, and if the peer was not built in
[[nodiscard]] Contestant peer_contestant(std::string_view name, const OptimizerOptions& options);

/// Returns name and version of each peer that was built in: "Ceres 2.1.0".
[[nodiscard]] std::vector<std::string> built_in_peers();

}  // namespace waymark::benchmark

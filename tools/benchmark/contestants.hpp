/// Who can be measured: Waymark's algorithms with its solvers, and the peers that were built in.
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

/// The default configuration, as `optimize` runs it: the values at hand or a better start, and further ones
/// where the minimum is implausible; making starts is timed with the rest.
[[nodiscard]] Contestant default_contestant(const std::string& algorithm, const std::string& solver,
                                            const OptimizerOptions& options, const TypeRegistry& registry);

/// "ceres": Levenberg-Marquardt; "ceres_dogleg". Both stop by Ceres's own rule (see ceres_peer.hpp); of the
/// options they take max_iterations and cancel.
/// @throws UsageError for an unknown name, or where the peer was not built in.
[[nodiscard]] Contestant peer_contestant(std::string_view name, const OptimizerOptions& options);

/// Name and version of each peer that was built in: "Ceres 2.1.0".
[[nodiscard]] std::vector<std::string> built_in_peers();

}  // namespace waymark::benchmark

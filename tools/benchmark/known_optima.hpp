/// The best known chi2 of benchmark graphs, and a test whether a result reaches it.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace waymark::benchmark {

/// chi2 by file name without folder.
using KnownOptima = std::map<std::string, double, std::less<>>;

/// Reads "file,chi2" lines. A line with '#' is a comment; the heading `file,chi2` comes first.
/// @throws InputError "optima.csv:3:10: ..." for anything else, a chi2 below 0 or a file
/// named twice.
[[nodiscard]] KnownOptima read_known_optima(std::string_view text, const std::string& name);

enum class Optimality {
  reached,  ///< |chi2 - optimum| <= 1e-6 optimum, or <= 1e-9 if the optimum is almost zero
  lower,    ///< below that: the listed optimum is not the optimum
  above     ///< above that, or not finite
};

[[nodiscard]] Optimality compare_with_optimum(double chi2, double optimum);
[[nodiscard]] std::string_view to_string(Optimality optimality);

}  // namespace waymark::benchmark

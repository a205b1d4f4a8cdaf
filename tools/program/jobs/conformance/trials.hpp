/// The conformance kit: tries what plugins register, on problems with a known answer. `waymark check --all`
/// runs it, and so may the tests of a plugin.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>

namespace waymark::program {

/// The result of trying one registered type.
struct Trial {
  std::string kind;  ///< "linear solver", "sensor model", ...
  std::string name;
  std::string origin;                 ///< the plugin
  std::vector<std::string> problems;  ///< sentences; empty: it passed
  std::string note;                   ///< why something could not be tried; empty: all was
};

/// Tells whether types of an origin are to be tried.
using Wanted = std::function<bool(const std::string& origin)>;

/// Linear solvers, algorithms and initial guesses on a ring of poses: their minimum is that of Waymark's
/// own; a matrix that is indefinite or not finite is told by the status.
[[nodiscard]] std::vector<Trial> try_solvers(const TypeRegistry& registry, const Wanted& wanted);

/// Odometry models, GNSS modelings and sensors on a simulated minute: a drive in two parts gives the graph of
/// the whole; everything is finite; modelings and odometry models come near the truth. Sensors get readings
/// of the circle by the units and senses of their columns, and may refuse them with an InputError.
[[nodiscard]] std::vector<Trial> try_models(const TypeRegistry& registry, const Wanted& wanted);

/// Log readers on rubbish: an InputError or counted records, and the same in pieces of any size.
[[nodiscard]] std::vector<Trial> try_readers(const TypeRegistry& registry, const Wanted& wanted);

/// Runs one trial. What it throws is one of its problems.
void run_trial(Trial& trial, const std::function<void(Trial&)>& steps);

}  // namespace waymark::program

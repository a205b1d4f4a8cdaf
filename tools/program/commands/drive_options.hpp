/// Command-line options that `convert` and `run` share, and those that `optimize` and `run` share.
#pragma once

#include <CLI/CLI.hpp>

#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/pipeline.hpp>

namespace waymark::program {

void add_drive_options(CLI::App& command, DriveOverrides& overrides);
void add_optimization_options(CLI::App& command, OptimizationChoice& choice);
/// Those of them that say when to stop; `bench` has these alone.
void add_stopping_options(CLI::App& command, OptimizationChoice& choice);

}  // namespace waymark::program

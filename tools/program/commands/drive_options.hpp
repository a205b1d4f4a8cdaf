/// Command-line options that `convert` and `run` share, and those that `optimize` and `run` share.
#pragma once

#include <CLI/CLI.hpp>

#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/program/jobs/drive_choice.hpp>

namespace waymark::program {

void add_drive_options(CLI::App& command, DriveChoice& choice);
void add_optimization_options(CLI::App& command, drive::Minimization& minimization);
/// Adds those of them that say when to stop; `bench` has only these.
void add_stopping_options(CLI::App& command, drive::Minimization& minimization);

}  // namespace waymark::program

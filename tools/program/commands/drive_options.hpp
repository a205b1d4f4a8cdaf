/// Command-line options that several commands share.
#pragma once

#include <CLI/CLI.hpp>

#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/program/jobs/drive_choice.hpp>

namespace waymark::program {

/// Adds those of `convert` and `run`.
void add_drive_options(CLI::App& command, DriveChoice& choice);
/// Adds those of `optimize` and `run`.
void add_optimization_options(CLI::App& command, drive::Minimization& minimization);
/// Adds those of them that say when to stop; `bench` has only these.
void add_stopping_options(CLI::App& command, drive::Minimization& minimization);

/// Adds --map, of `run` and `evaluate`.
void add_map_option(CLI::App& command, std::string& file);

}  // namespace waymark::program

/// The findings of `waymark doctor`, as JSON (schema waymark-doctor, version 1) and as text
/// made from it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/program/terminal/exit_codes.hpp>

namespace waymark::program {

struct Diagnosis {
  nlohmann::ordered_json json;
  /// of the worst problem: a solver comes first, then plugins and inputs, then the folder
  ExitCode code = kSuccess;
};

/// Examines the program, its plugins, the present folder and the terminal. It does not throw for
/// problems that it finds.
/// @param paths drive.yaml and graph files, each read once, with all plugins
[[nodiscard]] Diagnosis diagnose(const CommonOptions& options, const std::vector<std::string>& paths);

/// Returns the text for people.
[[nodiscard]] std::string diagnosis_text(const nlohmann::ordered_json& json);

}  // namespace waymark::program

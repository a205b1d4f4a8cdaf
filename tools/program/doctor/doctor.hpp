/// What `waymark doctor` finds out, as JSON (schema waymark-doctor, version 1) and as text made from it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/program/terminal/exit_codes.hpp>

namespace waymark::program {

struct Diagnosis {
  nlohmann::ordered_json json;
  ExitCode code = kSuccess;  ///< of the gravest problem: a solver, then plugins and inputs, then the folder
};

/// Looks at the program, its plugins, the present folder and the terminal. Throws for no problem that it
/// finds.
/// @param inputs  drive.yaml and graph files, read with all plugins
[[nodiscard]] Diagnosis diagnose(const CommonOptions& options, const std::vector<std::string>& inputs);

/// For people.
[[nodiscard]] std::string diagnosis_text(const nlohmann::ordered_json& json);

}  // namespace waymark::program

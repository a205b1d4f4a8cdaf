/// The one YAML document of a drive.yaml, before anything of it is understood.
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

namespace waymark::drive {

/// Returns the document, or an undefined node for a text without one.
/// @param path for messages
/// @throws InputError with line and column if the text is no YAML or more than one document, if its values are nested
/// more than 50 deep, or if they are more than 100,000 with their aliases
[[nodiscard]] YAML::Node load_yaml_document(const std::string& text, const std::string& path);

}  // namespace waymark::drive

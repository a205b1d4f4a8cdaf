/// Checks output places before the work, because an hour of optimisation must not fail at the name
/// of a folder.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace waymark::program {

/// Tells whether a file with this name is the standard output. Reports must then not be
/// printed there.
[[nodiscard]] bool is_stdout(const std::string& path);

/// @throws OutputError if it is already clear that the file cannot be written: it is a folder, or
/// its folder does not exist
void require_output_place(const std::string& path);

/// Refuses an output that is also an input. This is a slip of the user, and a log cannot be
/// measured again.
/// @throws UsageError if `output` is one of the files that are read
void require_not_read(const std::string& output, const std::vector<std::string>& read);

/// Returns the output of --json: a document of this kind with "schema": "waymark-KIND", "version":
/// 1, and then the keys of `json`. tools/program/JSON.md lists the keys of every kind; a test
/// compares the two.
[[nodiscard]] std::string json_document(const std::string& kind, const nlohmann::ordered_json& json);

/// Returns indented JSON for people and files. Bytes that are not UTF-8 (a file name may be
/// anything) are replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

}  // namespace waymark::program

/// Where results go, looked at before the work is done: an hour of optimisation must not end at a folder's
/// name.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace waymark::program {

/// Whether a file of this name goes to the standard output, so that reports must not.
[[nodiscard]] bool is_stdout(const std::string& path);

/// @throws OutputError where the file cannot be written for a reason that shows already: it is a folder, or
/// its folder does not exist.
void require_output_place(const std::string& path);

/// Whoever names an input as the output has made a slip; a log cannot be measured again.
/// @throws UsageError where `output` is one of the files that are read
void require_not_read(const std::string& output, const std::vector<std::string>& read);

/// What --json prints: a document of this kind, "schema": "waymark-KIND", "version": 1, then the keys of
/// `json`. tools/program/JSON.md lists the keys of every kind; a test compares the two.
[[nodiscard]] std::string json_document(const std::string& kind, const nlohmann::ordered_json& json);

/// JSON for people and files: indented; what is not UTF-8 (a file name may be anything) is replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

}  // namespace waymark::program

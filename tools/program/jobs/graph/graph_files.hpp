/// Graph files on the command line: which format is read, which is written, what is said about it.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <waymark/formats/graph/foreign_graph.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// --input-format: how a graph file is read.
void add_input_format(CLI::App& command, std::string& format);

/// What is written: --format, --profile.
struct OutputFormat {
  std::string format;   ///< empty: the profile's own, without one `graph`
  std::string profile;  ///< empty: for any reader of the format
};
/// Only --format where `with_profile` is false.
void add_output_format(CLI::App& command, OutputFormat& output, bool with_profile);

/// @throws UsageError where the profile's reader does not read the format
[[nodiscard]] formats::GraphFormat chosen_format(const OutputFormat& output);

/// Reads a graph file and says on the console what was skipped or made up.
[[nodiscard]] formats::GraphDocument read_graph_file(const std::string& text, const std::string& name,
                                                     const std::string& format, bool lenient,
                                                     const TypeRegistry& registry, const Console& console);

/// Finds out before the work whether the format can hold the graph, and says what it will leave out or say
/// otherwise. @param name of the graph, for messages. @throws InputError, UsageError
void announce_output(const OutputFormat& output, const formats::GraphDocument& document,
                     const std::string& name, const Console& console);

/// Writes the file, quietly. @throws as announce_output
void write_graph_file(const std::string& path, const OutputFormat& output,
                      const formats::GraphDocument& document, const std::string& name,
                      const TypeRegistry& registry);

}  // namespace waymark::program

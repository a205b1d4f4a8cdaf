/// Graph files on the command line: the input format, the output format, and the
/// messages about them.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <waymark/formats/graph/detail/foreign_graph.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// Adds --input-format: how a graph file is read.
void add_input_format(CLI::App& command, std::string& format);

/// The output format: --format, --profile.
struct OutputFormat {
  std::string format;   ///< empty: that of the profile, or `graph` without one
  std::string profile;  ///< empty: for any reader of the format
};
/// Adds --format, and --profile if `with_profile` is set.
void add_output_format(CLI::App& command, OutputFormat& output, bool with_profile);

/// @throws UsageError if the reader of the profile does not read the format
[[nodiscard]] formats::GraphFormat chosen_format(const OutputFormat& output);

/// Reads a graph file, and reports on the console what was skipped or made up.
[[nodiscard]] formats::GraphDocument read_graph_file(const std::string& text, const std::string& name,
                                                     const std::string& format, bool lenient,
                                                     const TypeRegistry& registry, const Console& console);

/// Checks before the work whether the format can hold the graph, and reports what it will leave out
/// or rewrite. @param name name of the graph, for messages @throws InputError, UsageError
void announce_output(const OutputFormat& output, const formats::GraphDocument& document,
                     const std::string& name, const Console& console);

/// Writes the file without messages. @throws as announce_output
void write_graph_file(const std::string& path, const OutputFormat& output,
                      const formats::GraphDocument& document, const std::string& name,
                      const TypeRegistry& registry);

}  // namespace waymark::program

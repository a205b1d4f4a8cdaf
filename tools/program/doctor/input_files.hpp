/// The files that `waymark doctor` is given: drives and graphs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>

namespace waymark::program {

/// A file that was read, once: a second reading of a pipe would wait for ever.
struct ReadInput {
  std::string path;
  std::optional<drive::DriveFile> drive;  ///< empty: a graph
  std::string graph;                      ///< text of the graph
  std::string problem;                    ///< why it could not be read; empty: it was
};

/// Reads the files. It does not throw for those that cannot be read.
[[nodiscard]] std::vector<ReadInput> read_inputs(const std::vector<std::string>& paths);

/// Returns the plugins that the drives name.
[[nodiscard]] std::vector<std::string> plugins_of(const std::vector<ReadInput>& inputs);

/// Describes the content of a file in a few words. @throws InputError, UsageError
[[nodiscard]] std::string describe_input(const ReadInput& input, const TypeRegistry& registry);

}  // namespace waymark::program

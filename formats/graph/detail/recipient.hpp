/// Recipients: programs that read graph files, and what they support. These are facts about other
/// programs, one table row each. foreign_graph.hpp decides how a graph is expressed for them and
/// what would be lost.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <waymark/core/graph/vertex.hpp>
#include <waymark/formats/graph/graph_format.hpp>

namespace waymark::formats {

/// How the recipient treats FIX.
enum class Fixing {
  stated,     ///< the file says which vertices are fixed
  none,       ///< nothing is fixed; the reader chooses the frame
  lowest_id,  ///< the reader always fixes the vertex with the lowest id, and no other
};

struct Recipient {
  std::string_view name;    ///< name of the profile, or of the format if any reader of it is meant
  std::string_view reader;  ///< name of the reader in messages
  /// formats that it reads; the first is the default for writing
  std::span<const GraphFormat> formats;
  /// vertices and edges that it reads, as our own formats call them
  std::span<const std::string_view> tags;
  Fixing fixing = Fixing::none;
  VertexId least_id{std::numeric_limits<std::int64_t>::min()};
  VertexId most_id{std::numeric_limits<std::int64_t>::max()};
  bool zero_information = true;      ///< it understands an axis without information
  bool parallel_edges = true;        ///< it counts a second edge between the same two vertices
  bool separate_parts = true;        ///< one file may hold parts that no edge joins
  bool applies_point_offset = true;  ///< its error of EDGE_SE2_POINTXY_OFFSET uses the offset
  /// it evaluates EDGE_SE2 like the example of Ceres: say_for_example()
  bool evaluates_as_example = false;
};

/// Returns a recipient that stands for every reader of this format. @param format not our own
[[nodiscard]] const Recipient& any_reader(GraphFormat format);

/// Returns the programs with a profile: g2o, gtsam, ceres, toro.
[[nodiscard]] std::span<const Recipient> profiles();
/// Returns null if no profile has this name.
[[nodiscard]] const Recipient* find_profile(std::string_view name);

}  // namespace waymark::formats

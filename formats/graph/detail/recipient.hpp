/// Who reads a graph file that is not our own, and what that reader understands: facts about other programs,
/// one table row each. What a graph means there, and what would be lost, is foreign_graph.hpp's to say.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <waymark/core/graph/vertex.hpp>
#include <waymark/formats/graph/graph_format.hpp>

namespace waymark::formats {

/// What becomes of FIX.
enum class Fixing {
  stated,     ///< the file says which vertices are fixed
  none,       ///< nothing is fixed; where the graph lies is the reader's affair
  lowest_id,  ///< the reader always fixes the vertex of the lowest id, and no other
};

struct Recipient {
  std::string_view name;                   ///< of the profile; of the format where any reader is meant
  std::string_view reader;                 ///< in sentences
  std::span<const GraphFormat> formats;    ///< that it reads; the first is what is written by default
  std::span<const std::string_view> tags;  ///< of vertices and edges, in our words
  Fixing fixing = Fixing::none;
  VertexId least_id = std::numeric_limits<VertexId>::min();
  VertexId most_id = std::numeric_limits<VertexId>::max();
  bool zero_information = true;       ///< an axis without information is read as that
  bool parallel_edges = true;         ///< a second edge between two vertices counts
  bool separate_parts = true;         ///< vertices that no edges join may be in one file
  bool applies_point_offset = true;   ///< the offset of EDGE_SE2_POINTXY_OFFSET enters its error
  bool evaluates_as_example = false;  ///< EDGE_SE2 means what Ceres' example makes of it: say_for_example()
};

/// The reader of any file of this format. @param format not our own
[[nodiscard]] const Recipient& any_reader(GraphFormat format);

/// The programs that there are profiles for: g2o, gtsam, ceres, toro.
[[nodiscard]] std::span<const Recipient> profiles();
/// Null where the name is none of them.
[[nodiscard]] const Recipient* find_profile(std::string_view name);

}  // namespace waymark::formats

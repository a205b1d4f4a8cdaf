/// The graph file formats by name. What each holds: formats/README.md.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <waymark/formats/graph/graph_document.hpp>

namespace waymark::formats {

enum class GraphFormat {
  graph,      ///< our own
  g2o,        ///< g2o's plane files
  toro,       ///< TORO's: VERTEX2, EDGE2 with information matrices
  covariance  ///< GTSAM's `.graph`: TORO's tags and order with covariance matrices
};

inline constexpr std::array<std::string_view, 4> kGraphFormats = {"graph", "g2o", "toro", "covariance"};

[[nodiscard]] inline std::string_view to_string(GraphFormat format) {
  return kGraphFormats[static_cast<std::size_t>(format)];
}
/// Nothing for a word that names no format.
[[nodiscard]] inline std::optional<GraphFormat> graph_format_from_string(std::string_view word) {
  for (std::size_t i = 0; i < kGraphFormats.size(); ++i) {
    if (word == kGraphFormats[i]) return static_cast<GraphFormat>(i);
  }
  return std::nullopt;
}

/// Reads a graph of a format that is said, not guessed: nothing in a file tells `toro` from `covariance`.
/// `graph` and `g2o` are one, told apart by the first line, as read_graph does. Files without vertices get
/// them along the registered start "odometry" in every format but our own.
/// @param name, lenient, report  as for read_graph
/// @throws InputError with line and column
[[nodiscard]] GraphDocument read_graph_as(GraphFormat format, std::string_view text, const std::string& name,
                                          const TypeRegistry& registry, bool lenient = false,
                                          ReadReport* report = nullptr);

}  // namespace waymark::formats

/// The names of the graph file formats. formats/README.md describes their content.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <waymark/formats/graph/graph_document.hpp>

namespace waymark::formats {

enum class GraphFormat {
  graph,      ///< our own
  g2o,        ///< g2o's plane files
  toro,       ///< TORO's files: VERTEX2, and EDGE2 with information matrices
  covariance  ///< GTSAM's `.graph` files: TORO's tags and order, with covariance matrices
};

inline constexpr std::array<std::string_view, 4> kGraphFormats = {"graph", "g2o", "toro", "covariance"};

[[nodiscard]] inline std::string_view to_string(GraphFormat format) {
  return kGraphFormats[static_cast<std::size_t>(format)];
}
/// Returns nothing if the word names no format.
[[nodiscard]] inline std::optional<GraphFormat> graph_format_from_string(std::string_view word) {
  for (std::size_t i = 0; i < kGraphFormats.size(); ++i) {
    if (word == kGraphFormats[i]) return static_cast<GraphFormat>(i);
  }
  return std::nullopt;
}

/// Reads a graph of a given format. The format is not guessed, because nothing in a file
/// distinguishes `toro` from `covariance`. `graph` and `g2o` mean the same here: the first line
/// distinguishes them, as in read_graph. In every format but our own the registered start
/// "odometry" makes vertices if the file has none.
/// @param name, lenient, report as for read_graph
/// @throws InputError with line and column
[[nodiscard]] GraphDocument read_graph_as(GraphFormat format, std::string_view text, const std::string& name,
                                          const TypeRegistry& registry, bool lenient = false,
                                          ReadReport* report = nullptr);

/// Writes a graph in a format that is not our own, for any reader of it. Rewritten edges keep chi2.
/// Records without a place in the format (frame, stamps) are left out.
/// @param name of the graph, for messages
/// @throws InputError for a vertex, edge or loss that the format cannot hold; UsageError for
/// `graph`
void write_graph_as(GraphFormat format, const GraphDocument& document, const std::string& name,
                    const TextSink& sink);

}  // namespace waymark::formats

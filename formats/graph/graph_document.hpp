/// A graph file in memory: the graph and the records that belong to it. formats/README.md specifies
/// the text format.
///
/// A document owns all its data; copies share nothing. After reading and writing, no reference to
/// text, registry or document is kept. Several threads may read and write different documents.
/// Precondition of writing: vertices in `covariances` are indices of `graph`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/text/text_sink.hpp>

namespace waymark::formats {

/// The covariance of one vertex in the chart of its retraction (for VERTEX_SE2: x, y in frame
/// axes, heading).
struct VertexCovariance {
  VertexIndex vertex = -1;
  Eigen::MatrixXd covariance;
};

/// Vertices by their ids, from the first to the last.
struct VertexRange {
  VertexId first{0};
  VertexId last{0};

  friend bool operator==(const VertexRange&, const VertexRange&) = default;
};

/// Edges of one type, by their number among the edges of this type in the graph.
struct EdgeShare {
  std::string tag;
  std::size_t first = 0;
  std::size_t last = 0;

  friend bool operator==(const EdgeShare&, const EdgeShare&) = default;
};

/// A source of a drive that has several: a receiver, an odometry, another sensor.
struct DocumentSource {
  std::string name;
  std::string kind;                   ///< "gnss", "odometry", or the name of a sensor model
  Eigen::Vector2d antenna_m{0, 0};    ///< of a receiver, body frame
  std::vector<VertexRange> vertices;  ///< that it has added: its states
  std::vector<EdgeShare> edges{};     ///< that it has added
};

struct GraphDocument {
  Graph graph;
  std::optional<Frame> frame;
  TimeScale time_scale = TimeScale::gps;  ///< of all stamps
  /// key and text, in the order of writing
  std::vector<std::pair<std::string, std::string>> provenance;
  Eigen::Vector2d antenna_m{0, 0};          ///< of the only receiver, body frame; see `sources`
  Eigen::Vector2d truth_reference_m{0, 0};  ///< reference point of the truth, in the body frame
  /// every fix of the drive, with the verdict of the gate
  std::vector<Fix> fixes;
  std::vector<VertexCovariance> covariances;  ///< for the vertices that were asked for
  /// Sources if there are several; the n-th "gnss" is Fix::source n. Empty: one odometry, one receiver.
  std::vector<DocumentSource> sources{};
};

/// Returns the sources of kind "gnss": Fix::source is the index.
[[nodiscard]] std::vector<DocumentSource> receivers_of(const GraphDocument& document);

/// Tells whether a vertex is among those of a source. Sources that share their errors have vertices in
/// common.
[[nodiscard]] bool has_vertex(const DocumentSource& source, VertexId vertex);

/// Returns the name of the first source that a vertex belongs to; empty if it belongs to none.
[[nodiscard]] std::string source_of(VertexId vertex, const GraphDocument& document);

/// Gives every fix the antenna of its receiver.
void place_antennas(GraphDocument& document);

/// Lines that a lenient reading skipped.
struct ReadReport {
  std::size_t skipped = 0;
  std::vector<std::string> examples;  ///< the first ten messages
  bool edges_only = false;            ///< the file had no vertices; the start "odometry" made them
  /// how many of these are not joined to the first; each part of them starts at the origin
  std::size_t apart = 0;
};

/// Returns the schema of an edge type as the TYPE line states it: "vertices=A,B fields=measured:3
/// information=3 error=log".
[[nodiscard]] std::string describe_schema(const EdgeType& type);

/// Reads a .graph text (first line `GRAPH 1`) or a plain g2o SE(2) file (any other first line).
/// graph_format.hpp has the other formats. If a plain g2o file has no
/// vertices, the registered start "odometry" makes them.
/// @param name name of the file, for messages
/// @param lenient skip and count wrong lines; otherwise the first one is an error
/// @throws InputError "run.graph:812:17: EDGE_SE2: expected a number for
/// 'information[2]', got 'abc'"
[[nodiscard]] GraphDocument read_graph(std::string_view text, const std::string& name,
                                       const TypeRegistry& registry, bool lenient = false,
                                       ReadReport* report = nullptr);

/// Writes a .graph text, piece by piece or as a whole. Reading it gives the same document,
/// number by number.
/// @throws UsageError before the first piece if the registry does not have an edge type of the
/// graph, because the schema of the type would be lost
void write_graph(const GraphDocument& document, const TypeRegistry& registry, const TextSink& sink);
[[nodiscard]] std::string write_graph(const GraphDocument& document, const TypeRegistry& registry);

}  // namespace waymark::formats

/// A graph file in memory: the graph and what belongs to it. Specification of the text format:
/// formats/README.md.
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

/// The covariance of one vertex in the chart of its retraction (for VERTEX_SE2: x, y in frame axes, heading).
struct VertexCovariance {
  VertexIndex vertex = -1;
  Eigen::MatrixXd covariance;
};

struct GraphDocument {
  Graph graph;
  std::optional<Frame> frame;
  TimeScale time_scale = TimeScale::gps;                        ///< of all stamps
  std::vector<std::pair<std::string, std::string>> provenance;  ///< key, text; in order of writing
  Eigen::Vector2d antenna_m{0, 0};                              ///< GNSS antenna in the body frame
  Eigen::Vector2d truth_reference_m{0, 0};                      ///< truth's reference point in the body frame
  std::vector<Fix> fixes;                     ///< every fix of the drive with the gate's verdict
  std::vector<VertexCovariance> covariances;  ///< those asked for
};

/// Lines that a lenient reading left out.
struct ReadReport {
  std::size_t skipped = 0;
  std::vector<std::string> examples;  ///< messages of the first ten
  bool edges_only = false;            ///< the file had no vertices; they were made along the odometry chain
  std::size_t apart = 0;  ///< those of them not joined to the first: each part of them starts at the origin
};

/// The schema of an edge type as the TYPE line states it: "vertices=A,B fields=measured:3 information=3
/// error=log".
[[nodiscard]] std::string describe_schema(const EdgeType& type);

/// Reads a .graph text (first line `GRAPH 1`) or a plain g2o SE(2) file (any other first line). Other
/// formats: graph_format.hpp, foreign_graph.hpp. A plain g2o file without vertices gets them along the
/// registered start "odometry".
/// @param name      for messages
/// @param lenient   skip wrong lines and count them instead of failing at the first
/// @throws InputError "run.graph:812:17: EDGE_SE2: expected a number for 'information[2]', got 'abc'"
[[nodiscard]] GraphDocument read_graph(std::string_view text, const std::string& name,
                                       const TypeRegistry& registry, bool lenient = false,
                                       ReadReport* report = nullptr);

/// Writes a .graph text, piece by piece or as a whole. Reading it back gives the same document, number by
/// number.
/// @throws UsageError before the first piece for an edge type that the registry does not have (its schema
/// would be lost).
void write_graph(const GraphDocument& document, const TypeRegistry& registry, const TextSink& sink);
[[nodiscard]] std::string write_graph(const GraphDocument& document, const TypeRegistry& registry);

}  // namespace waymark::formats

/// A graph as another program's file says it: the same minimum in other words, or not at all.
#pragma once

#include <string>
#include <vector>

#include <waymark/formats/graph/detail/foreign_edge.hpp>
#include <waymark/formats/graph/detail/recipient.hpp>
#include <waymark/formats/graph/detail/sensor_offsets.hpp>
#include <waymark/formats/graph/graph_document.hpp>

namespace waymark::formats {

/// Equal re-expressions, each with the same chi2 at all values of the vertices:
/// - EDGE_GNSS_POSITION becomes EDGE_SE2 without heading information, with a lever arm EDGE_SE2_OFFSET;
/// - EDGE_SE2_POINTXY_OFFSET becomes EDGE_SE2_XY for g2o itself, which leaves the offset out of the error;
/// - the information of EDGE_SE2 is turned for Ceres' example, whose error is in the first pose's axes;
/// - ids out of the recipient's range become free ones.
/// FIX is left out for a recipient without it where it says no more than where the graph lies: every edge is
/// relative, and no two fixed vertices are joined. All else that would move the minimum is refused; what is
/// only a record is left out and counted.
class ForeignGraph {
 public:
  /// @param document must live as long as this
  /// @param name     of the graph, for messages
  /// @throws InputError "a.graph: EDGE_SE2_LOG 3 7 (number 12): TORO has no such edge; ..." for what the
  /// recipient cannot hold; UsageError where it does not read that format
  ForeignGraph(const GraphDocument& document, const std::string& name, const Recipient& recipient,
               GraphFormat format);

  void write(const TextSink& sink) const;

  /// What is said otherwise than in the document, in sentences.
  [[nodiscard]] const std::vector<std::string>& changes() const { return changes_; }
  /// The records left out, counted: "frame, stamps (989)"; empty where there are none.
  [[nodiscard]] std::string left_out() const;

 private:
  void choose_ids();
  void check_vertices() const;
  void check_fixing();
  void check_edges();
  void check_parallel_edges() const;
  void check_parts() const;
  [[nodiscard]] bool needs_look(const std::string& tag) const;
  [[nodiscard]] bool takes(std::string_view tag) const;
  void express(std::size_t batch, std::size_t edge, ForeignEdge& out) const;
  [[nodiscard]] std::string place(std::size_t batch, std::size_t edge) const;
  [[noreturn]] void refuse(const std::string& place, const std::string& why, const char* remedy) const;
  void write_edge(const ForeignEdge& edge, TextBuilder& out) const;

  const GraphDocument& document_;
  const Graph& graph_;
  std::string name_;
  const Recipient& recipient_;
  GraphFormat format_;
  std::vector<VertexId> ids_;  // per vertex
  SensorOffsets offsets_;
  std::vector<std::string> changes_;
};

}  // namespace waymark::formats

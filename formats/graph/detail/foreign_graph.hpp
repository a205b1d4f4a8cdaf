/// A graph in the form that another program reads. It has the same minimum there, or it is refused.
#pragma once

#include <string>
#include <vector>

#include <waymark/formats/graph/detail/foreign_edge.hpp>
#include <waymark/formats/graph/detail/recipient.hpp>
#include <waymark/formats/graph/detail/sensor_offsets.hpp>
#include <waymark/formats/graph/graph_document.hpp>

namespace waymark::formats {

/// Expresses a graph for a recipient. Each rewriting keeps chi2 at all values of the vertices:
/// - EDGE_GNSS_POSITION becomes EDGE_SE2 without heading information, or EDGE_SE2_OFFSET if there
///   is a lever arm;
/// - EDGE_SE2_POINTXY_OFFSET becomes EDGE_SE2_XY for g2o itself, because g2o leaves the offset out
///   of the error;
/// - the information of EDGE_SE2 is turned for the example of Ceres, because its error is in the
///   axes of the first pose;
/// - ids outside the range of the recipient become free ones.
///
/// If the recipient has no FIX, it is left out as long as it only chooses the frame. This is so if
/// every edge is relative and no edge joins two fixed vertices. Everything else that would move the
/// minimum is refused. Pure records are left out and counted.
class ForeignGraph {
 public:
  /// @param document must outlive this object
  /// @param name name of the graph, for messages
  /// @throws InputError "a.graph: EDGE_SE2_LOG 3 7 (number 12): TORO has no such edge; ..." for
  /// content that the recipient cannot hold; UsageError if it does not read that format
  ForeignGraph(const GraphDocument& document, const std::string& name, const Recipient& recipient,
               GraphFormat format);

  void write(const TextSink& sink) const;

  /// Returns one sentence for each rewriting.
  [[nodiscard]] const std::vector<std::string>& changes() const { return changes_; }
  /// Counts the records that were left out: "frame, stamps (989)". Empty if there are none.
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

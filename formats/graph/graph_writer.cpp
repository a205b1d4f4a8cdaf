#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>

namespace waymark::formats {
namespace {

/// A line break in an outside text (the name of a drive) would begin a new statement.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

void write_header(const GraphDocument& document, TextBuilder& out) {
  out.line("GRAPH", 1);
  if (document.frame) {
    const Frame& frame = *document.frame;
    if (frame.zone == 0) {
      out.word("FRAME local origin");
    } else {
      out.word("FRAME utm").word(std::to_string(frame.zone) + (frame.north ? "N" : "S")).word("origin");
    }
    out.number(frame.origin_easting_m).number(frame.origin_northing_m).end_line();
  }
  out.word("TIME").word(to_string(document.time_scale)).end_line();
  for (const auto& [key, text] : document.provenance) {
    out.word("PROVENANCE").word(one_line(key));
    if (!text.empty()) out.word(one_line(text));
    out.end_line();
  }
  const auto write_lever = [&](const char* which, const Eigen::Vector2d& lever) {
    if (!lever.isZero(0)) out.word("LEVER").word(which).number(lever[0]).number(lever[1]).end_line();
  };
  write_lever("antenna", document.antenna_m);
  write_lever("truth", document.truth_reference_m);
  for (const DocumentSource& source : document.sources)
    out.word("SOURCE")
        .word(source.name)
        .word(source.kind)
        .number(source.antenna_m[0])
        .number(source.antenna_m[1])
        .end_line();
  for (const DocumentSource& source : document.sources)
    for (const VertexRange& range : source.vertices)
      out.word("STATES")
          .word(source.name)
          .integer(to_number(range.first))
          .integer(to_number(range.last))
          .end_line();
  for (const DocumentSource& source : document.sources)
    for (const EdgeShare& share : source.edges)
      out.word("EDGES")
          .word(source.name)
          .word(share.tag)
          .integer(static_cast<std::int64_t>(share.first))
          .integer(static_cast<std::int64_t>(share.last))
          .end_line();
}

void write_vertices(const Graph& graph, TextBuilder& out) {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    out.word(graph.vertex_type(v).tag).integer(to_number(graph.id(v)));
    for (const double value : graph.value(v)) out.number(value);
    out.end_line();
    if (const auto stamp = graph.stamp(v)) {
      out.word("STAMP").integer(to_number(graph.id(v))).integer(stamp->nanoseconds).end_line();
    }
  }
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.fixed(v)) out.word("FIX").integer(to_number(graph.id(v))).end_line();
  }
}

void write_upper_triangle(const Eigen::MatrixXd& matrix, TextBuilder& out) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = row; column < matrix.cols(); ++column) out.number(matrix(row, column));
  }
}

void write_edges(const Graph& graph, const EdgeType& type, const EdgeBatchBase& batch, TextBuilder& out) {
  std::vector<double> fields;
  for (std::size_t e = 0; e < batch.size(); ++e) {
    out.word(type.tag);
    const auto vertices = batch.vertices(e);
    if (type.arity == EdgeType::kRuntimeArity) out.integer(static_cast<std::int64_t>(vertices.size()));
    for (const VertexIndex v : vertices) out.integer(to_number(graph.id(v)));
    fields.clear();
    batch.fields(e, fields);
    for (const double value : fields) out.number(value);
    write_upper_triangle(batch.information(e), out);
    out.end_line();
    if (const Loss* loss = batch.loss(e)) out.word("LOSS").word(loss->name).number(loss->scale).end_line();
  }
}

void write_fix(const Fix& fix, TextBuilder& out) {
  const auto optional = [&](const std::optional<double>& value) {
    value ? out.number(*value) : out.word("-");
  };
  const auto or_dash = [&](double value) { std::isfinite(value) ? out.number(value) : out.word("-"); };
  out.word("GNSS").integer(to_number(fix.vertex)).integer(fix.stamp.nanoseconds);
  out.number(fix.position[0]).number(fix.position[1]);
  out.number(fix.covariance(0, 0)).number(fix.covariance(0, 1)).number(fix.covariance(1, 1));
  or_dash(fix.height_m);
  optional(fix.heading_rad);
  optional(fix.heading_sigma_rad);
  optional(fix.speed_mps);
  optional(fix.speed_sigma_mps);
  out.number(fix.grid_scale).integer(fix.epoch).integer(fix.source);
  out.word(to_string(fix.status)).word(fix.reason);
  or_dash(fix.chord_angle_rad);
  or_dash(fix.displacement_m);
  if (fix.told.quality != FixQuality::unknown) out.word(to_string(fix.told.quality));
  if (!fix.smoothed_m.isZero(0)) out.word("smoothed").number(fix.smoothed_m[0]).number(fix.smoothed_m[1]);
  out.end_line();
}

}  // namespace

void write_graph(const GraphDocument& document, const TypeRegistry& registry, const TextSink& sink) {
  const Graph& graph = document.graph;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const std::string& tag = graph.edge_type(b).tag;
    if (graph.batch(b).size() > 0 && registry.find_edge(tag) == nullptr) {
      throw UsageError("cannot write edges of type " + tag + ": it is not registered");
    }
  }
  TextBuilder out(sink);
  write_header(document, out);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.batch(b).size() == 0) continue;
    const EdgeType& type = graph.edge_type(b);
    out.word("TYPE").word(type.tag).word(describe_schema(type)).end_line();
  }
  write_vertices(graph, out);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    write_edges(graph, graph.edge_type(b), graph.batch(b), out);
  }
  for (const Fix& fix : document.fixes) write_fix(fix, out);
  for (const VertexCovariance& block : document.covariances) {
    out.word("COVARIANCE").integer(to_number(graph.id(block.vertex)));
    write_upper_triangle(block.covariance, out);
    out.end_line();
  }
  out.finish();
}

std::string write_graph(const GraphDocument& document, const TypeRegistry& registry) {
  return collect_text([&](const TextSink& sink) { write_graph(document, registry, sink); });
}

}  // namespace waymark::formats

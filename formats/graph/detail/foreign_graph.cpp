#include <waymark/formats/graph/detail/foreign_graph.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/formats/graph/detail/toro.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kPointSeenBySensor = "EDGE_SE2_POINTXY_OFFSET";
constexpr std::string_view kGnssPosition = "EDGE_GNSS_POSITION";
constexpr const char* kHoldsAll = "write --format graph, which holds everything";
constexpr const char* kFixRemedy = "free the vertex, or write --profile g2o";

std::size_t at(VertexIndex v) {
  return static_cast<std::size_t>(v);
}

/// Sets of vertices joined by edges; the name of a set is one of its vertices.
class Parts {
 public:
  explicit Parts(const Graph& graph) : parent_(graph.vertex_count()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t b = 0; b < graph.batch_count(); ++b) {
      for_each_edge(graph.batch(b), [&](const auto& vertices) {
        for (const VertexIndex v : vertices) parent_[at(of(v))] = of(vertices[0]);
      });
    }
  }
  [[nodiscard]] VertexIndex of(VertexIndex v) {
    while (parent_[at(v)] != v) v = parent_[at(v)] = parent_[at(parent_[at(v)])];
    return v;
  }

 private:
  std::vector<VertexIndex> parent_;
};

}  // namespace

ForeignGraph::ForeignGraph(const GraphDocument& document, const std::string& name, const Recipient& recipient,
                           GraphFormat format)
    : document_(document), graph_(document.graph), name_(name), recipient_(recipient), format_(format) {
  if (std::find(recipient.formats.begin(), recipient.formats.end(), format) == recipient.formats.end()) {
    throw UsageError(std::string(recipient.reader) + " does not read the format " +
                     std::string(to_string(format)));
  }
  check_vertices();
  choose_ids();
  check_edges();
  check_fixing();
  if (!recipient_.parallel_edges) check_parallel_edges();
  if (!recipient_.separate_parts) check_parts();
}

bool ForeignGraph::takes(std::string_view tag) const {
  return std::find(recipient_.tags.begin(), recipient_.tags.end(), tag) != recipient_.tags.end();
}

void ForeignGraph::refuse(const std::string& place, const std::string& why, const char* remedy) const {
  throw InputError(name_ + ": " + place + ": " + std::string(recipient_.reader) + " " + why + "; " + remedy);
}

std::string ForeignGraph::place(std::size_t batch, std::size_t edge) const {
  std::string text = graph_.edge_type(batch).tag;
  for (const VertexIndex v : graph_.batch(batch).vertices(edge)) {
    text += " ";
    text += to_string(graph_.id(v));
  }
  return text + " (number " + std::to_string(edge + 1) + ")";
}

void ForeignGraph::check_vertices() const {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    const std::string& tag = graph_.vertex_type(v).tag;
    if (!takes(tag)) refuse(tag + " " + to_string(graph_.id(v)), "has no such vertex", kHoldsAll);
  }
}

// Ids in range are kept. The others become the lowest free ids.
void ForeignGraph::choose_ids() {
  ids_.resize(graph_.vertex_count());
  std::int64_t next = std::max<std::int64_t>(to_number(recipient_.least_id), 0);
  std::size_t changed = 0;
  std::string first;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(ids_.size()); ++v) {
    const VertexId id = graph_.id(v);
    ids_[at(v)] = id;
    if (id >= recipient_.least_id && id <= recipient_.most_id) continue;
    while (graph_.find(VertexId{next})) ++next;
    if (changed++ == 0) first = "vertex " + to_string(id) + " is " + std::to_string(next) + " there";
    ids_[at(v)] = VertexId{next++};
  }
  if (changed == 0) return;
  if (changed > 1) first += ", and " + std::to_string(changed - 1) + " more";
  changes_.push_back(first + ": " + std::string(recipient_.reader) + " does not take such ids");
}

void ForeignGraph::check_edges() {
  ForeignEdge said;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph_.batch(b);
    const std::string& tag = graph_.edge_type(b).tag;
    if (batch.size() > 0 && !takes(tag) && tag != kGnssPosition)
      refuse(place(b, 0), "has no such edge", kHoldsAll);
    const bool look = needs_look(tag);
    std::size_t turned = 0;
    for (std::size_t e = 0; e < batch.size(); ++e) {
      if (batch.loss(e) != nullptr) refuse(place(b, e), "has no robust losses", kHoldsAll);
      if (!look) continue;
      express(b, e, said);
      if (has_offsets(said.tag)) offsets_.collect(said.tag, said.fields);
      if (recipient_.evaluates_as_example) {
        const Eigen::MatrixXd before = batch.information(e).topLeftCorner<2, 2>();
        const double change = (said.information.topLeftCorner<2, 2>() - before).cwiseAbs().maxCoeff();
        turned += change > 1e-9 * before.cwiseAbs().maxCoeff() ? 1 : 0;
      }
    }
    if (turned > 0) {
      changes_.push_back("the information of " + std::to_string(turned) + " " + tag +
                         " is turned by the measured heading, as the error of " +
                         std::string(recipient_.reader) +
                         " is in the axes of the first pose; the file is for that reader only");
    }
  }
}

/// Tells whether edges of this type are rewritten, or must be checked one by one.
bool ForeignGraph::needs_look(const std::string& tag) const {
  return tag == kGnssPosition || has_offsets(tag) || format_ == GraphFormat::covariance ||
         !recipient_.zero_information || recipient_.evaluates_as_example;
}

void ForeignGraph::express(std::size_t batch, std::size_t edge, ForeignEdge& out) const {
  const EdgeBatchBase& edges = graph_.batch(batch);
  const std::string& tag = graph_.edge_type(batch).tag;
  const auto vertices = edges.vertices(edge);
  out.tag = tag;
  out.vertices.assign(vertices.begin(), vertices.end());
  out.fields.clear();
  edges.fields(edge, out.fields);
  out.information = edges.information(edge);
  if (tag == kGnssPosition) say_position_as_pose(out);
  if (tag == kPointSeenBySensor && !recipient_.applies_point_offset) say_sensor_as_body(out);
  if (tag == kGnssPosition && !takes(out.tag))
    refuse(place(batch, edge), "has no antenna lever arms", kHoldsAll);
  if (recipient_.evaluates_as_example) {
    if (const auto refusal = say_for_example(out)) refuse(place(batch, edge), refusal->why, refusal->remedy);
  }
  const bool zero = !(out.information.diagonal().minCoeff() > 0);
  if (zero && !recipient_.zero_information) {
    refuse(place(batch, edge), "discards a matrix with a zero on its diagonal (an axis without information)",
           "write --profile g2o");
  }
  if (format_ == GraphFormat::covariance) {
    const std::optional<Eigen::MatrixXd> covariance = inverse_of_positive_definite(out.information);
    if (!covariance) {
      refuse(place(batch, edge), "cannot hold an edge without information on some axis: it has no covariance",
             "write --format g2o or toro");
    }
    out.information = *covariance;
  }
}

void ForeignGraph::check_fixing() {
  if (recipient_.fixing == Fixing::stated) return;
  bool all_relative = true;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    all_relative = all_relative && (graph_.batch(b).size() == 0 || graph_.edge_type(b).relative);
  }
  Parts parts(graph_);
  std::map<VertexIndex, VertexIndex> fixed_in;
  const auto lowest = std::min_element(ids_.begin(), ids_.end()) - ids_.begin();
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    if (!graph_.fixed(v)) continue;
    const std::string fix = "FIX " + to_string(graph_.id(v));
    const auto [other, first] = fixed_in.emplace(parts.of(v), v);
    if (!first || !all_relative) {
      refuse(fix,
             "has no FIX" + (first ? std::string(", and the edges alone do not determine the place")
                                   : ", and vertex " + to_string(graph_.id(other->second)) +
                                         ", fixed too, is joined to this one"),
             kFixRemedy);
    }
    if (recipient_.fixing == Fixing::lowest_id && v == lowest) continue;  // as the reader does
    changes_.push_back(fix + " is left out: " + std::string(recipient_.reader) +
                       " has none; chi2 and shape of the minimum stay the same, its place may differ");
  }
}

void ForeignGraph::check_parallel_edges() const {
  std::map<std::pair<VertexIndex, VertexIndex>, std::string> seen;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    for (std::size_t e = 0; e < graph_.batch(b).size(); ++e) {
      const auto vertices = graph_.batch(b).vertices(e);
      const auto [other, first] = seen.emplace(std::pair(vertices[0], vertices[1]), "");
      if (first) {
        other->second = place(b, e);
        continue;
      }
      refuse(place(b, e), "drops the second edge between two vertices, and " + other->second + " comes first",
             "write --format toro for readers that keep both");
    }
  }
}

void ForeignGraph::check_parts() const {
  Parts parts(graph_);
  for (VertexIndex v = 1; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    if (parts.of(v) == parts.of(0)) continue;
    refuse("vertex " + to_string(graph_.id(v)),
           "takes one connected graph, and no edges join this vertex to " + to_string(graph_.id(0)),
           "write each part into a file of its own");
  }
}

std::string ForeignGraph::left_out() const {
  std::size_t stamps = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    stamps += graph_.stamp(v) ? 1 : 0;
  }
  std::string text;
  const auto count = [&](std::size_t n, const char* what) {
    if (n > 0) text += (text.empty() ? "" : ", ") + std::string(what) + " (" + std::to_string(n) + ")";
  };
  if (document_.frame) text = "frame";
  count(stamps, "stamps");
  count(document_.fixes.size(), "GNSS records");
  count(document_.covariances.size(), "covariances");
  count(document_.provenance.size(), "provenance lines");
  return text;
}

void ForeignGraph::write_edge(const ForeignEdge& edge, TextBuilder& out) const {
  const bool g2o = format_ == GraphFormat::g2o;
  out.word(g2o ? edge.tag : std::string_view("EDGE2"));
  for (const VertexIndex v : edge.vertices) out.integer(to_number(ids_[at(v)]));
  if (has_offsets(edge.tag)) {
    offsets_.write_fields(edge.tag, edge.fields, out);
  } else {
    for (const double value : edge.fields) out.number(value);
  }
  if (!g2o) {
    write_toro_matrix(edge.information, out);
  } else {
    for (Eigen::Index row = 0; row < edge.information.rows(); ++row) {
      for (Eigen::Index column = row; column < edge.information.cols(); ++column) {
        out.number(edge.information(row, column));
      }
    }
  }
  out.end_line();
}

void ForeignGraph::write(const TextSink& sink) const {
  TextBuilder out(sink);
  offsets_.write(out);
  const bool g2o = format_ == GraphFormat::g2o;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    out.word(g2o ? std::string_view(graph_.vertex_type(v).tag) : "VERTEX2").integer(to_number(ids_[at(v)]));
    for (const double value : graph_.value(v)) out.number(value);
    out.end_line();
  }
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v) {
    if (graph_.fixed(v) && recipient_.fixing == Fixing::stated) out.line("FIX", to_number(ids_[at(v)]));
  }
  ForeignEdge said;
  for (std::size_t b = 0; b < graph_.batch_count(); ++b) {
    for (std::size_t e = 0; e < graph_.batch(b).size(); ++e) {
      express(b, e, said);
      write_edge(said, out);
    }
  }
  out.finish();
}

void write_graph_as(GraphFormat format, const GraphDocument& document, const std::string& name,
                    const TextSink& sink) {
  if (format == GraphFormat::graph) throw UsageError("write_graph_as: write_graph() writes our own format");
  ForeignGraph(document, name, any_reader(format), format).write(sink);
}

}  // namespace waymark::formats

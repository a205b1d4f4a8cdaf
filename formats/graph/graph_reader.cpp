#include <algorithm>
#include <iterator>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/registry/detail/graph_statements.hpp>
#include <waymark/core/system/foreign_poses.hpp>
#include <waymark/formats/graph/detail/graph_records.hpp>
#include <waymark/formats/graph/detail/own_statements.hpp>
#include <waymark/formats/graph/detail/own_tags.hpp>
#include <waymark/formats/graph/detail/sensor_offsets.hpp>
#include <waymark/formats/graph/detail/toro.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/detail/byte_order_mark.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/detail/utf16.hpp>

namespace waymark::formats {
namespace {

using waymark::detail::kGraphStatements;

constexpr std::size_t kExamples = 10;
// so many are remembered; further ones are looked up each time
constexpr std::size_t kMostTags = 64;
constexpr std::int64_t kMaxArity = 1000;  // of a run-time-arity edge: 72 MB of information matrix

template <std::size_t N>
bool is_one_of(std::string_view tag, const std::string_view (&tags)[N]) {
  return std::find(std::begin(tags), std::end(tags), tag) != std::end(tags);
}

std::string join(std::string_view tag, std::string_view message) {
  return std::string(tag) + ": " + std::string(message);
}

class GraphReader {
 public:
  GraphReader(GraphFormat format, std::string_view text, const std::string& name,
              const TypeRegistry& registry, bool lenient, ReadReport& report)
      : format_(format), text_(text), name_(name), registry_(registry), lenient_(lenient), report_(report) {}

  GraphDocument read() {
    read_first_line();
    // Vertices are read first, so that edges, FIX and STAMP may be anywhere.
    std::optional<Place> first_statement;
    for_each_line({}, [&](LineScanner& line, std::string_view word) {
      Tag& tag = known_tag(word);
      ++tag.lines;
      if (tag.vertex != nullptr) return read_vertex(line, tag);
      if (tag.offset) return offsets_.read(line);
      if (!first_statement) first_statement = place_;
    });
    if (document_.graph.vertex_count() == 0 && !is_waymark_) make_vertices_of_edges();
    if (first_statement) {
      for_each_line(*first_statement, [this](LineScanner& line, std::string_view word) {
        const Tag& tag = known_tag(word);
        if (tag.vertex == nullptr && !tag.offset) read_statement(line, tag);
      });
    }
    if (report_.edges_only) place_along_odometry();
    if (document_.graph.vertex_count() == 0) throw InputError(name_ + ": no vertices in it");
    if (report_.skipped > 0) {
      for (DocumentSource& source : document_.sources) source.edges.clear();  // their numbers hold no longer
    }
    check_edge_shares();
    place_antennas(document_);
    return std::move(document_);
  }

 private:
  /// The place where a line begins.
  struct Place {
    std::size_t offset = 0;
    std::size_t line_number = 1;
  };
  /// The first word of a line, and its entry in the registry.
  struct Tag {
    std::string_view word;
    const VertexType* vertex = nullptr;
    const EdgeType* edge = nullptr;
    bool offset = false;    // g2o's parameter lines
    std::size_t lines = 0;  // counted by the first pass
  };

  [[nodiscard]] bool is_toro() const {
    return format_ == GraphFormat::toro || format_ == GraphFormat::covariance;
  }

  void check_edge_shares() const {
    const Graph& graph = document_.graph;
    for (const DocumentSource& source : document_.sources) {
      for (const EdgeShare& share : source.edges) {
        std::size_t count = 0;
        for (std::size_t b = 0; b < graph.batch_count(); ++b)
          if (graph.edge_type(b).tag == share.tag) count = graph.batch(b).size();
        if (share.last >= count)
          throw InputError(name_ + ": EDGES " + source.name + " " + share.tag + ": edge " +
                           std::to_string(share.last) + " does not exist; the file has " +
                           std::to_string(count) + " of this type, counted from 0");
      }
    }
  }

  void place_along_odometry() {
    InitialValues start = registry_.make_start("odometry", document_.graph);
    report_.apart = start.apart;
    if (start.values.empty() && find_joined_foreign_pose(document_.graph) >= 0)
      throw InputError(name_ +
                       ": the file has edges only, and no start can place their vertices (odometry: " +
                       start.note + "); add the vertices");
    if (!start.values.empty()) document_.graph.set_values(std::move(start.values));
  }

  void read_first_line() {
    if (is_utf16(text_))
      throw InputError(name_ +
                       ": is UTF-16 text, and graphs are UTF-8; convert it (iconv -f UTF-16 -t UTF-8)");
    text_ = without_byte_order_mark(text_);
    const std::string_view first = text_.substr(0, text_.find('\n'));
    LineScanner line(first, name_, 1);
    if (line.word() != "GRAPH" || is_toro()) return;
    is_waymark_ = true;
    const std::int64_t version = line.integer({"GRAPH", "version"});
    if (version != 1) {
      line.fail("GRAPH: version " + std::to_string(version) +
                " is not known to this program, which reads version 1");
    }
    line.end("GRAPH");
  }

  template <typename Visit>
  void for_each_line(Place first, Visit visit) {
    for (Place next = first; next.offset < text_.size(); ++next.line_number) {
      place_ = next;
      const std::size_t end = std::min(text_.find('\n', place_.offset), text_.size());
      next.offset = end + 1;
      LineScanner line(text_.substr(place_.offset, end - place_.offset), name_, place_.line_number);
      const std::string_view word = line.word();
      if (word.empty() || word.front() == '#' || (place_.line_number == 1 && is_waymark_)) continue;
      try {
        visit(line, word);
      } catch (const InputError& error) {
        if (!lenient_) throw;
        ++report_.skipped;
        if (report_.examples.size() < kExamples) report_.examples.emplace_back(error.what());
      }
    }
  }

  // Adjacent lines usually have the same tag, and a file has few tags. So the last one found is
  // tried first.
  Tag& known_tag(std::string_view word) {
    if (last_tag_ < tags_.size() && tags_[last_tag_].word == word) return tags_[last_tag_];
    for (last_tag_ = 0; last_tag_ < tags_.size(); ++last_tag_) {
      if (tags_[last_tag_].word == word) return tags_[last_tag_];
    }
    if (tags_.size() == kMostTags) tags_.pop_back();
    last_tag_ = tags_.size();
    const std::string_view own = is_toro() ? own_tag_of_toro(word, format_) : word;
    const bool offset = !is_waymark_ && own == kOffsetTag;
    return tags_.emplace_back(Tag{word, registry_.find_vertex(own), registry_.find_edge(own), offset});
  }

  void read_vertex(LineScanner& line, const Tag& tag) {
    const VertexType& type = *tag.vertex;
    const VertexId id{line.integer({tag.word, "id"})};
    if (document_.graph.find(id)) {
      line.fail(join(tag.word, "vertex " + to_string(id) + " is defined a second time"));
    }
    values_.clear();
    for (const std::string& name : type.value_names) values_.push_back(line.number({tag.word, name}));
    line.end(tag.word);
    document_.graph.add_vertex(type, id, values_);
  }

  void read_statement(LineScanner& line, const Tag& tag) {
    if (tag.edge == nullptr) return read_other(line, tag.word);
    read_edge(line, tag, *tag.edge);
  }

  void read_edge(LineScanner& line, const Tag& tag, const EdgeType& type) {
    // this edge is skipped, and a LOSS below it must not go to an earlier one
    last_batch_ = nullptr;
    const bool runtime = type.arity == EdgeType::kRuntimeArity;
    const std::int64_t arity = runtime ? line.integer({tag.word, "arity"}) : type.arity;
    if (runtime && (arity < 1 || arity > kMaxArity)) {
      line.fail(join(tag.word, "the arity must be 1 to " + std::to_string(kMaxArity)));
    }
    vertices_.clear();
    for (std::int64_t k = 0; k < arity; ++k)
      vertices_.push_back(read_vertex_id(line, document_.graph, tag.word));
    values_.clear();
    Eigen::Index dimension = type.error_dimension;
    if (runtime) {
      dimension = 0;
      Eigen::Index value_size = 0;
      for (const VertexIndex v : vertices_) {
        value_size += document_.graph.vertex_type(v).value_size;
        dimension += document_.graph.vertex_type(v).tangent_size;
      }
      read_numbers(line, tag.word, "reference", value_size);
      read_numbers(line, tag.word, "offset", dimension);
    }
    if (!is_waymark_ && has_offsets(type.tag)) {
      offsets_.read_fields(line, type, values_);
    } else {
      for (const FieldInfo& field : type.fields) read_numbers(line, tag.word, field.name, field.size);
    }
    information_.resize(dimension, dimension);
    if (is_toro()) {
      read_toro_matrix(line, tag.word, format_, information_);
    } else {
      read_upper_triangle(line, tag.word);
    }
    line.end(tag.word);
    check_matrix(line, tag.word);
    try {
      const EdgePlace added = document_.graph.add_edge(type, vertices_, values_, information_);
      last_batch_ = &document_.graph.batch(added.batch);
    } catch (const UsageError& error) {
      line.fail(error.what());
    }
    if (!runtime && last_batch_->size() == 1) last_batch_->reserve(std::min(tag.lines, most_lines(type)));
  }

  void read_upper_triangle(LineScanner& line, std::string_view tag) {
    int index = 0;
    for (Eigen::Index row = 0; row < information_.rows(); ++row) {
      for (Eigen::Index column = row; column < information_.cols(); ++column) {
        const double value = line.number({tag, "information", index++});
        information_(row, column) = information_(column, row) = value;
      }
    }
  }

  /// The matrix must be an information matrix; a covariance is inverted first.
  void check_matrix(const LineScanner& line, std::string_view tag) {
    if (format_ == GraphFormat::covariance) {
      const std::optional<Eigen::MatrixXd> inverse = inverse_of_positive_definite(information_);
      if (!inverse)
        line.fail(join(tag,
                       "the covariance matrix is not positive definite, or its inverse not finite; give the "
                       "variances of this edge, or read the file with --input-format toro if the numbers are "
                       "information"));
      information_ = *inverse;
    } else if (!is_positive_semidefinite(information_)) {
      line.fail(join(tag, kIndefinite));
    } else if (format_ == GraphFormat::toro && information_.isZero(0)) {
      // A .graph may hold an edge that measures nothing. TORO, which divides by the sum of these, cannot.
      line.fail(join(tag, "the information matrix is zero; remove the edge, or state what it measures"));
    }
  }

  /// Returns how many edges of a type the text has room for, whatever its tags promise.
  [[nodiscard]] std::size_t most_lines(const EdgeType& type) const {
    const int numbers =
        type.arity + type.field_size() + type.error_dimension * (type.error_dimension + 1) / 2;
    return text_.size() / static_cast<std::size_t>(2 * numbers);
  }

  void read_numbers(LineScanner& line, std::string_view tag, std::string_view field, Eigen::Index count) {
    for (int i = 0; i < count; ++i) values_.push_back(line.number({tag, field, count > 1 ? i : -1}));
  }

  void read_other(LineScanner& line, std::string_view tag) {
    if (tag == "FIX" && !is_toro()) {
      do {
        document_.graph.set_fixed(read_vertex_id(line, document_.graph, tag), true);
      } while (!line.at_end());
    } else if (!is_waymark_ || !statements_.read(line, tag, last_batch_)) {
      fail_unknown(line, tag);
    }
  }

  [[noreturn]] void fail_unknown(const LineScanner& line, std::string_view tag) {
    // the line may have been an edge: a LOSS below it belongs to no known edge
    last_batch_ = nullptr;
    if (is_toro()) {
      const bool is_other = registry_.find_vertex(tag) != nullptr || registry_.find_edge(tag) != nullptr ||
                            is_one_of(tag, kGraphStatements);
      line.fail("unknown tag " + quote_word(tag) + "; a file of --input-format " +
                std::string(to_string(format_)) + " has VERTEX2 and EDGE2" +
                (is_other ? ", and this tag is of .graph or g2o: leave --input-format out" : ""));
    }
    if (is_one_of(tag, kGraphStatements)) {
      line.fail(join(tag, is_waymark_ ? "is only allowed in the first line"
                                      : "is only allowed in files whose first line is 'GRAPH 1'"));
    }
    if (is_one_of(tag, kToroTags)) {
      line.fail("tag " + quote_word(tag) +
                " is of TORO or GTSAM, which differ in the order and meaning of the numbers; name "
                "the format: --input-format toro, or --input-format covariance for GTSAM");
    }
    if (tag == kOffsetTag)
      line.fail(join(tag, "a .graph file has the offsets in its edges; remove this line"));
    if (is_of_space(tag))
      line.fail(
          "tag " + quote_word(tag) +
          " is of a graph in space, and the types of Waymark are those of the plane, SE(2); if a plugin "
          "defines it, load it with --plugin");
    const std::string meant = did_you_mean(tag, tags_of_lines());
    line.fail("unknown tag " + quote_word(tag) +
              (meant.empty() ? "; if a plugin defines it, load it with --plugin"
                             : meant + " If a plugin defines it, load it with --plugin"));
  }

  /// Returns the words at the beginning of the lines that this file may have.
  [[nodiscard]] std::vector<std::string_view> tags_of_lines() const {
    std::vector<std::string_view> tags;
    for (const auto& vertex : registry_.vertices()) tags.emplace_back(vertex.type.tag);
    for (const auto& edge : registry_.edges()) tags.emplace_back(edge.type.tag);
    tags.emplace_back("FIX");
    tags.emplace_back("GRAPH");
    if (is_waymark_) tags.insert(tags.end(), std::begin(kGraphStatements), std::end(kGraphStatements));
    return tags;
  }

  // Makes the vertices of a file that has only edges (as SE-Sync writes them): all vertices that
  // edges name, in ascending order.
  void make_vertices_of_edges() {
    const ReadReport before = report_;
    std::vector<std::pair<VertexId, const VertexType*>> named;
    for_each_line({}, [&](LineScanner& line, std::string_view tag) {
      const EdgeType* type = known_tag(tag).edge;
      if (type == nullptr || type->arity == EdgeType::kRuntimeArity) return;
      for (const std::string& vertex_tag : type->vertex_tags) {
        named.emplace_back(VertexId{line.integer({tag, "vertex"})}, registry_.find_vertex(vertex_tag));
      }
    });
    std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [id, type] : named) {
      if (type == nullptr || document_.graph.find(id)) continue;
      values_.assign(static_cast<std::size_t>(type->value_size), 0.0);
      document_.graph.add_vertex(*type, id, values_);
    }
    report_.edges_only = document_.graph.vertex_count() > 0;
    // Wrong lines are reported once, in the pass that reads the edges.
    report_.skipped = before.skipped;
    report_.examples = before.examples;
  }

  GraphFormat format_;
  std::string_view text_;
  const std::string& name_;
  const TypeRegistry& registry_;
  bool lenient_;
  ReadReport& report_;
  GraphDocument document_;
  OwnStatements statements_{document_, registry_};
  SensorOffsets offsets_;
  bool is_waymark_ = false;
  Place place_;  // of the line being read
  std::vector<Tag> tags_;
  std::size_t last_tag_ = 0;
  EdgeBatchBase* last_batch_ = nullptr;
  std::vector<VertexIndex> vertices_;
  std::vector<double> values_;
  Eigen::MatrixXd information_;
};

}  // namespace

std::string describe_schema(const EdgeType& type) {
  std::string text = "vertices=";
  for (std::size_t k = 0; k < type.vertex_tags.size(); ++k) text += (k > 0 ? "," : "") + type.vertex_tags[k];
  if (type.vertex_tags.empty()) text += "*";
  text += " fields=";
  for (std::size_t k = 0; k < type.fields.size(); ++k) {
    text += (k > 0 ? "," : "") + type.fields[k].name + ":" + std::to_string(type.fields[k].size);
  }
  text +=
      " information=" + (type.error_dimension > 0 ? std::to_string(type.error_dimension) : std::string("*"));
  return text + " error=" + (type.form.empty() ? "-" : type.form);
}

GraphDocument read_graph(std::string_view text, const std::string& name, const TypeRegistry& registry,
                         bool lenient, ReadReport* report) {
  return read_graph_as(GraphFormat::graph, text, name, registry, lenient, report);
}

GraphDocument read_graph_as(GraphFormat format, std::string_view text, const std::string& name,
                            const TypeRegistry& registry, bool lenient, ReadReport* report) {
  ReadReport own;
  return GraphReader(format, text, name, registry, lenient, report != nullptr ? *report : own).read();
}

}  // namespace waymark::formats

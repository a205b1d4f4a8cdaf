#include <algorithm>

#include <waymark/core/error.hpp>
#include <waymark/formats/graph_document.hpp>
#include <waymark/formats/graph_records.hpp>
#include <waymark/formats/line_scanner.hpp>

namespace waymark {
namespace {

constexpr std::size_t kExamples = 10;
constexpr std::size_t kMostTags = 64;     // remembered; further ones are looked up each time
constexpr std::int64_t kMaxArity = 1000;  // of a run-time-arity edge: 72 MB of information matrix

constexpr std::string_view kOwnTags[] = {"GRAPH", "FRAME", "TIME", "PROVENANCE", "LEVER",
                                         "TYPE",  "STAMP", "LOSS", "GNSS",       "COVARIANCE"};
constexpr std::string_view kToroTags[] = {"VERTEX2", "EDGE2", "VERTEX", "EDGE"};

template <std::size_t N>
bool is_one_of(std::string_view tag, const std::string_view (&tags)[N]) {
  return std::find(std::begin(tags), std::end(tags), tag) != std::end(tags);
}

std::string join(std::string_view tag, std::string_view message) {
  return std::string(tag) + ": " + std::string(message);
}

class GraphReader {
 public:
  GraphReader(std::string_view text, const std::string& name, const TypeRegistry& registry, bool lenient,
              ReadReport& report)
      : text_(text), name_(name), registry_(registry), lenient_(lenient), report_(report) {}

  GraphDocument read() {
    read_first_line();
    // Vertices first, so that edges, FIX and STAMP may stand anywhere.
    std::optional<Place> first_statement;
    for_each_line({}, [&](LineScanner& line, std::string_view word) {
      Tag& tag = known_tag(word);
      ++tag.lines;
      if (tag.vertex != nullptr) return read_vertex(line, *tag.vertex);
      if (!first_statement) first_statement = place_;
    });
    if (document_.graph.vertex_count() == 0 && !is_waymark_) make_vertices_of_edges();
    if (first_statement) {
      for_each_line(*first_statement, [this](LineScanner& line, std::string_view word) {
        const Tag& tag = known_tag(word);
        if (tag.vertex == nullptr) read_statement(line, tag);
      });
    }
    if (report_.edges_only) place_along_odometry();
    if (document_.graph.vertex_count() == 0) throw InputError(name_ + ": no vertices in it");
    return std::move(document_);
  }

 private:
  /// Where a line begins.
  struct Place {
    std::size_t offset = 0;
    std::size_t line_number = 1;
  };
  /// A line's first word and what the registry knows by it.
  struct Tag {
    std::string_view word;
    const VertexType* vertex = nullptr;
    const EdgeType* edge = nullptr;
    std::size_t lines = 0;  // counted by the first pass
  };

  void place_along_odometry() {
    InitialValues start = registry_.make_start("odometry", document_.graph);
    report_.apart = start.apart;
    if (!start.values.empty()) document_.graph.set_values(std::move(start.values));
  }

  void read_first_line() {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // the byte order mark of some editors
    const std::string_view first = text_.substr(0, text_.find('\n'));
    LineScanner line(first, name_, 1);
    if (line.word() != "GRAPH") return;
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

  // Neighbouring lines mostly have the same tag, and a file has few: the last one found is tried first.
  Tag& known_tag(std::string_view word) {
    if (last_tag_ < tags_.size() && tags_[last_tag_].word == word) return tags_[last_tag_];
    for (last_tag_ = 0; last_tag_ < tags_.size(); ++last_tag_) {
      if (tags_[last_tag_].word == word) return tags_[last_tag_];
    }
    if (tags_.size() == kMostTags) tags_.pop_back();
    last_tag_ = tags_.size();
    return tags_.emplace_back(Tag{word, registry_.find_vertex(word), registry_.find_edge(word)});
  }

  void read_vertex(LineScanner& line, const VertexType& type) {
    const VertexId id = line.integer({type.tag, "id"});
    if (document_.graph.find(id)) {
      line.fail(type.tag + ": vertex " + std::to_string(id) + " is defined a second time");
    }
    values_.clear();
    for (const std::string& name : type.value_names) values_.push_back(line.number({type.tag, name}));
    line.end(type.tag);
    document_.graph.add_vertex(type, id, values_);
  }

  VertexIndex read_vertex_id(LineScanner& line, std::string_view tag, std::string_view field = "vertex") {
    const VertexId id = line.integer({tag, field});
    const auto found = document_.graph.find(id);
    if (!found) line.fail(std::string(tag) + ": vertex " + std::to_string(id) + " is not defined");
    return *found;
  }

  void read_statement(LineScanner& line, const Tag& tag) {
    if (tag.edge == nullptr) return read_other(line, tag.word);
    read_edge(line, *tag.edge, tag.lines);
  }

  void read_edge(LineScanner& line, const EdgeType& type, std::size_t lines) {
    last_batch_ = nullptr;  // a LOSS must not go to an earlier edge where this one is skipped
    const bool runtime = type.arity == EdgeType::kRuntimeArity;
    const std::int64_t arity = runtime ? line.integer({type.tag, "arity"}) : type.arity;
    if (runtime && (arity < 1 || arity > kMaxArity)) {
      line.fail(join(type.tag, "the arity must be 1 to " + std::to_string(kMaxArity)));
    }
    vertices_.clear();
    for (std::int64_t k = 0; k < arity; ++k) vertices_.push_back(read_vertex_id(line, type.tag));
    values_.clear();
    Eigen::Index dimension = type.error_dimension;
    if (runtime) {
      dimension = 0;
      Eigen::Index value_size = 0;
      for (const VertexIndex v : vertices_) {
        value_size += document_.graph.vertex_type(v).value_size;
        dimension += document_.graph.vertex_type(v).tangent_size;
      }
      read_numbers(line, type.tag, "reference", value_size);
      read_numbers(line, type.tag, "offset", dimension);
    }
    for (const FieldInfo& field : type.fields) read_numbers(line, type.tag, field.name, field.size);
    information_.resize(dimension, dimension);
    int index = 0;
    for (Eigen::Index row = 0; row < dimension; ++row) {
      for (Eigen::Index column = row; column < dimension; ++column) {
        const double value = line.number({type.tag, "information", index++});
        information_(row, column) = information_(column, row) = value;
      }
    }
    line.end(type.tag);
    if (!is_positive_semidefinite(information_)) {
      line.fail(type.tag +
                ": the information matrix is indefinite (an eigenvalue below -1e-9 of the largest)");
    }
    try {
      last_batch_ = &document_.graph.add_edge(type, vertices_, values_, information_);
    } catch (const UsageError& error) {
      line.fail(error.what());
    }
    if (!runtime && last_batch_->size() == 1) last_batch_->reserve(std::min(lines, most_lines(type)));
  }

  /// How many edges of a type the text has room for, whatever its tags promise.
  [[nodiscard]] std::size_t most_lines(const EdgeType& type) const {
    const int numbers =
        type.arity + type.field_size() + type.error_dimension * (type.error_dimension + 1) / 2;
    return text_.size() / static_cast<std::size_t>(2 * numbers);
  }

  void read_numbers(LineScanner& line, std::string_view tag, std::string_view field, Eigen::Index count) {
    for (int i = 0; i < count; ++i) values_.push_back(line.number({tag, field, count > 1 ? i : -1}));
  }

  void read_other(LineScanner& line, std::string_view tag) {
    if (tag == "FIX") {
      do {
        document_.graph.set_fixed(read_vertex_id(line, tag), true);
      } while (!line.at_end());
    } else if (!is_waymark_) {
      fail_unknown(line, tag);
    } else if (tag == "STAMP") {
      const VertexIndex v = read_vertex_id(line, tag);
      if (document_.graph.stamp(v)) line.fail(join(tag, "this vertex has a stamp already"));
      const Stamp stamp{line.integer({tag, "nanoseconds"})};
      line.end(tag);
      document_.graph.set_stamp(v, stamp);
    } else if (tag == "LOSS") {
      read_loss(line);
    } else if (tag == "GNSS") {
      read_record(line);
    } else if (tag == "COVARIANCE") {
      read_covariance(line);
    } else if (!read_header(line, tag)) {
      fail_unknown(line, tag);
    }
  }

  [[noreturn]] void fail_unknown(const LineScanner& line, std::string_view tag) {
    last_batch_ = nullptr;  // it may have been an edge: a LOSS below it belongs to none that is known
    if (is_one_of(tag, kOwnTags)) {
      line.fail(join(tag, is_waymark_ ? "stands in the first line only"
                                      : "is known in files only whose first line is 'GRAPH 1'"));
    }
    if (is_one_of(tag, kToroTags)) {
      line.fail("tag " + quote_word(tag) +
                " of TORO or GTSAM, which are not guessed (order and meaning of their numbers differ); a "
                "TORO file is "
                "read with --input-format toro");
    }
    line.fail("unknown tag " + quote_word(tag) + "; if a plugin defines it, load it with --plugin");
  }

  /// For statements that hold for the whole file.
  void only_once(LineScanner& line, const std::string& statement) {
    if (std::find(seen_.begin(), seen_.end(), statement) != seen_.end()) {
      line.fail(statement + ": is given a second time");
    }
    seen_.push_back(statement);
  }

  bool read_header(LineScanner& line, std::string_view tag) {
    if (tag == "FRAME") {
      only_once(line, "FRAME");
      document_.frame = read_frame(line);
    } else if (tag == "TIME") {
      only_once(line, "TIME");
      const std::string_view word = line.word();
      const auto scale = time_scale_from_string(word);
      if (!scale) line.fail("TIME: expected gps, utc or unix, got " + quote_word(word));
      document_.time_scale = *scale;
      line.end(tag);
    } else if (tag == "PROVENANCE") {
      const std::string key(line.word());
      if (key.empty()) line.fail("PROVENANCE: expected a key");
      document_.provenance.emplace_back(key, std::string(line.rest()));
    } else if (tag == "LEVER") {
      const std::string_view which = line.word();
      if (which != "antenna" && which != "truth") {
        line.fail("LEVER: expected antenna or truth, got " + quote_word(which));
      }
      only_once(line, "LEVER " + std::string(which));
      Eigen::Vector2d& lever = which == "antenna" ? document_.antenna_m : document_.truth_reference_m;
      lever[0] = line.number({tag, "x"});
      lever[1] = line.number({tag, "y"});
      line.end(tag);
    } else if (tag == "TYPE") {
      check_type(line);
    } else {
      return false;
    }
    return true;
  }

  void check_type(LineScanner& line) {
    const std::string tag(line.word());
    const EdgeType* type = registry_.find_edge(tag);
    if (type == nullptr)
      line.fail("TYPE: edge type " + quote_word(tag) + " is not known; load the plugin that defines it");
    const std::string_view given = line.rest();
    const std::string known = describe_schema(*type);
    if (given != known) {
      line.fail("TYPE: " + tag + " is described as '" + std::string(given) +
                "', but the registered type is '" + known + "'");
    }
  }

  void read_loss(LineScanner& line) {
    if (last_batch_ == nullptr) line.fail("LOSS: no edge stands above it");
    const std::string_view name = line.word();
    const LossType* type = registry_.find_loss(name);
    if (type == nullptr) line.fail("LOSS: unknown loss " + quote_word(name));
    const double scale = line.number({"LOSS", "scale"});
    if (scale <= 0) line.fail("LOSS: the scale must be positive");
    line.end("LOSS");
    last_batch_->set_loss(last_batch_->size() - 1, Loss{type->name, type->evaluate, scale});
  }

  void read_covariance(LineScanner& line) {
    const VertexIndex v = read_vertex_id(line, "COVARIANCE");
    const int n = document_.graph.vertex_type(v).tangent_size;
    Eigen::MatrixXd covariance(n, n);
    int index = 0;
    for (int row = 0; row < n; ++row) {
      for (int column = row; column < n; ++column) {
        covariance(row, column) = covariance(column, row) =
            line.number({"COVARIANCE", "covariance", index++});
      }
    }
    line.end("COVARIANCE");
    if (!is_positive_semidefinite(covariance)) line.fail("COVARIANCE: the covariance matrix is indefinite");
    has_covariance_.resize(document_.graph.vertex_count(), 0);
    if (has_covariance_[static_cast<std::size_t>(v)]++ != 0) {
      line.fail("COVARIANCE: this vertex has a covariance already");
    }
    document_.covariances.push_back({v, covariance});
  }

  void read_record(LineScanner& line) {
    Fix fix = read_fix(line);
    if (!document_.graph.find(fix.vertex)) {
      line.fail("GNSS: vertex " + std::to_string(fix.vertex) + " is not defined");
    }
    document_.fixes.push_back(std::move(fix));
  }

  // A file with edges only (SE-Sync's way): its vertices are those the edges name, in ascending order.
  void make_vertices_of_edges() {
    std::vector<std::pair<VertexId, const VertexType*>> named;
    for_each_line({}, [&](LineScanner& line, std::string_view tag) {
      const EdgeType* type = known_tag(tag).edge;
      if (type == nullptr || type->arity == EdgeType::kRuntimeArity) return;
      for (const std::string& vertex_tag : type->vertex_tags) {
        named.emplace_back(line.integer({tag, "vertex"}), registry_.find_vertex(vertex_tag));
      }
    });
    std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [id, type] : named) {
      if (type == nullptr || document_.graph.find(id)) continue;
      values_.assign(static_cast<std::size_t>(type->value_size), 0.0);
      document_.graph.add_vertex(*type, id, values_);
    }
    report_.edges_only = document_.graph.vertex_count() > 0;
    // Wrong lines are reported once, by the pass that reads the edges.
    report_.skipped = 0;
    report_.examples.clear();
  }

  std::string_view text_;
  const std::string& name_;
  const TypeRegistry& registry_;
  bool lenient_;
  ReadReport& report_;
  GraphDocument document_;
  bool is_waymark_ = false;
  std::vector<std::string> seen_;
  Place place_;  // of the line being read
  std::vector<Tag> tags_;
  std::size_t last_tag_ = 0;
  EdgeBatchBase* last_batch_ = nullptr;
  std::vector<VertexIndex> vertices_;
  std::vector<char> has_covariance_;  // per vertex
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
  ReadReport own;
  return GraphReader(text, name, registry, lenient, report != nullptr ? *report : own).read();
}

}  // namespace waymark

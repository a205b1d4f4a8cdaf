#include <algorithm>

#include <Eigen/Eigenvalues>

#include <waymark/core/error.hpp>
#include <waymark/formats/graph_document.hpp>
#include <waymark/formats/line_scanner.hpp>

namespace waymark {
namespace {

constexpr std::size_t kExamples = 10;

/// Smallest eigenvalue not below -1e-9 of the largest; zeros are legal (no information on an axis).
bool is_positive_semidefinite(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd diagonal = information.diagonal();
  if (diagonal.minCoeff() > 0) {
    // Gershgorin settles the usual, diagonally dominant case.
    const Eigen::VectorXd off = information.cwiseAbs().rowwise().sum() - diagonal;
    if ((diagonal - off).minCoeff() >= 0) return true;
  }
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(information, Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = std::max(std::abs(eigenvalues[0]), eigenvalues[eigenvalues.size() - 1]);
  return eigenvalues[0] >= -1e-9 * largest;
}

class GraphReader {
 public:
  GraphReader(std::string_view text, const std::string& name, const TypeRegistry& registry, bool lenient,
              ReadReport& report)
      : text_(text), name_(name), registry_(registry), lenient_(lenient), report_(report) {}

  GraphDocument read() {
    read_first_line();
    // Vertices first, so that edges, FIX and STAMP may stand anywhere.
    for_each_line([this](LineScanner& line, std::string_view tag) {
      if (const VertexType* type = vertex_type(tag)) read_vertex(line, *type);
    });
    if (document_.graph.vertex_count() == 0 && !is_waymark_) make_vertices_of_edges();
    for_each_line([this](LineScanner& line, std::string_view tag) {
      if (vertex_type(tag) == nullptr) read_statement(line, tag);
    });
    if (report_.edges_only) start_from_odometry_chain(document_.graph);
    if (document_.graph.vertex_count() == 0) throw InputError(name_ + ": no vertices in it");
    return std::move(document_);
  }

 private:
  void read_first_line() {
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
  void for_each_line(Visit visit) {
    std::size_t begin = 0;
    for (std::size_t number = 1; begin < text_.size(); ++number) {
      std::size_t end = text_.find('\n', begin);
      if (end == std::string_view::npos) end = text_.size();
      const std::string_view text = text_.substr(begin, end - begin);
      begin = end + 1;
      LineScanner line(text, name_, number);
      const std::string_view tag = line.word();
      if (tag.empty() || tag.front() == '#' || (number == 1 && is_waymark_)) continue;
      try {
        visit(line, tag);
      } catch (const InputError& error) {
        if (!lenient_) throw;
        ++report_.skipped;
        if (report_.examples.size() < kExamples) report_.examples.emplace_back(error.what());
      }
    }
  }

  // Neighbouring lines mostly have the same tag: the last one found is tried first.
  const VertexType* vertex_type(std::string_view tag) {
    if (last_vertex_ != nullptr && last_vertex_->tag == tag) return last_vertex_;
    if (last_other_ == tag) return nullptr;
    const VertexType* type = registry_.find_vertex(tag);
    if (type != nullptr) {
      last_vertex_ = type;
    } else {
      last_other_ = tag;
    }
    return type;
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

  void read_statement(LineScanner& line, std::string_view tag) {
    if (last_edge_ == nullptr || last_edge_->tag != tag) {
      const EdgeType* type = registry_.find_edge(tag);
      if (type == nullptr) return read_other(line, tag);
      last_edge_ = type;
    }
    read_edge(line, *last_edge_);
  }

  void read_edge(LineScanner& line, const EdgeType& type) {
    const bool runtime = type.arity == EdgeType::kRuntimeArity;
    const std::int64_t arity = runtime ? line.integer({type.tag, "arity"}) : type.arity;
    if (runtime && (arity < 1 || arity > 100000)) line.fail(type.tag + ": the arity must be 1 to 100000");
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
      document_.graph.add_edge(type, vertices_, values_, information_);
    } catch (const UsageError& error) {
      line.fail(error.what());
    }
    last_batch_ = &document_.graph.batch(type);
  }

  void read_numbers(LineScanner& line, std::string_view tag, std::string_view field, Eigen::Index count) {
    for (int i = 0; i < count; ++i) values_.push_back(line.number({tag, field, count > 1 ? i : -1}));
  }

  void read_other(LineScanner& line, std::string_view tag) {
    if (tag == "FIX") {
      do {
        document_.graph.set_fixed(read_vertex_id(line, tag), true);
      } while (!LineScanner(line).word().empty());
    } else if (tag == "STAMP" && is_waymark_) {
      const VertexIndex v = read_vertex_id(line, tag);
      document_.graph.set_stamp(v, Stamp{line.integer({tag, "nanoseconds"})});
      line.end(tag);
    } else if (tag == "LOSS" && is_waymark_) {
      read_loss(line);
    } else if (tag == "GNSS" && is_waymark_) {
      read_fix(line);
    } else if (tag == "COVARIANCE" && is_waymark_) {
      read_covariance(line);
    } else if (is_waymark_ && read_header(line, tag)) {
      return;
    } else {
      line.fail("unknown tag '" + std::string(tag) + "'; if a plugin defines it, load it with --plugin");
    }
  }

  bool read_header(LineScanner& line, std::string_view tag) {
    if (tag == "FRAME") {
      read_frame(line);
    } else if (tag == "TIME") {
      const std::string_view word = line.word();
      const auto scale = time_scale_from_string(word);
      if (!scale) line.fail("TIME: expected gps, utc or unix, got '" + std::string(word) + "'");
      document_.time_scale = *scale;
      line.end(tag);
    } else if (tag == "PROVENANCE") {
      const std::string key(line.word());
      if (key.empty()) line.fail("PROVENANCE: expected a key");
      document_.provenance.emplace_back(key, std::string(line.rest()));
    } else if (tag == "LEVER") {
      const std::string_view which = line.word();
      if (which != "antenna" && which != "truth") line.fail("LEVER: expected antenna or truth");
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

  void read_frame(LineScanner& line) {
    Frame frame;
    const std::string_view kind = line.word();
    if (kind == "utm") {
      const std::string zone(line.word());
      const char hemisphere = zone.empty() ? ' ' : zone.back();
      frame.zone = std::atoi(zone.c_str());
      frame.north = hemisphere == 'N';
      if (frame.zone < 1 || frame.zone > 60 || (hemisphere != 'N' && hemisphere != 'S')) {
        line.fail("FRAME: expected a UTM zone such as 32N, got '" + zone + "'");
      }
    } else if (kind != "local") {
      line.fail("FRAME: expected utm or local, got '" + std::string(kind) + "'");
    }
    if (line.word() != "origin") line.fail("FRAME: expected the word origin");
    frame.origin_easting_m = line.number({"FRAME", "easting"});
    frame.origin_northing_m = line.number({"FRAME", "northing"});
    line.end("FRAME");
    document_.frame = frame;
  }

  void check_type(LineScanner& line) {
    const std::string tag(line.word());
    const EdgeType* type = registry_.find_edge(tag);
    if (type == nullptr)
      line.fail("TYPE: edge type '" + tag + "' is not known; load the plugin that defines it");
    const std::string_view given = line.rest();
    const std::string known = describe_schema(*type);
    if (given != known) {
      line.fail("TYPE: " + tag + " is described as '" + std::string(given) +
                "', but the registered type is '" + known + "'");
    }
  }

  void read_loss(LineScanner& line) {
    if (last_batch_ == nullptr) line.fail("LOSS: stands before any edge");
    const std::string_view name = line.word();
    const LossType* type = registry_.find_loss(name);
    if (type == nullptr) line.fail("LOSS: unknown loss '" + std::string(name) + "'");
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
    document_.covariances.push_back({v, covariance});
  }

  void read_fix(LineScanner& line) {
    constexpr std::string_view kTag = "GNSS";
    Fix fix;
    fix.vertex = line.integer({kTag, "vertex"});
    if (!document_.graph.find(fix.vertex)) {
      line.fail("GNSS: vertex " + std::to_string(fix.vertex) + " is not defined");
    }
    fix.stamp.nanoseconds = line.integer({kTag, "nanoseconds"});
    fix.position[0] = line.number({kTag, "x"});
    fix.position[1] = line.number({kTag, "y"});
    fix.covariance(0, 0) = line.number({kTag, "covariance", 0});
    fix.covariance(0, 1) = fix.covariance(1, 0) = line.number({kTag, "covariance", 1});
    fix.covariance(1, 1) = line.number({kTag, "covariance", 2});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    fix.height_m = line.optional_number({kTag, "height"}).value_or(nan);
    fix.heading_rad = line.optional_number({kTag, "heading"});
    fix.heading_sigma_rad = line.optional_number({kTag, "heading_sigma"});
    fix.speed_mps = line.optional_number({kTag, "speed"});
    fix.speed_sigma_mps = line.optional_number({kTag, "speed_sigma"});
    fix.grid_scale = line.number({kTag, "grid_scale"});
    fix.epoch = static_cast<int>(line.integer({kTag, "epoch"}));
    fix.source = static_cast<int>(line.integer({kTag, "source"}));
    const std::string_view status = line.word();
    const auto known = fix_status_from_string(status);
    if (!known) line.fail("GNSS: expected accepted, rejected or withheld, got '" + std::string(status) + "'");
    fix.status = *known;
    fix.reason = std::string(line.word());
    if (fix.reason.empty()) line.fail("GNSS: expected a reason, got the end of the line");
    fix.chord_angle_rad = line.optional_number({kTag, "chord_angle"}).value_or(nan);
    fix.displacement_m = line.optional_number({kTag, "displacement"}).value_or(nan);
    line.end(kTag);
    document_.fixes.push_back(std::move(fix));
  }

  // A file with edges only (SE-Sync's way): its vertices are those the edges name, in ascending order.
  void make_vertices_of_edges() {
    std::vector<std::pair<VertexId, const VertexType*>> named;
    for_each_line([&](LineScanner& line, std::string_view tag) {
      const EdgeType* type = registry_.find_edge(tag);
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
  const VertexType* last_vertex_ = nullptr;
  const EdgeType* last_edge_ = nullptr;
  std::string_view last_other_;
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
  ReadReport own;
  return GraphReader(text, name, registry, lenient, report != nullptr ? *report : own).read();
}

}  // namespace waymark

#include <algorithm>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/formats/graph/detail/graph_records.hpp>
#include <waymark/formats/graph/detail/own_statements.hpp>

namespace waymark::formats {

bool OwnStatements::read(LineScanner& line, std::string_view tag, EdgeBatchBase* edge_above) {
  if (tag == "STAMP") {
    read_stamp(line);
  } else if (tag == "LOSS") {
    read_loss(line, edge_above);
  } else if (tag == "GNSS") {
    read_record(line);
  } else if (tag == "COVARIANCE") {
    read_covariance(line);
  } else {
    return read_header(line, tag);
  }
  return true;
}

bool OwnStatements::read_header(LineScanner& line, std::string_view tag) {
  if (tag == "FRAME") {
    only_once(line, "FRAME");
    document_.frame = read_frame(line);
  } else if (tag == "TIME") {
    read_time(line);
  } else if (tag == "PROVENANCE") {
    const std::string key(line.word());
    if (key.empty()) line.fail("PROVENANCE: expected a key");
    document_.provenance.emplace_back(key, std::string(line.rest()));
  } else if (tag == "LEVER") {
    read_lever(line);
  } else if (tag == "SOURCE") {
    read_source(line);
  } else if (tag == "STATES") {
    read_states(line);
  } else if (tag == "EDGES") {
    read_edges(line);
  } else if (tag == "TYPE") {
    check_type(line);
  } else {
    return false;
  }
  return true;
}

void OwnStatements::only_once(LineScanner& line, const std::string& statement) {
  if (std::find(seen_.begin(), seen_.end(), statement) != seen_.end()) {
    line.fail(statement + ": is given a second time");
  }
  seen_.push_back(statement);
}

void OwnStatements::read_time(LineScanner& line) {
  only_once(line, "TIME");
  const std::string_view word = line.word();
  const auto scale = time_scale_from_string(word);
  if (!scale) line.fail("TIME: expected gps, utc or unix, got " + quote_word(word));
  document_.time_scale = *scale;
  line.end("TIME");
}

void OwnStatements::read_lever(LineScanner& line) {
  const std::string_view which = line.word();
  if (which != "antenna" && which != "truth") {
    line.fail("LEVER: expected antenna or truth, got " + quote_word(which));
  }
  only_once(line, "LEVER " + std::string(which));
  Eigen::Vector2d& lever = which == "antenna" ? document_.antenna_m : document_.truth_reference_m;
  lever[0] = line.number({"LEVER", "x"});
  lever[1] = line.number({"LEVER", "y"});
  line.end("LEVER");
}

void OwnStatements::read_source(LineScanner& line) {
  DocumentSource source;
  source.name = line.word();
  source.kind = line.word();
  if (source.kind.empty()) line.fail("SOURCE: expected a name and a kind");
  only_once(line, "SOURCE " + source.name);
  source.antenna_m[0] = line.number({"SOURCE", "x"});
  source.antenna_m[1] = line.number({"SOURCE", "y"});
  line.end("SOURCE");
  document_.sources.push_back(std::move(source));
}

DocumentSource& OwnStatements::source_above(LineScanner& line, const std::string& statement) {
  const std::string name(line.word());
  const auto source = std::find_if(document_.sources.begin(), document_.sources.end(),
                                   [&](const DocumentSource& known) { return known.name == name; });
  if (source == document_.sources.end())
    line.fail(statement + ": there is no SOURCE " + quote_word(name) + " above this line");
  return *source;
}

void OwnStatements::read_states(LineScanner& line) {
  DocumentSource& source = source_above(line, "STATES");
  VertexRange range;
  range.first = VertexId{line.integer({"STATES", "first"})};
  range.last = VertexId{line.integer({"STATES", "last"})};
  if (range.last < range.first) line.fail("STATES: the last id is below the first");
  line.end("STATES");
  source.vertices.push_back(range);
}

void OwnStatements::read_edges(LineScanner& line) {
  DocumentSource& source = source_above(line, "EDGES");
  const std::string tag(line.word());
  if (registry_.find_edge(tag) == nullptr) line.fail("EDGES: edge type " + quote_word(tag) + " is not known");
  const std::int64_t first = line.integer({"EDGES", "first"});
  const std::int64_t last = line.integer({"EDGES", "last"});
  if (first < 0 || last < first) line.fail("EDGES: expected 0 <= first <= last");
  line.end("EDGES");
  source.edges.push_back({tag, static_cast<std::size_t>(first), static_cast<std::size_t>(last)});
}

void OwnStatements::check_type(LineScanner& line) const {
  const std::string tag(line.word());
  const EdgeType* type = registry_.find_edge(tag);
  if (type == nullptr)
    line.fail("TYPE: edge type " + quote_word(tag) + " is not known; load the plugin that defines it");
  const std::string_view given = line.rest();
  const std::string known = describe_schema(*type);
  if (given != known) {
    line.fail("TYPE: " + tag + " is described as '" + std::string(given) + "', but the registered type is '" +
              known + "'");
  }
}

void OwnStatements::read_stamp(LineScanner& line) {
  const VertexIndex v = read_vertex_id(line, document_.graph, "STAMP");
  if (document_.graph.stamp(v)) line.fail("STAMP: this vertex has a stamp already");
  const Stamp stamp{line.integer({"STAMP", "nanoseconds"})};
  line.end("STAMP");
  document_.graph.set_stamp(v, stamp);
}

void OwnStatements::read_loss(LineScanner& line, EdgeBatchBase* edge_above) {
  if (edge_above == nullptr) line.fail("LOSS: there is no edge above this line");
  const std::string_view name = line.word();
  const LossType* type = registry_.find_loss(name);
  if (type == nullptr) line.fail("LOSS: unknown loss " + quote_word(name));
  const double scale = line.number({"LOSS", "scale"});
  if (scale <= 0) line.fail("LOSS: the scale must be positive");
  line.end("LOSS");
  edge_above->set_loss(edge_above->size() - 1, Loss{type->name, type->evaluate, scale});
}

void OwnStatements::read_record(LineScanner& line) {
  Fix fix = read_fix(line);
  if (!document_.graph.find(fix.vertex)) {
    line.fail("GNSS: vertex " + to_string(fix.vertex) + " is not defined");
  }
  document_.fixes.push_back(std::move(fix));
}

void OwnStatements::read_covariance(LineScanner& line) {
  const VertexIndex v = read_vertex_id(line, document_.graph, "COVARIANCE");
  const int n = document_.graph.vertex_type(v).tangent_size;
  Eigen::MatrixXd covariance(n, n);
  int index = 0;
  for (int row = 0; row < n; ++row) {
    for (int column = row; column < n; ++column) {
      covariance(row, column) = covariance(column, row) = line.number({"COVARIANCE", "covariance", index++});
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

}  // namespace waymark::formats

#include <algorithm>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/system/held_marks.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/jobs/graph/covariance.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

/// Returns names of the upper triangle, row by row. If the value of a type has more numbers than
/// degrees of freedom, the latter have no names and are counted.
Names triangle_names(const VertexType& type) {
  Names axes = type.value_names;
  if (type.value_size != type.tangent_size) {
    axes.clear();
    for (int i = 0; i < type.tangent_size; ++i) axes.push_back(fmt::format("tangent{}", i));
  }
  Names names;
  for (std::size_t row = 0; row < axes.size(); ++row) {
    for (std::size_t column = row; column < axes.size(); ++column)
      names.push_back(fmt::format("{}_{}", axes[row], axes[column]));
  }
  return names;
}

/// Calls take(number) for the upper triangle, row by row.
template <typename Take>
void for_upper_triangle(const Eigen::MatrixXd& covariance, Take take) {
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    for (Eigen::Index column = row; column < covariance.cols(); ++column) take(covariance(row, column));
  }
}

/// The columns of a table over vertices of several types.
class Columns {
 public:
  explicit Columns(const formats::GraphDocument& document) {
    for (const formats::VertexCovariance& block : document.covariances) {
      const VertexType& type = document.graph.vertex_type(block.vertex);
      if (places_.contains(type.tag)) continue;
      std::vector<std::size_t>& places = places_[type.tag];
      for (const std::string& name : triangle_names(type)) {
        const auto known = std::find(names_.begin(), names_.end(), name);
        places.push_back(static_cast<std::size_t>(known - names_.begin()));
        if (known == names_.end()) names_.push_back(name);
      }
    }
  }

  [[nodiscard]] const Names& names() const { return names_; }
  /// Returns the places of the triangle of a type.
  [[nodiscard]] const std::vector<std::size_t>& places(const std::string& tag) const {
    return places_.at(tag);
  }

 private:
  Names names_;
  std::map<std::string, std::vector<std::size_t>> places_;
};

void write_csv(const formats::GraphDocument& document, const formats::TextSink& sink) {
  const Columns columns(document);
  std::string line = "id,tag,stamp_ns";
  for (const std::string& name : columns.names()) line += "," + name;
  sink(line + "\n");
  Names fields;
  for (const formats::VertexCovariance& block : document.covariances) {
    const std::string& tag = document.graph.vertex_type(block.vertex).tag;
    fields.assign(columns.names().size(), "");
    auto place = columns.places(tag).begin();
    for_upper_triangle(block.covariance, [&](double number) { fields[*place++] = fmt::to_string(number); });
    line = fmt::format("{},{},", to_number(document.graph.id(block.vertex)), tag);
    if (const auto stamp = document.graph.stamp(block.vertex)) line += fmt::to_string(stamp->nanoseconds);
    for (const std::string& field : fields) line += "," + field;
    sink(line + "\n");
  }
}

/// Returns the names of the numbers, per vertex type.
Json chart_json(const formats::GraphDocument& document) {
  Json types = Json::object();
  for (const formats::VertexCovariance& block : document.covariances) {
    const VertexType& type = document.graph.vertex_type(block.vertex);
    if (!types.contains(type.tag)) types[type.tag] = triangle_names(type);
  }
  return {
      {"of",
       "each vertex's retraction at the values of this optimum (VERTEX_SE2: x, y in frame axes, heading)"},
      {"upper_triangle", types}};
}

/// Returns the vertices that are certain by convention, and the sentences about them and about single held
/// coordinates.
Json held_json(const Graph& graph) {
  const Gauge gauge = find_gauge(graph);
  Json held = Json::array();
  for (std::size_t v = 0; v < gauge.held.size(); ++v) {
    if (is_wholly_held(gauge.held[v])) held.push_back(to_number(graph.id(static_cast<VertexIndex>(v))));
  }
  return {{"vertices", held}, {"notes", gauge.messages}};
}

/// Returns losses with the number of their edges.
Json robust_json(const Graph& graph) {
  Json losses = Json::array();
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    std::map<std::pair<std::string, double>, std::size_t> edges;
    for (std::size_t e = 0; e < batch.size(); ++e) {
      if (const Loss* loss = batch.loss(e)) ++edges[{loss->name, loss->scale}];
    }
    for (const auto& [loss, count] : edges) {
      losses.push_back(
          {{"type", graph.edge_type(b).tag}, {"loss", loss.first}, {"scale", loss.second}, {"edges", count}});
    }
  }
  return {{"losses", losses},
          {"counted",
           "weights at the optimum, and second-order terms except for edges whose loss is flat or concave"}};
}

// Writes one line per vertex, so that a hundred thousand of them are readable and need not be one
// tree in memory.
void write_json(const formats::GraphDocument& document, const Summary& summary,
                const formats::TextSink& sink) {
  Json header = {{"version", "waymark " WAYMARK_VERSION},
                 {"converged", summary.converged()},
                 {"chi2", summary.final_chi2},
                 {"errors", summary.error_forms},
                 {"time_scale", std::string(to_string(document.time_scale))},
                 {"chart", chart_json(document)},
                 {"held", held_json(document.graph)},
                 {"robust", robust_json(document.graph)}};
  std::string text = json_text(header);
  text.erase(text.rfind("\n}"));
  sink(text + ",\n  \"covariances\": [");
  const char* separator = "\n    ";
  for (const formats::VertexCovariance& block : document.covariances) {
    Json line = {{"id", to_number(document.graph.id(block.vertex))},
                 {"tag", document.graph.vertex_type(block.vertex).tag}};
    if (const auto stamp = document.graph.stamp(block.vertex)) line["stamp_ns"] = stamp->nanoseconds;
    Json& numbers = line["upper_triangle"] = Json::array();
    for_upper_triangle(block.covariance, [&](double number) { numbers.push_back(number); });
    sink(separator + line.dump());
    separator = ",\n    ";
  }
  sink(document.covariances.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace

void check_covariance_file(const std::string& path, const std::string& which) {
  if (path.empty()) return;
  if (!path.ends_with(".csv") && !path.ends_with(".json")) {
    throw UsageError("--covariance-file: the name must end in .csv or .json, got '" + path + "'");
  }
  if (which == "none") {
    throw UsageError("--covariance-file: choose the covariances: --covariance fixes or --covariance all");
  }
  require_output_place(path);
}

void write_covariances(const std::string& path, const formats::GraphDocument& document,
                       const Summary& summary) {
  formats::write_file_atomically(path, [&](const formats::TextSink& sink) {
    path.ends_with(".csv") ? write_csv(document, sink) : write_json(document, summary, sink);
  });
}

}  // namespace waymark::program

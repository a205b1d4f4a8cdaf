#include <waymark/tools/evaluation/document/source_residuals.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::evaluation {
namespace {

constexpr double kHalf = 0.5;

/// Sums up the edges of a type that belong to a source.
SourceResiduals of_edges(const TypeResiduals& type, const formats::EdgeShare& share,
                         const formats::DocumentSource& source) {
  SourceResiduals result{.source = source.name, .kind = source.kind, .tag = type.tag};
  double squares = 0;
  double weights = 0;
  std::size_t components = 0;
  for (std::size_t e = share.first; e <= share.last; ++e) {
    const EdgeResidual& edge = type.edges[e];
    result.largest = std::fmax(result.largest, std::sqrt(std::max(0.0, edge.squared)));
    weights += edge.weight;
    if (edge.weight < kHalf) ++result.down_weighted;
    ++result.measurements;
    for (std::size_t k = 0; k < type.dimension; ++k) {
      const double w = type.whitened[e * type.dimension + k];
      if (std::isnan(w)) continue;
      squares += w * w;
      ++components;
    }
  }
  if (components > 0) result.rms = std::sqrt(squares / static_cast<double>(components));
  result.weight = weights / static_cast<double>(result.measurements);
  return result;
}

/// Counts the edges of a share that have a loss.
std::size_t robust_edges(const Graph& graph, const formats::EdgeShare& share) {
  std::size_t robust = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag != share.tag) continue;
    for (std::size_t e = share.first; e <= share.last; ++e)
      if (graph.batch(b).loss(e) != nullptr) ++robust;
  }
  return robust;
}

/// Joins what a source has added in several parts.
void add(const SourceResiduals& part, std::vector<SourceResiduals>& rows) {
  const auto known = std::find_if(rows.begin(), rows.end(), [&](const SourceResiduals& row) {
    return row.source == part.source && row.tag == part.tag;
  });
  if (known == rows.end()) return rows.push_back(part);
  const auto n = static_cast<double>(known->measurements);
  const auto m = static_cast<double>(part.measurements);
  known->rms = std::sqrt((n * known->rms * known->rms + m * part.rms * part.rms) / (n + m));
  known->weight = (n * known->weight + m * part.weight) / (n + m);
  known->largest = std::fmax(known->largest, part.largest);
  known->measurements += part.measurements;
  known->robust += part.robust;
  known->down_weighted += part.down_weighted;
}

}  // namespace

std::vector<SourceResiduals> residuals_by_source(const formats::GraphDocument& document) {
  std::vector<SourceResiduals> rows;
  if (document.sources.empty()) return rows;
  const GraphResiduals residuals = residuals_by_type(document.graph, 0);
  for (const formats::DocumentSource& source : document.sources) {
    for (const formats::EdgeShare& share : source.edges) {
      const auto type = std::find_if(residuals.types.begin(), residuals.types.end(),
                                     [&](const TypeResiduals& known) { return known.tag == share.tag; });
      if (type == residuals.types.end() || type->role != EdgeRole::measurement) continue;
      SourceResiduals part = of_edges(*type, share, source);
      part.robust = robust_edges(document.graph, share);
      add(part, rows);
    }
  }
  return rows;
}

text::Table source_residuals_table(const std::vector<SourceResiduals>& residuals, const std::string& label) {
  const std::string prefix = label.empty() ? "" : label + ", ";
  text::Table table{.columns = {"measurements of", "kind", "edge", "number", "rms (whitened)", "largest",
                                "down-weighted", "mean weight"}};
  for (const SourceResiduals& row : residuals) {
    table.rows.push_back({prefix + row.source, row.kind, row.tag, fmt::to_string(row.measurements),
                          text::readable(row.rms), text::readable(row.largest),
                          row.robust == 0 ? "no loss" : fmt::to_string(row.down_weighted),
                          text::readable(row.weight)});
  }
  return table;
}

nlohmann::ordered_json source_residuals_json(const std::vector<SourceResiduals>& residuals) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const SourceResiduals& row : residuals) {
    json.push_back({{"source", row.source},
                    {"kind", row.kind},
                    {"edge", row.tag},
                    {"measurements", row.measurements},
                    {"rms", text::number_or_null(row.rms)},
                    {"largest", text::number_or_null(row.largest)},
                    {"robust", row.robust},
                    {"down_weighted", row.down_weighted},
                    {"mean_weight", text::number_or_null(row.weight)}});
  }
  return json;
}

}  // namespace waymark::evaluation

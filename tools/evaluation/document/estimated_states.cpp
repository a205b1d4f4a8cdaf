#include <waymark/tools/evaluation/document/estimated_states.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/number_text.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::evaluation {
namespace {

bool is_state(const VertexType& type) {
  return !type.value_units.empty() && type.position == nullptr && type.value_size == type.tangent_size;
}

/// The estimated vertices of one type, in their order.
struct StateVertices {
  const VertexType* type = nullptr;
  std::string source{};  ///< of the drive, if it has several
  std::vector<VertexIndex> vertices;
};

/// The chains of values that walks and decays join: of each vertex the first one of its chain; -1: none
/// joins it. Receivers that share their errors have biases of their own, each with its chain.
std::vector<VertexIndex> chains_of(const Graph& graph) {
  std::vector<VertexIndex> chain(graph.vertex_count(), -1);
  const auto root = [&](VertexIndex v) {
    while (chain[static_cast<std::size_t>(v)] >= 0 && chain[static_cast<std::size_t>(v)] != v)
      v = chain[static_cast<std::size_t>(v)];
    return v;
  };
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      if (vertices.size() != 2 || graph.vertex_type(vertices[0]).tag != graph.vertex_type(vertices[1]).tag)
        return;
      if (!is_state(graph.vertex_type(vertices[0]))) return;
      const auto [first, second] = std::minmax({root(vertices[0]), root(vertices[1])});
      chain[static_cast<std::size_t>(first)] = first;
      chain[static_cast<std::size_t>(second)] = first;
    });
  }
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (chain[static_cast<std::size_t>(v)] >= 0) chain[static_cast<std::size_t>(v)] = root(v);
  return chain;
}

/// Tells whether a vertex continues a state: it is a later value of the same type, and in the same chain.
bool goes_on(const Graph& graph, const StateVertices& state, const std::string& source, VertexIndex v,
             std::span<const VertexIndex> chains) {
  const auto before = graph.stamp(state.vertices.back());
  const auto now = graph.stamp(v);
  return state.type->tag == graph.vertex_type(v).tag && state.source == source && before && now &&
         *before < *now &&
         chains[static_cast<std::size_t>(state.vertices.back())] == chains[static_cast<std::size_t>(v)];
}

/// Numbers the states that would have the same name: "front.gnss_bias", "front.gnss_bias 2".
void number_twins(std::vector<StateReport>& reports) {
  std::map<std::string, int> count;
  for (StateReport& report : reports) {
    const int number = ++count[report.name];
    if (number > 1) report.name += fmt::format(" {}", number);
  }
}

std::vector<StateVertices> states_of(const formats::GraphDocument& document) {
  const Graph& graph = document.graph;
  const std::vector<VertexIndex> chains = chains_of(graph);
  std::vector<StateVertices> states;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const VertexType& type = graph.vertex_type(v);
    if (!is_state(type) || graph.fixed(v)) continue;
    const std::string source = formats::source_of(graph.id(v), document);
    auto known = std::find_if(states.begin(), states.end(), [&](const StateVertices& other) {
      return goes_on(graph, other, source, v, chains);
    });
    if (known == states.end()) known = states.insert(states.end(), {&type, source, {}});
    known->vertices.push_back(v);
  }
  return states;
}

/// Returns the priors of single vertices: the information of each.
std::map<VertexIndex, Eigen::MatrixXd> single_priors(const Graph& graph) {
  std::map<VertexIndex, Eigen::MatrixXd> priors;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag != GaussianPriorBatch::kTag) continue;
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (batch.vertices(i).size() == 1) priors[batch.vertices(i).front()] = batch.information(i);
    }
  }
  return priors;
}

/// If the posterior sigma is above this share of the prior sigma, the drive did not
/// observe the state.
constexpr double kNotObserved = 0.9;

StateReport report(const Graph& graph, const StateVertices& state, int axis,
                   const Eigen::MatrixXd& last_covariance) {
  const auto value = [&](VertexIndex v) { return graph.value(v)[static_cast<std::size_t>(axis)]; };
  const auto less = [&](VertexIndex a, VertexIndex b) { return value(a) < value(b); };
  const auto [smallest, largest] = std::minmax_element(state.vertices.begin(), state.vertices.end(), less);
  StateReport result;
  result.source = state.source;
  result.name = state.type->value_names[static_cast<std::size_t>(axis)];
  if (!state.source.empty()) result.name = state.source + "." + result.name;
  result.unit = state.type->value_units[static_cast<std::size_t>(axis)];
  result.values = state.vertices.size();
  result.first = value(state.vertices.front());
  result.last = value(state.vertices.back());
  result.smallest = value(*smallest);
  result.largest = value(*largest);
  if (state.vertices.size() > 1) {
    for (const VertexIndex v : state.vertices) {
      result.stamps.push_back(*graph.stamp(v));
      result.wandering.push_back(value(v));
    }
  }
  // 0: the vertex was not estimated, because no edge touches it
  const double variance = last_covariance(axis, axis);
  result.sigma = variance > 0 ? std::sqrt(variance) : std::numeric_limits<double>::quiet_NaN();
  return result;
}

void judge_by_prior(const std::map<VertexIndex, Eigen::MatrixXd>& priors, VertexIndex first, int axis,
                    const Eigen::MatrixXd& covariance, StateReport& result) {
  result.prior_sigma = std::numeric_limits<double>::quiet_NaN();
  result.surprise = std::numeric_limits<double>::quiet_NaN();
  const auto prior = priors.find(first);
  if (prior == priors.end() || !(prior->second(axis, axis) > 0)) return;
  result.prior_sigma = 1 / std::sqrt(prior->second(axis, axis));
  result.observed =
      covariance(axis, axis) > 0 && std::sqrt(covariance(axis, axis)) < kNotObserved * result.prior_sigma;
  result.surprise =
      std::abs(result.first) / std::sqrt(result.prior_sigma * result.prior_sigma - covariance(axis, axis));
}

/// Returns the covariances of vertices: those of the document, if it has all of them.
std::vector<Eigen::MatrixXd> covariances_of(const formats::GraphDocument& document,
                                            const std::vector<VertexIndex>& vertices) {
  std::unordered_map<VertexIndex, const Eigen::MatrixXd*> known;
  for (const formats::VertexCovariance& block : document.covariances)
    known.emplace(block.vertex, &block.covariance);
  std::vector<Eigen::MatrixXd> covariances;
  covariances.reserve(vertices.size());
  for (const VertexIndex v : vertices) {
    const auto block = known.find(v);
    if (block == known.end()) break;
    covariances.push_back(*block->second);
  }
  if (covariances.size() == vertices.size()) return covariances;
  covariances.clear();
  const CovarianceBlocks blocks = marginal_covariances(document.graph, vertices);
  for (std::size_t i = 0; i < blocks.size(); ++i) covariances.emplace_back(blocks[i]);
  return covariances;
}

}  // namespace

std::vector<StateReport> report_states(const formats::GraphDocument& document) {
  const std::vector<StateVertices> states = states_of(document);
  if (states.empty()) return {};
  std::vector<VertexIndex> ends;
  for (const StateVertices& state : states) {
    ends.push_back(state.vertices.front());
    ends.push_back(state.vertices.back());
  }
  const std::vector<Eigen::MatrixXd> covariances = covariances_of(document, ends);
  const auto priors = single_priors(document.graph);
  std::vector<StateReport> reports;
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (int axis = 0; axis < states[i].type->value_size; ++axis) {
      reports.push_back(report(document.graph, states[i], axis, covariances[2 * i + 1]));
      judge_by_prior(priors, states[i].vertices.front(), axis, covariances[2 * i], reports.back());
    }
  }
  number_twins(reports);
  return reports;
}

std::string states_text(const std::vector<StateReport>& states, const text::TextLook& look) {
  if (states.empty()) return {};
  text::Table table{.columns = {"estimated state", "unit", "values", "first", "last", "smallest", "largest",
                                "sigma", "prior", ""}};
  for (const StateReport& s : states) {
    table.rows.push_back({s.name, s.unit, fmt::to_string(s.values), text::readable(s.first),
                          text::readable(s.last), text::readable(s.smallest), text::readable(s.largest),
                          text::readable(s.sigma), text::readable(s.prior_sigma),
                          s.observed ? "" : "not observed"});
  }
  return text::table_text(table, look);
}

nlohmann::ordered_json states_json(const std::vector<StateReport>& states) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const StateReport& s : states) {
    json.push_back({{"name", s.name},
                    {"unit", s.unit},
                    {"values", s.values},
                    {"first", s.first},
                    {"last", s.last},
                    {"smallest", s.smallest},
                    {"largest", s.largest},
                    {"sigma", text::number_or_null(s.sigma)},
                    {"prior_sigma", text::number_or_null(s.prior_sigma)},
                    {"observed", s.observed}});
  }
  return json;
}

}  // namespace waymark::evaluation

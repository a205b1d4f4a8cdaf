#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/graph/detail/sight_check.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {
namespace {

/// Vertices and reference values of one edge.
struct Joined {
  std::vector<VertexIndex> vertices;
  std::vector<double> reference;  ///< numbers of the vertices, each slightly changed
  std::size_t tangent_size = 0;
};

using Numbers = std::vector<double>;

/// Draws values of vertices that are valid for their types.
class ValueDraw {
 public:
  ValueDraw(const EdgeScenario& scenario, std::mt19937_64& random) : scenario_(scenario), random_(random) {}

  [[nodiscard]] Numbers value(const VertexType& type) {
    if (is_curved(type)) return moved(type, base(type), scenario_.place);
    Numbers numbers;
    for (std::size_t i = 0; i < type.value_names.size(); ++i) {
      numbers.push_back(type.value_names[i] == "heading" ? scenario_.heading + scenario_.spread * unit()
                                                         : size_of(type, i) * unit());
    }
    return normalised(type, std::move(numbers));
  }
  /// A value near another one, by the size of fields.
  [[nodiscard]] Numbers near(const VertexType& type, Numbers numbers) {
    if (is_curved(type)) return moved(type, std::move(numbers), scenario_.field);
    for (double& x : numbers) x += scenario_.field * unit();
    return numbers;
  }

 private:
  /// Places are far away, but no scale or rate is 2000: products of such states would be rounding alone.
  [[nodiscard]] double size_of(const VertexType& type, std::size_t number) const {
    constexpr double kLargestOther = 5;
    const bool is_place = number >= type.value_units.size() || type.value_units[number] == "m";
    return is_place ? scenario_.place : std::min(scenario_.place, kLargestOther);
  }
  /// Tells whether values have more numbers than degrees of freedom, such as a unit vector: then not every
  /// choice of numbers is a value.
  static bool is_curved(const VertexType& type) { return type.value_size != type.tangent_size; }

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  static Numbers normalised(const VertexType& type, Numbers numbers) {
    const Numbers zero(static_cast<std::size_t>(type.tangent_size), 0.0);
    type.retract(numbers.data(), zero.data());
    return numbers;
  }
  Numbers moved(const VertexType& type, Numbers numbers, double most) {
    Numbers delta(static_cast<std::size_t>(type.tangent_size));
    for (double& d : delta) d = most * unit();
    type.retract(numbers.data(), delta.data());
    return numbers;
  }
  /// The value from which all vertices of a curved type are moved, so that a scenario of small motions has
  /// them.
  const Numbers& base(const VertexType& type) {
    const auto [found, is_new] = bases_.try_emplace(type.tag);
    if (is_new) {
      Numbers numbers(static_cast<std::size_t>(type.value_size));
      for (double& x : numbers) x = unit();
      found->second = normalised(type, std::move(numbers));
    }
    return found->second;
  }

  const EdgeScenario& scenario_;
  std::mt19937_64& random_;
  std::map<std::string, Numbers> bases_;
};

Joined add_vertices(const TypeRegistry& registry, const EdgeType& type, const EdgeScenario& scenario,
                    std::mt19937_64& random, Graph& graph) {
  std::vector<std::string> tags = type.vertex_tags;
  if (type.arity == EdgeType::kRuntimeArity) {  // it takes any vertices
    for (const auto& [vertex, origin] : registry.vertices()) tags.push_back(vertex.tag);
  }
  ValueDraw draw(scenario, random);
  Joined joined;
  for (const std::string& tag : tags) {
    const VertexType* vertex = registry.find_vertex(tag);
    if (vertex == nullptr)
      throw UsageError(type.tag + ": joins " + tag +
                       ", which is not registered; load the plugin that defines it");
    const Numbers value = draw.value(*vertex);
    joined.vertices.push_back(graph.add_vertex(*vertex, VertexId(joined.vertices.size()), value));
    joined.tangent_size += static_cast<std::size_t>(vertex->tangent_size);
    for (const double x : draw.near(*vertex, value)) joined.reference.push_back(x);
  }
  return joined;
}

bool is_finite(const Graph& graph) {
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  graph.batch(0).linearize_edge(0, graph.view(), error, jacobians);
  bool finite = error.allFinite();
  for (const Eigen::MatrixXd& jacobian : jacobians) finite = finite && jacobian.allFinite();
  return finite;
}

/// Returns the normal equations of the only edge of a graph, from its Jacobians.
std::pair<Eigen::MatrixXd, Eigen::VectorXd> assembled(const Graph& graph) {
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> parts;
  graph.batch(0).linearize_edge(0, graph.view(), error, parts);
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& part : parts) columns += part.cols();
  Eigen::MatrixXd jacobian(error.size(), columns);
  columns = 0;
  for (const Eigen::MatrixXd& part : parts) {
    jacobian.middleCols(columns, part.cols()) = part;
    columns += part.cols();
  }
  const Eigen::MatrixXd weighted = jacobian.transpose() * graph.batch(0).information(0);
  return {weighted * jacobian, weighted * error};
}

/// Returns the place of each tangent number of the edge's vertices among the unknowns.
std::vector<Eigen::Index> unknowns_of(const Graph& graph, const Structure& structure) {
  std::vector<Eigen::Index> places;
  for (const VertexIndex v : graph.batch(0).vertices(0)) {
    const auto begin = structure.pattern().start[static_cast<std::size_t>(structure.column_of(v))];
    for (int i = 0; i < graph.vertex_type(v).tangent_size; ++i)
      places.push_back(static_cast<Eigen::Index>(begin) + i);
  }
  return places;
}

/// Returns how far the normal equations that the optimizer uses are from those of the Jacobians, relative
/// to their size.
double normal_error_of(const Graph& graph) {
  const auto [hessian, gradient] = assembled(graph);
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  NormalEquations equations(graph, structure);
  (void)equations.linearize(graph.values());
  const std::vector<Eigen::Index> places = unknowns_of(graph, structure);
  const auto used = equations.gradient();
  double worst = 0;
  Eigen::VectorXd column(used.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto own = static_cast<Eigen::Index>(i);
    worst = std::max(worst, std::abs(used[places[i]] - gradient[own]) / (1 + gradient.norm()));
    equations.multiply(Eigen::VectorXd::Unit(used.size(), places[i]), column);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double difference = column[places[k]] - hessian(static_cast<Eigen::Index>(k), own);
      worst = std::max(worst, std::abs(difference) / (1 + hessian.norm()));
    }
  }
  return worst;
}

}  // namespace

std::span<const EdgeScenario> edge_scenarios() {
  constexpr double kPi = std::numbers::pi;
  static constexpr std::array<EdgeScenario, 6> kScenarios = {{
      {"identity", 0, 0, 0, 0},
      {"tiny relative motion", 1e-8, 0.3, 1e-8, 1e-8},
      {"tiny relative motion at heading pi", 1e-8, kPi, 1e-8, 1e-8},
      {"headings on both sides of pi", 5, kPi, 0.1, 0.4},
      {"random", 5, 0, 1.4, 0.7},
      {"far away", 2000, 1, 0.5, 0.7},
  }};
  return kScenarios;
}

Graph single_edge(const TypeRegistry& registry, const EdgeType& type, const EdgeScenario& scenario,
                  std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Graph graph;
  const Joined joined = add_vertices(registry, type, scenario, random, graph);
  const bool runtime = type.arity == EdgeType::kRuntimeArity;
  std::vector<double> fields = runtime ? joined.reference : std::vector<double>();
  const std::size_t rest = runtime ? joined.tangent_size : static_cast<std::size_t>(type.field_size());
  for (std::size_t i = 0; i < rest; ++i) fields.push_back(scenario.field * unit(random));
  const auto n =
      runtime ? static_cast<Eigen::Index>(joined.tangent_size) : Eigen::Index{type.error_dimension};
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return unit(random); });
  const Eigen::MatrixXd information = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
  graph.add_edge(type, joined.vertices, fields, 0.5 * (information + information.transpose()));
  return graph;
}

EdgeTypeCheck check_edge_type(const TypeRegistry& registry, const EdgeType& type, int repetitions) {
  EdgeTypeCheck result;
  result.sight_error = detail::sight_error_of(registry, type);
  for (const EdgeScenario& scenario : edge_scenarios()) {
    std::mt19937_64 random(11);
    for (int i = 0; i < repetitions; ++i) {
      Graph graph = single_edge(registry, type, scenario, random);
      ++result.trials;
      if (!is_finite(graph)) {
        ++result.not_finite;
        continue;
      }
      const RelativeCheck relative = check_relative(graph, 0, 1);
      if (result.relative.edges == 0 || relative.error > result.relative.error) result.relative = relative;
      result.normal_error = std::max(result.normal_error, normal_error_of(graph));
      const GradientCheck found = check_gradients(graph, 0, 1);
      result.judged += found.judged;
      if (!result.scenario.empty() && found.error <= result.worst.error) continue;
      result.worst = found;
      result.scenario = scenario.name;
      result.graph = std::move(graph);
    }
  }
  return result;
}

}  // namespace waymark

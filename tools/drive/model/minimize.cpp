#include <waymark/tools/drive/model/minimize.hpp>

#include <algorithm>
#include <vector>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>

namespace waymark::drive {
namespace {

std::vector<VertexIndex> wanted_vertices(const formats::GraphDocument& document, const std::string& which) {
  std::vector<VertexIndex> vertices;
  if (which == "fixes") {
    vertices = evaluated_vertices(document);
    std::erase(vertices, -1);  // fixes of several receivers may share a vertex
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  } else if (which == "all") {
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(document.graph.vertex_count()); ++v) {
      if (!document.graph.fixed(v)) vertices.push_back(v);
    }
  }
  return vertices;
}

}  // namespace

// The backends are registered fastest first. On every measured graph the first one was the fastest.
std::string solver_name(const Minimization& how, const TypeRegistry& registry) {
  return how.solver == "auto" ? registry.linear_solvers().front().type.name : how.solver;
}

OptimizerOptions optimizer_options(const Minimization& how, const MinimizationWatch& watch) {
  OptimizerOptions options;
  options.max_iterations = how.max_iterations;
  options.decrement_tolerance = how.tolerance;
  options.threads = how.threads;
  options.observer = watch.observer;
  options.cancel = watch.cancel;
  return options;
}

void check_minimization(const Minimization& how, const TypeRegistry& registry) {
  (void)registry.make_algorithm(how.algorithm, how.options);
  (void)registry.make_linear_solver(solver_name(how, registry), how.solver_options);
  check_start(how.start, registry);
}

MultiStartSummary minimize(Graph& graph, const Minimization& how, const TypeRegistry& registry,
                           const MinimizationWatch& watch, const Minimizer& search) {
  const auto algorithm = registry.make_algorithm(how.algorithm, how.options);
  const auto solver = registry.make_linear_solver(solver_name(how, registry), how.solver_options);
  MultiStartSummary result =
      optimize_from(how.start, graph, registry, *algorithm, *solver, optimizer_options(how, watch), search);
  result.summary.algorithm = how.algorithm;
  return result;
}

void add_covariances(formats::GraphDocument& document, const std::string& which) {
  document.covariances.clear();
  const std::vector<VertexIndex> vertices = wanted_vertices(document, which);
  if (vertices.empty()) return;
  const Marginals marginals(document.graph);
  const CovarianceBlocks blocks = marginals.blocks(vertices);
  document.covariances.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    // A vertex that is not estimated gets no line, because zeros would look like certainty.
    if (marginals.estimated(vertices[i])) document.covariances.push_back({vertices[i], blocks[i]});
  }
}

}  // namespace waymark::drive

#include <algorithm>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/linear/inverse_form.hpp>
#include <waymark/core/system/normal_equations.hpp>
#include <waymark/core/system/weakest_unknown.hpp>

namespace waymark {
namespace {

using detail::at;

}  // namespace

Marginals::Marginals(const Graph& graph) : graph_(graph), gauge_(find_gauge(graph)) {
  structure_.build(graph, gauge_.held);
  NormalEquations equations(graph, structure_);
  (void)equations.linearize(graph.values());
  cholesky_.analyze(structure_.pattern());
  const bool has_factor = cholesky_.factorize(equations.hessian()) == FactorStatus::ok;
  if (!has_factor || is_lost_in_rounding(graph, graph.values(), equations, cholesky_)) {
    throw InputError("the normal equations are not positive definite, so some vertex is not determined: " +
                     describe_weakest(graph_, equations, cholesky_));
  }
}

CovarianceBlocks Marginals::blocks(std::span<const VertexIndex> vertices) const {
  CovarianceBlocks result;
  result.places_.reserve(vertices.size());
  std::int64_t numbers = 0;
  for (const VertexIndex v : vertices) {
    const int size = graph_.vertex_type(v).tangent_size;
    result.places_.push_back({numbers, size});
    numbers += std::int64_t{size} * size;
  }
  result.numbers_.assign(at(numbers), 0.0);
  std::vector<double*> target(structure_.pattern().size.size(), nullptr);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int column = structure_.column_of(vertices[i]);
    if (column >= 0) target[at(column)] = result.numbers_.data() + result.places_[i].begin;
  }
  cholesky_.invert_diagonal(target);
  for (std::size_t i = 0; i < vertices.size(); ++i) {  // a vertex may be requested twice
    const int column = structure_.column_of(vertices[i]);
    double* own = result.numbers_.data() + result.places_[i].begin;
    if (column < 0 || target[at(column)] == own) continue;
    std::copy_n(target[at(column)], result.places_[i].size * result.places_[i].size, own);
  }
  return result;
}

Eigen::MatrixXd Marginals::joint(std::span<const VertexIndex> vertices) const {
  Eigen::Index size = 0;
  for (const VertexIndex v : vertices) size += graph_.vertex_type(v).tangent_size;
  std::vector<BlockRow> unit;
  Eigen::Index begin = 0;
  for (const VertexIndex v : vertices) {
    const Eigen::Index own = graph_.vertex_type(v).tangent_size;
    if (const int column = structure_.column_of(v); column >= 0) {
      unit.push_back({column, Eigen::MatrixXd::Zero(own, size)});
      unit.back().values.middleCols(begin, own).setIdentity();
    }
    begin += own;
  }
  if (unit.empty()) return Eigen::MatrixXd::Zero(size, size);
  const Eigen::MatrixXd covariance = InverseForm(cholesky_)(unit);
  return 0.5 * (covariance + covariance.transpose());  // symmetric except for rounding
}

CovarianceBlocks marginal_covariances(const Graph& graph, std::span<const VertexIndex> vertices) {
  return Marginals(graph).blocks(vertices);
}

}  // namespace waymark

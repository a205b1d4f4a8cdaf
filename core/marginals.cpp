#include <algorithm>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <waymark/core/error.hpp>
#include <waymark/core/gauge.hpp>
#include <waymark/core/marginals.hpp>
#include <waymark/core/normal_equations.hpp>

namespace waymark {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Entries of (L L^T)^-1 on the pattern of L, lower triangle, laid out as L's own numbers. Column by column
/// from the last: with s the rows of column j below the diagonal, Z_sj = -Z_ss l_sj / l_jj and Z_jj = (1/l_jj
/// - l_sj^T Z_sj) / l_jj (Takahashi, Fagan, Chin 1973; Erisman, Tinney 1975).
std::vector<double> selected_inverse(const Matrix& factor) {
  const int* begin = factor.outerIndexPtr();
  const int* rows = factor.innerIndexPtr();
  const double* numbers = factor.valuePtr();
  std::vector<double> inverse(at(factor.nonZeros()), 0.0);
  std::vector<double> column(at(factor.rows()), 0.0);      // l_sj, spread out
  std::vector<Eigen::Index> owner(at(factor.rows()), -1);  // column whose pattern a row was last seen in
  std::vector<double> product(at(factor.rows()), 0.0);     // Z_ss l_sj, spread out
  for (Eigen::Index j = factor.cols() - 1; j >= 0; --j) {
    const int first = begin[j];
    const int last = begin[j + 1];
    for (int k = first + 1; k < last; ++k) {
      column[at(rows[k])] = numbers[k];
      owner[at(rows[k])] = j;
      product[at(rows[k])] = 0;
    }
    // Every pair of rows of this column lies on the pattern of the earlier of the two: fill theorem.
    for (int k = first + 1; k < last; ++k) {
      const int r = rows[k];
      for (int m = begin[r]; m < begin[r + 1]; ++m) {
        const int s = rows[m];
        if (owner[at(s)] != j) continue;
        product[at(s)] += inverse[at(m)] * column[at(r)];
        if (s != r) product[at(r)] += inverse[at(m)] * column[at(s)];
      }
    }
    const double pivot = numbers[first];
    double diagonal = 1 / pivot;
    for (int k = first + 1; k < last; ++k) {
      inverse[at(k)] = -product[at(rows[k])] / pivot;
      diagonal -= numbers[k] * inverse[at(k)];
    }
    inverse[at(first)] = diagonal / pivot;
  }
  return inverse;
}

}  // namespace

std::vector<Eigen::MatrixXd> marginal_covariances(const Graph& graph, std::span<const VertexIndex> vertices) {
  Structure structure;
  structure.build(graph, find_gauge(graph).held);
  NormalEquations equations(graph, structure);
  equations.linearize(graph.values());
  const BlockPattern& pattern = structure.pattern();
  std::vector<Eigen::MatrixXd> result;
  Matrix factor;
  std::vector<double> inverse;
  if (pattern.dimension() > 0) {
    const ScalarPattern<int> scalar = to_scalar<int>(pattern);
    const auto n = static_cast<Eigen::Index>(pattern.dimension());
    const Matrix hessian =
        Eigen::Map<const Matrix>(n, n, static_cast<Eigen::Index>(scalar.row.size()), scalar.column.data(),
                                 scalar.row.data(), equations.hessian().data());
    const Eigen::SimplicialLLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> cholesky(hessian);
    if (cholesky.info() != Eigen::Success) {
      throw InputError(
          "the normal equations are not positive definite: some vertex is not determined by its edges");
    }
    factor = cholesky.matrixL().nestedExpression();
    inverse = selected_inverse(factor);
  }
  for (const VertexIndex v : vertices) {
    const int size = graph.vertex_type(v).tangent_size;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
    const int block = structure.column_of(v);
    for (int c = 0; c < size && block >= 0; ++c) {
      const auto first = pattern.start[at(block)];
      const int j = static_cast<int>(first) + c;
      for (int k = factor.outerIndexPtr()[j]; k < factor.outerIndexPtr()[j + 1]; ++k) {
        const auto r = factor.innerIndexPtr()[k] - first;
        if (r < size) covariance(r, c) = covariance(c, r) = inverse[at(k)];
      }
    }
    result.push_back(covariance);
  }
  return result;
}

}  // namespace waymark

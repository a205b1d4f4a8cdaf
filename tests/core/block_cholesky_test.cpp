// The own block Cholesky against dense algebra on every kind of pattern its analysis tells apart, with every
// set of kernels this processor runs, with one and more threads; its answer to matrices that are not
// positive definite; its accuracy beside Eigen's.
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/base/detail/thread_pool.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/linear/block_symbolic.hpp>
#include <waymark/core/linear/inverse_form.hpp>
#include <waymark/core/system/gauge.hpp>

#include "support/block_shapes.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"

namespace block_cholesky_test {

using namespace waymark;
using namespace waymark_test;

namespace {

Eigen::VectorXd solve(LinearSolver& solver, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Constant(b.size(), std::nan(""));
  const auto n = static_cast<std::size_t>(b.size());
  solver.solve({b.data(), n}, {x.data(), n});
  return x;
}

Eigen::VectorXd solve_in_place(LinearSolver& solver, Eigen::VectorXd b) {
  const std::span<double> both(b.data(), static_cast<std::size_t>(b.size()));
  solver.solve(both, both);
  return b;
}

/// Bit by bit, so that NaN equals NaN.
bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && std::equal(a.data(), a.data() + a.size(), b.data(), [](double x, double y) {
           return std::signbit(x) == std::signbit(y) && (x == y || (std::isnan(x) && std::isnan(y)));
         });
}

double difference(const Eigen::VectorXd& x, const Eigen::VectorXd& expected) {
  return x.size() == 0 ? 0 : (x - expected).norm() / expected.norm();
}

/// y = H x of the numbers on a pattern.
Eigen::VectorXd multiply(const BlockPattern& pattern, std::span<const double> values,
                         const Eigen::VectorXd& x) {
  const ScalarPattern<int> scalar = to_scalar<int>(pattern);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (std::size_t j = 0; j + 1 < scalar.column.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    for (int k = scalar.column[j]; k < scalar.column[j + 1]; ++k) {
      const Eigen::Index row = scalar.row[static_cast<std::size_t>(k)];
      const double value = values[static_cast<std::size_t>(k)];
      if (row <= column) y[row] += value * x[column];
      if (row < column) y[column] += value * x[row];
    }
  }
  return y;
}

/// A diagonally dominant matrix on the pattern, for sizes at which a dense one does not fit.
std::vector<double> dominant_values(const BlockPattern& pattern, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const ScalarPattern<int> scalar = to_scalar<int>(pattern);
  std::vector<double> values(scalar.row.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(pattern.dimension()));
  std::vector<std::size_t> diagonal;
  for (std::size_t j = 0; j + 1 < scalar.column.size(); ++j) {
    for (int k = scalar.column[j]; k < scalar.column[j + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const auto i = static_cast<std::size_t>(scalar.row[at]);
      if (i == j) diagonal.push_back(at);
      // Entries below the diagonal mirror those above, inside diagonal blocks.
      const std::uint64_t pair = std::min(i, j) * 1'000'003 + std::max(i, j);
      std::mt19937_64 of_pair(seed + pair);
      values[at] = unit(of_pair);
      sum[static_cast<Eigen::Index>(i)] += std::abs(values[at]);
      sum[static_cast<Eigen::Index>(j)] += std::abs(values[at]);
    }
  }
  for (std::size_t j = 0; j < diagonal.size(); ++j) values[diagonal[j]] = sum[static_cast<Eigen::Index>(j)];
  return values;
}

}  // namespace

TEST_CASE("block Cholesky: every kind of pattern, every set of kernels: the dense solution") {
  for (const Shape& shape : all_shapes()) {
    INFO(shape.name << ", " << shape.sizes.size() << " blocks");
    const BlockPattern pattern = shape.pattern();
    const Eigen::MatrixXd matrix = random_spd(pattern, 3, 1);
    const std::vector<double> values = gather(pattern, matrix);
    const Eigen::VectorXd b = right_side(matrix.rows());
    const Eigen::VectorXd expected = matrix.llt().solve(b);
    for (const DenseKernels& kernels : all_dense_kernels()) {
      INFO(kernels.name);
      BlockCholesky solver(kernels);
      solver.analyze(pattern);
      REQUIRE(solver.factorize(values) == FactorStatus::ok);
      const Eigen::VectorXd x = solve(solver, b);
      CHECK(difference(x, expected) <= 1e-12);
      CHECK(same_bits(solve_in_place(solver, b), x));
      CHECK(solver.factor_size() >= static_cast<std::int64_t>(matrix.rows()));
    }
  }
}

TEST_CASE("inverse form: every kind of pattern, any few block rows: the dense form") {
  std::mt19937_64 random(3);
  for (const Shape& shape : all_shapes()) {
    INFO(shape.name << ", " << shape.sizes.size() << " blocks");
    const BlockPattern pattern = shape.pattern();
    if (pattern.columns() == 0) continue;
    const Eigen::MatrixXd matrix = random_spd(pattern, 3, 1);
    BlockCholesky solver;
    solver.analyze(pattern);
    REQUIRE(solver.factorize(gather(pattern, matrix)) == FactorStatus::ok);
    InverseForm form(solver);
    for (const int count : {1, 2, 5}) {
      std::vector<BlockRow> rows;
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(matrix.rows(), count);
      for (int i = 0; i < count; ++i) {  // a block may come twice
        const int column = static_cast<int>(random() % static_cast<std::uint64_t>(pattern.columns()));
        const int size = pattern.size[static_cast<std::size_t>(column)];
        rows.push_back({column, Eigen::MatrixXd::Random(size, count)});
        all.middleRows(static_cast<Eigen::Index>(pattern.start[static_cast<std::size_t>(column)]), size) +=
            rows.back().values;
      }
      const Eigen::MatrixXd expected = all.transpose() * matrix.llt().solve(all);
      CHECK((form(rows) - expected).norm() <= 1e-11 * expected.norm());
    }
  }
}

TEST_CASE("block Cholesky: other numbers and other patterns leave nothing behind") {
  BlockCholesky used;
  std::uint64_t seed = 20;
  for (const Shape& shape : all_shapes()) {
    INFO(shape.name);
    const BlockPattern pattern = shape.pattern();
    const Eigen::VectorXd b = right_side(static_cast<Eigen::Index>(pattern.dimension()));
    used.analyze(pattern);
    for (int repetition = 0; repetition < 2; ++repetition) {
      const std::vector<double> values = gather(pattern, random_spd(pattern, ++seed));
      BlockCholesky fresh;
      fresh.analyze(pattern);
      REQUIRE(fresh.factorize(values) == FactorStatus::ok);
      REQUIRE(used.factorize(values) == FactorStatus::ok);
      CHECK(same_bits(solve(used, b), solve(fresh, b)));
      CHECK(same_bits(solve(used, b), solve(used, b)));
    }
  }
}

TEST_CASE("block Cholesky: a negative pivot, NaN or infinity in any block is reported, and then forgotten") {
  const double infinity = std::numeric_limits<double>::infinity();
  Shape components{"two chains and a clique", {}, {}};
  components.add_chain(5);
  components.add_chain(4);
  const int clique = components.add_chain(5, 2);
  for (int i = 0; i < 5; ++i) components.join(clique, clique + i);
  for (const Shape& shape : {chain(5), chain(70), chain_with_leaves(30, 6, 3), grid(4),
                             with_dense_columns(grid(3), 2), random_shape(9, 14, 5), components}) {
    INFO(shape.name);
    const BlockPattern pattern = shape.pattern();
    const Eigen::MatrixXd good = random_spd(pattern, 30);
    const Eigen::VectorXd b = right_side(good.rows());
    BlockCholesky solver;
    solver.analyze(pattern);
    REQUIRE(solver.factorize(gather(pattern, good)) == FactorStatus::ok);
    const Eigen::VectorXd expected = solve(solver, b);
    const ScalarPattern<int> scalar = to_scalar<int>(pattern);
    const auto spoilt = [&](Eigen::Index row, Eigen::Index column, double value) {
      Eigen::MatrixXd bad = good;
      bad(row, column) = bad(column, row) = value;
      return solver.factorize(gather(pattern, bad));
    };
    int missed = 0;
    for (Eigen::Index j = 0; j < good.rows(); ++j) {
      missed += spoilt(j, j, -1) != FactorStatus::not_positive_definite;
      missed += spoilt(j, j, -infinity) != FactorStatus::not_positive_definite;
      const auto column = static_cast<std::size_t>(j);
      for (int k = scalar.column[column]; k < scalar.column[column + 1]; ++k) {
        const Eigen::Index i = scalar.row[static_cast<std::size_t>(k)];
        if (i > j) continue;
        missed += spoilt(i, j, std::nan("")) != FactorStatus::not_positive_definite;
        missed += spoilt(i, j, infinity) != FactorStatus::not_positive_definite;
        // |H_ij| > sqrt(H_ii H_jj): indefinite with a diagonal that looks healthy
        if (i < j) {
          const double large = 1.01 * std::sqrt(good(i, i) * good(j, j));
          missed += spoilt(i, j, large) != FactorStatus::not_positive_definite;
        }
      }
    }
    CHECK(missed == 0);
    REQUIRE(solver.factorize(gather(pattern, good)) == FactorStatus::ok);
    CHECK(same_bits(solve(solver, b), expected));
  }
}

TEST_CASE("block Cholesky: a matrix without information on one block is singular") {
  for (const Shape& shape : {chain(3), chain(90), grid(4)}) {
    INFO(shape.name);
    const BlockPattern pattern = shape.pattern();
    BlockCholesky solver;
    solver.analyze(pattern);
    for (const int block : {0, pattern.columns() / 2, pattern.columns() - 1}) {
      Eigen::MatrixXd matrix = random_spd(pattern, 31);
      const auto first = static_cast<Eigen::Index>(pattern.start[static_cast<std::size_t>(block)]);
      matrix.middleRows(first, 3).setZero();
      matrix.middleCols(first, 3).setZero();
      CHECK(solver.factorize(gather(pattern, matrix)) == FactorStatus::not_positive_definite);
    }
    CHECK(solver.factorize(std::vector<double>(static_cast<std::size_t>(pattern.value_count()), 0.0)) ==
          FactorStatus::not_positive_definite);
  }
}

TEST_CASE("block Cholesky: the same bits for 1, 2, 3 and 5 threads, and run to run") {
  for (const Shape& shape : large_shapes()) {
    INFO(shape.name);
    const BlockPattern pattern = shape.pattern();
    const std::vector<double> values = dominant_values(pattern, 40);
    const Eigen::VectorXd b = right_side(static_cast<Eigen::Index>(pattern.dimension()));
    BlockCholesky alone;
    alone.analyze(pattern);
    REQUIRE(alone.factorize(values) == FactorStatus::ok);
    const Eigen::VectorXd expected = solve(alone, b);
    CHECK((multiply(pattern, values, expected) - b).lpNorm<Eigen::Infinity>() < 1e-13);
    for (const int threads : {2, 3, 5}) {
      ThreadPool pool(threads);
      BlockCholesky solver;
      solver.set_threads(&pool);
      solver.analyze(pattern);
      for (int repetition = 0; repetition < 3; ++repetition) {
        REQUIRE(solver.factorize(values) == FactorStatus::ok);
        CHECK(same_bits(solve(solver, b), expected));
      }
      std::vector<double> bad = values;
      bad[static_cast<std::size_t>(pattern.value[pattern.size.size() / 3 + 1]) - 1] =
          std::nan("");  // diagonal
      CHECK(solver.factorize(bad) == FactorStatus::not_positive_definite);
    }
  }
}

TEST_CASE("block Cholesky: many small components share one workspace") {
  // 3000 pairs beside a dense block: were each of them given a workspace of the largest front, that would be
  // most of the memory.
  Shape shape{"pairs and a large front", {}, {}};
  for (int i = 0; i < 3000; ++i) shape.add_chain(2);
  const int clique = shape.add_chain(40);
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < i; ++j) shape.join(clique + j, clique + i);
  }
  const BlockPattern pattern = shape.pattern();
  const BlockSymbolic symbolic = analyze_blocks(pattern);
  CHECK(symbolic.subtrees.size() <= 8);
  const std::vector<double> values = dominant_values(pattern, 41);
  const Eigen::VectorXd b = right_side(static_cast<Eigen::Index>(pattern.dimension()));
  BlockCholesky solver;
  solver.analyze(pattern);
  REQUIRE(solver.factorize(values) == FactorStatus::ok);
  CHECK((multiply(pattern, values, solve(solver, b)) - b).lpNorm<Eigen::Infinity>() < 1e-13);
}

namespace {

/// |H x - b| / (|H| |x| + |b|) in the infinity norm: the backward error of a solution.
double backward_error(LinearSolver& solver, const BlockPattern& pattern, std::span<const double> values,
                      const Eigen::VectorXd& b) {
  solver.analyze(pattern);
  REQUIRE(solver.factorize(values) == FactorStatus::ok);
  const Eigen::VectorXd x = solve(solver, b);
  std::vector<double> magnitudes(values.begin(), values.end());
  for (double& value : magnitudes) value = std::abs(value);
  const double norm =
      multiply(pattern, magnitudes, Eigen::VectorXd::Ones(b.size())).lpNorm<Eigen::Infinity>();
  return (multiply(pattern, values, x) - b).lpNorm<Eigen::Infinity>() /
         (norm * x.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>());
}

void check_accuracy(const Graph& graph) {
  Structure structure;
  structure.build(graph, find_gauge(graph).held);
  NormalEquations equations(graph, structure);
  equations.linearize(graph.values());
  const auto eigen = full_registry().make_linear_solver("eigen");
  BlockCholesky own;
  const Eigen::VectorXd gradient = equations.gradient();
  for (const Eigen::VectorXd& b : {gradient, right_side(gradient.size())}) {
    const double reference = backward_error(*eigen, structure.pattern(), equations.hessian(), b);
    const double error = backward_error(own, structure.pattern(), equations.hessian(), b);
    INFO("backward error " << error << ", Eigen's " << reference);
    CHECK(error <= 4 * reference + 1e-16);
  }
}

}  // namespace

TEST_CASE("block Cholesky: on ill-conditioned drives its backward error is that of Eigen") {
  const TypeRegistry registry = full_registry();
  for (const char* modeling : {"g1", "g2", "g3"}) {
    INFO(modeling);
    Drive drive = make_drive(registry, 20'000);
    drive.add_fixes(registry, modeling);
    check_accuracy(drive.graph);
  }
}

}  // namespace block_cholesky_test

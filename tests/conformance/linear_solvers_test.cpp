// Every registered linear solver against dense algebra: positive definite, singular, indefinite, tiny,
// refactored, analysed anew, blocks of mixed sizes.
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "support/block_matrices.hpp"
#include "support/registry.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

Eigen::VectorXd solve(LinearSolver& solver, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = b;  // the same memory for both is allowed
  const std::span<double> view(x.data(), static_cast<std::size_t>(x.size()));
  solver.solve(view, view);
  return x;
}

void check_solves(LinearSolver& solver, const BlockPattern& pattern, const Eigen::MatrixXd& matrix) {
  REQUIRE(solver.factorize(gather(pattern, matrix)) == FactorStatus::ok);
  const Eigen::VectorXd b = right_side(matrix.rows());
  const Eigen::VectorXd expected = matrix.llt().solve(b);
  CHECK((solve(solver, b) - expected).norm() <= 1e-10 * expected.norm());
  Eigen::VectorXd apart(b.size());
  const Eigen::VectorXd untouched = b;
  solver.solve({b.data(), static_cast<std::size_t>(b.size())},
               {apart.data(), static_cast<std::size_t>(apart.size())});
  CHECK((apart - expected).norm() <= 1e-10 * expected.norm());
  CHECK(b == untouched);
}

template <typename Visit>
void for_each_solver(Visit visit) {
  const TypeRegistry registry = full_registry();
  REQUIRE_FALSE(registry.linear_solvers().empty());
  for (const auto& [type, origin] : registry.linear_solvers()) {
    INFO(type.name);
    visit(*registry.make_linear_solver(type.name));
  }
}

const BlockPattern kOne = make_pattern({1}, {});
const BlockPattern kTwo = make_pattern({1, 1}, {{0, 1}});

}  // namespace

TEST_CASE("every linear solver: 1 x 1") {
  for_each_solver([](LinearSolver& solver) {
    solver.analyze(kOne);
    REQUIRE(solver.factorize(std::array{4.0}) == FactorStatus::ok);
    CHECK(solve(solver, Eigen::VectorXd::Constant(1, 2))[0] == Approx(0.5).epsilon(1e-15));
    CHECK(solver.factor_size() >= 1);
    CHECK_FALSE(solver.description().empty());
  });
}

TEST_CASE("every linear solver: a new analysis forgets the former factor") {
  const BlockPattern chain = make_pattern(std::vector<int>(40, 3), random_pairs(40, 25, 1));
  for_each_solver([&](LinearSolver& solver) {
    CHECK(solver.factor_size() == 0);
    solver.analyze(chain);
    check_solves(solver, chain, random_spd(chain, 2));
    const std::int64_t former = solver.factor_size();
    CHECK(former >= 40 * 3 * 4 / 2);
    solver.analyze(kOne);
    CHECK(solver.factor_size() < former);
  });
}

TEST_CASE("every linear solver: a chain of 3 x 3 blocks with closures") {
  const BlockPattern pattern = make_pattern(std::vector<int>(40, 3), random_pairs(40, 25, 1));
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(pattern);
    check_solves(solver, pattern, random_spd(pattern, 2));
  });
}

TEST_CASE("every linear solver: blocks of mixed sizes") {
  const BlockPattern pattern =
      make_pattern({1, 3, 2, 6, 3, 3, 1, 2, 4, 3, 1},
                   {{0, 1}, {1, 3}, {0, 4}, {3, 5}, {5, 8}, {2, 9}, {0, 10}, {1, 10}, {4, 10}, {8, 10}});
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(pattern);
    check_solves(solver, pattern, random_spd(pattern, 3));
  });
}

TEST_CASE("every linear solver: large enough for supernodes, dense last columns") {
  Pairs pairs = random_pairs(150, 60, 4);
  for (int i = 0; i < 149; ++i) pairs.insert({i, 149});
  std::vector<int> sizes(150, 3);
  sizes.back() = 4;
  const BlockPattern pattern = make_pattern(sizes, pairs);
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(pattern);
    check_solves(solver, pattern, random_spd(pattern, 5));
  });
}

TEST_CASE("every linear solver: other numbers on the same pattern") {
  const BlockPattern pattern = make_pattern(std::vector<int>(20, 3), random_pairs(20, 10, 6));
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(pattern);
    for (std::uint64_t seed = 7; seed < 10; ++seed) check_solves(solver, pattern, random_spd(pattern, seed));
  });
}

TEST_CASE("every linear solver: another pattern, larger and then smaller") {
  for_each_solver([&](LinearSolver& solver) {
    std::uint64_t version = 1;
    for (const int blocks : {5, 30, 3}) {
      const BlockPattern pattern = make_pattern(std::vector<int>(static_cast<std::size_t>(blocks), 2),
                                                random_pairs(blocks, blocks, 10), version++);
      solver.analyze(pattern);
      check_solves(solver, pattern, random_spd(pattern, 11));
    }
  });
}

TEST_CASE("every linear solver: singular is reported") {
  for_each_solver([](LinearSolver& solver) {
    solver.analyze(kOne);
    CHECK(solver.factorize(std::array{0.0}) == FactorStatus::not_positive_definite);
    solver.analyze(kTwo);
    CHECK(solver.factorize(gather(kTwo, Eigen::MatrixXd::Ones(2, 2))) == FactorStatus::not_positive_definite);
    CHECK(solver.factorize(gather(kTwo, Eigen::MatrixXd::Zero(2, 2))) == FactorStatus::not_positive_definite);
  });
}

TEST_CASE("every linear solver: indefinite is reported, and the next good matrix is solved") {
  const BlockPattern pattern = make_pattern(std::vector<int>(12, 3), random_pairs(12, 6, 12));
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(kTwo);
    Eigen::MatrixXd saddle(2, 2);
    saddle << 1, 2, 2, 1;  // eigenvalues 3 and -1, with a positive diagonal
    CHECK(solver.factorize(gather(kTwo, saddle)) == FactorStatus::not_positive_definite);
    solver.analyze(pattern);
    for (const Eigen::Index place : {0, 17, 35}) {
      Eigen::MatrixXd matrix = random_spd(pattern, 13);
      matrix(place, place) = -1;
      CHECK(solver.factorize(gather(pattern, matrix)) == FactorStatus::not_positive_definite);
      check_solves(solver, pattern, random_spd(pattern, 13));
    }
    CHECK(solver.factorize(gather(pattern, -random_spd(pattern, 13))) == FactorStatus::not_positive_definite);
  });
}

TEST_CASE("every linear solver: numbers that are not finite are reported") {
  const BlockPattern pattern = make_pattern(std::vector<int>(12, 3), random_pairs(12, 6, 14));
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(pattern);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      for (const Eigen::Index place : {0, 18, 35}) {
        Eigen::MatrixXd matrix = random_spd(pattern, 15);
        matrix(place, place) = bad;
        CHECK(solver.factorize(gather(pattern, matrix)) == FactorStatus::not_positive_definite);
      }
    }
    check_solves(solver, pattern, random_spd(pattern, 15));
  });
}

TEST_CASE("every linear solver: scales from 1e-8 to 1e8 on one diagonal") {
  const BlockPattern pattern = make_pattern(std::vector<int>(10, 3), random_pairs(10, 5, 16));
  const Eigen::MatrixXd matrix = random_spd(pattern, 17);
  const Eigen::VectorXd scale = Eigen::VectorXd::NullaryExpr(
      30, [](Eigen::Index i) { return std::pow(10.0, static_cast<double>(i % 9) - 4); });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  for_each_solver([&](LinearSolver& solver) {
    solver.analyze(pattern);
    REQUIRE(solver.factorize(gather(pattern, scaled)) == FactorStatus::ok);
    const Eigen::VectorXd x = solve(solver, scale.cwiseProduct(right_side(30)));
    const Eigen::VectorXd expected = matrix.llt().solve(right_side(30));
    CHECK((scale.cwiseProduct(x) - expected).norm() <= 1e-10 * expected.norm());
  });
}

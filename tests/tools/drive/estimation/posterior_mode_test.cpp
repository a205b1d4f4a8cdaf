// The search for the most probable noise, on costs whose minimum and curvature are known.
#include <cmath>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/estimation/posterior_mode.hpp>

namespace posterior_mode_test {

using namespace waymark::drive;

namespace {

struct Found {
  Eigen::VectorXd at;
  Eigen::MatrixXd covariance;
};

Found find(const PosteriorCost& cost, const Eigen::VectorXd& start, const PosteriorBounds& bounds) {
  const PosteriorMode mode = find_posterior_mode(cost, search_posterior(cost, start, bounds), bounds);
  return {mode.at, posterior_covariance(cost, mode, bounds)};
}

PosteriorBounds within(double reach, Eigen::Index size) {
  return {Eigen::VectorXd::Constant(size, -reach), Eigen::VectorXd::Constant(size, reach)};
}

}  // namespace

TEST_CASE("posterior mode: on a narrow ridge it is found from anywhere, with the whole covariance") {
  // A normal distribution with the correlation 0.999 about (1, -0.5).
  Eigen::Matrix2d covariance;
  covariance << 0.25, 0.999 * 0.5 * 0.3, 0.999 * 0.5 * 0.3, 0.09;
  const Eigen::Matrix2d information = covariance.inverse();
  const Eigen::Vector2d best(1, -0.5);
  const PosteriorCost cost{[&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    if (gradient != nullptr) *gradient = information * (x - best);
    return 7 + 0.5 * (x - best).dot(information * (x - best));
  }};
  for (const Eigen::Vector2d& start :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(-3, 3), Eigen::Vector2d(3.5, 0)}) {
    const Found mode = find(cost, start, within(4, 2));
    CHECK(mode.at[0] == Approx(1).margin(0.005));
    CHECK(mode.at[1] == Approx(-0.5).margin(0.003));
    CHECK((mode.covariance - covariance).norm() < 1e-4);
  }
}

TEST_CASE("posterior mode: the end of a curved valley is found within a hundredth of a deviation") {
  // -log of exp(-y^2 / 2) times a normal distribution of x about y^2 / 2 with deviation 0.1: mode (0, 0).
  const PosteriorCost cost{[](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    const double across = (x[0] - 0.5 * x[1] * x[1]) / 0.1;
    if (gradient != nullptr) *gradient = Eigen::Vector2d(10 * across, x[1] - 10 * across * x[1]);
    return 0.5 * (x[1] * x[1] + across * across);
  }};
  const Found mode = find(cost, Eigen::Vector2d(2, 2), within(4, 2));
  CHECK(std::abs(mode.at[0]) < 0.001);
  CHECK(std::abs(mode.at[1]) < 0.01);
  CHECK(mode.covariance(1, 1) == Approx(1).epsilon(0.1));
}

TEST_CASE("posterior mode: a parameter that is pushed over its bound stays there, the others adapt to it") {
  // Without bounds the minimum is (2, 1); with x <= 1 the best y is 1 - 0.8 (2 - 1).
  Eigen::Matrix2d information;
  information << 1, -0.8, -0.8, 1;
  const Eigen::Vector2d best(2, 1);
  const PosteriorCost cost{[&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    if (gradient != nullptr) *gradient = information * (x - best);
    return 0.5 * (x - best).dot(information * (x - best));
  }};
  const PosteriorBounds bounds{Eigen::Vector2d(-4, -4), Eigen::Vector2d(1, 4)};
  const Found mode = find(cost, Eigen::Vector2d::Zero(), bounds);
  CHECK(mode.at[0] == 1);
  CHECK(mode.at[1] == Approx(0.2).margin(0.01));
}

TEST_CASE("posterior mode: a parameter that is over its bound only until another is held comes back") {
  // Without bounds the minimum is (1.6, 6). With x = 1 the best y is 6 - 9.5 (1.6 - 1), inside.
  Eigen::Matrix2d information;
  information << 1000, -95, -95, 10;
  const Eigen::Vector2d best(1.6, 6);
  const PosteriorCost cost{[&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    if (gradient != nullptr) *gradient = information * (x - best);
    return 0.5 * (x - best).dot(information * (x - best));
  }};
  const PosteriorBounds bounds{Eigen::Vector2d(-4, -4), Eigen::Vector2d(1, 1)};
  const PosteriorMode mode = find_posterior_mode(cost, {Eigen::Vector2d(0.9, 0), information}, bounds);
  CHECK(mode.at[0] == 1);
  CHECK(mode.at[1] == Approx(0.3).margin(0.01));
}

TEST_CASE("posterior mode: it stays where the gradient ends, though the curvature is not positive there") {
  // A saddle: the search along y has come to y = 0, where the cost has its maximum in y.
  const PosteriorCost cost{[](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    if (gradient != nullptr) *gradient = Eigen::Vector2d(4 * x[0], -std::sin(x[1]) + 0.02 * x[1]);
    return 2 * x[0] * x[0] + std::cos(x[1]) + 0.01 * x[1] * x[1];
  }};
  const PosteriorMode mode =
      find_posterior_mode(cost, {Eigen::Vector2d(0.5, 1e-4), Eigen::Matrix2d::Identity()}, within(4, 2));
  Eigen::VectorXd gradient(2);
  CHECK(cost.at(mode.at, &gradient) <= 1.0001);
  CHECK(gradient.norm() < 0.02);
}

TEST_CASE("posterior mode: what the cost throws comes out of the search") {
  int calls = 0;
  const PosteriorCost cost{[&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    if (++calls == 3) throw waymark::InputError("the third");
    if (gradient != nullptr) *gradient = 10 * x;
    return 5 * x.squaredNorm();
  }};
  CHECK_THROWS_WITH(find(cost, Eigen::Vector2d(3, 2), within(4, 2)), "the third");
  CHECK(calls == 3);
}

TEST_CASE("posterior mode: a curvature that is known costs no differences, and a wrong one does no harm") {
  // Known to 0.2 and 0.1, with a term of fourth order.
  int gradients = 0;
  const PosteriorCost cost{[&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    const Eigen::Array2d away = x.array() - Eigen::Array2d(0.3, -0.2);
    const Eigen::Array2d weight(25, 100);
    if (gradient != nullptr) {
      ++gradients;
      *gradient = weight * away + 4 * away.cube();
    }
    return 0.5 * (weight * away.square()).sum() + away.pow(4).sum();
  }};
  const Eigen::Vector2d near(0.1, 0);
  const Eigen::Matrix2d known = Eigen::Vector2d(25, 100).asDiagonal();
  for (const double factor : {1.0, 3.0, 0.3}) {
    gradients = 0;
    const PosteriorMode mode = find_posterior_mode(cost, {near, factor * known}, within(4, 2));
    INFO("curvature times " << factor << ", " << gradients << " gradients");
    CHECK(mode.at[0] == Approx(0.3).margin(0.002));
    CHECK(mode.at[1] == Approx(-0.2).margin(0.001));
    if (factor == 1) CHECK(gradients <= 3);
    CHECK(gradients <= 9);
  }
  // Not positive: the quadratic has its maximum up the slope, and promises no gain from going there.
  const Eigen::Matrix2d hill = Eigen::Vector2d(-25, 100).asDiagonal();
  const PosteriorMode mode = find_posterior_mode(cost, {Eigen::Vector2d(0.1, -0.2), hill}, within(4, 2));
  CHECK(mode.at[0] == Approx(0.3).margin(0.002));
  CHECK(mode.at[1] == Approx(-0.2).margin(0.001));
}

TEST_CASE("posterior mode: a derivative that is no number leaves the search at a number") {
  const PosteriorCost cost{[](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    CHECK(x.allFinite());
    if (gradient != nullptr) *gradient = Eigen::Vector2d(2 * x[0] - 2, x[0] > 0 ? -INFINITY : -1);
    return x[0] * x[0] - 2 * x[0] - x[1];
  }};
  const PosteriorMode mode = search_posterior(cost, Eigen::Vector2d(0, 0), within(4, 2));
  CHECK(mode.at.allFinite());
}

}  // namespace posterior_mode_test

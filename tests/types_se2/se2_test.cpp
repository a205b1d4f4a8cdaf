// SE(2) against its definition: the matrix exponential, the group laws, derivatives by differences.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/types_se2/se2.hpp>

namespace se2_test {

using namespace waymark;

namespace {

constexpr double kPi = std::numbers::pi;

/// The generator of a twist as a 3x3 matrix, whose matrix exponential is the motion.
Eigen::Matrix3d hat(const Eigen::Vector3d& xi) {
  Eigen::Matrix3d m;
  m << 0, -xi[2], xi[0], xi[2], 0, xi[1], 0, 0, 0;
  return m;
}

Eigen::Matrix3d matrix_of(const Pose2<double>& pose) {
  const double c = std::cos(pose.heading);
  const double s = std::sin(pose.heading);
  Eigen::Matrix3d m;
  m << c, -s, pose.position[0], s, c, pose.position[1], 0, 0, 1;
  return m;
}

/// Matrix exponential by scaling and squaring of its series.
Eigen::Matrix3d matrix_exp(const Eigen::Matrix3d& a) {
  const Eigen::Matrix3d small = a / 1024;
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sum = term;
  for (int k = 1; k < 12; ++k) sum += term = term * small / k;
  for (int k = 0; k < 10; ++k) sum = Eigen::Matrix3d(sum * sum);
  return sum;
}

std::vector<Eigen::Vector3d> twists() {
  std::vector<Eigen::Vector3d> result;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-5, 5);
  for (const double theta :
       {0.0, 1e-300, 1e-12, 1e-8, 1e-5, 9.99e-4, 1.001e-3, 0.01, 0.5, 1.0, 2.0, 3.0, 3.14, kPi - 1e-9, kPi}) {
    for (int i = 0; i < 5; ++i) {
      result.emplace_back(place(random), place(random), theta);
      if (theta < kPi) result.emplace_back(place(random), place(random), -theta);
    }
  }
  return result;
}

Eigen::Matrix3d numeric(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& f) {
  constexpr double kStep = 1e-3;
  Eigen::Matrix3d j;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(c);
    j.col(c) = (8 * (f(d) - f(-d)) - (f(2 * d) - f(-2 * d))) / (12 * kStep);
  }
  return j;
}

}  // namespace

TEST_CASE("se2: exp is the matrix exponential") {
  for (const Eigen::Vector3d& xi : twists()) {
    INFO(xi.transpose());
    CHECK((matrix_of(se2_exp<double>(xi)) - matrix_exp(hat(xi))).norm() < 1e-11);
  }
}

TEST_CASE("se2: exp of a vehicle's twist is the arc of its radius") {
  // v = 10 m/s, w = 0.5 rad/s for 1 s: radius 20 m, turned by 0.5 rad.
  const Pose2<double> arc = se2_exp<double>(Eigen::Vector3d(10, 0, 0.5));
  CHECK(arc.position[0] == Approx(20 * std::sin(0.5)).epsilon(1e-15));
  CHECK(arc.position[1] == Approx(20 * (1 - std::cos(0.5))).epsilon(1e-14));
  CHECK(arc.heading == 0.5);
}

TEST_CASE("se2: log inverts exp for all |theta| up to pi") {
  for (const Eigen::Vector3d& xi : twists()) {
    INFO(xi.transpose());
    CHECK((se2_log(se2_exp<double>(xi)) - xi).norm() < 1e-14 * (1 + xi.norm()) * 4);
  }
}

TEST_CASE("se2: log at plus and minus pi: heading pi, both translations those of half a turn") {
  // V(pi)^-1 = [0, pi/2; -pi/2, 0]: from the definition of V, not from code.
  for (const double heading : {kPi, -kPi, 3 * kPi}) {
    const Eigen::Vector3d xi = se2_log(Pose2<double>(2, 3, heading));
    CHECK(xi[2] == Approx(kPi).epsilon(1e-15));
    CHECK(xi[0] == Approx(3 * kPi / 2).epsilon(1e-14));
    CHECK(xi[1] == Approx(-2 * kPi / 2).epsilon(1e-14));
  }
  const Eigen::Vector3d below = se2_log(Pose2<double>(2, 3, -kPi + 1e-12));
  CHECK(below[2] < 0);
  CHECK(below[0] == Approx(-3 * kPi / 2).epsilon(1e-11));
}

TEST_CASE("se2: the series meet the closed forms where they take over") {
  constexpr double kSwitch = detail::kSeriesBelow;
  const double below = std::nextafter(kSwitch, 0.0);
  const Eigen::Vector2d rho(3, -4);
  const auto at = [&](double theta) { return Eigen::Vector3d(rho[0], rho[1], theta); };
  CHECK((se2_exp<double>(at(below)).vector() - se2_exp<double>(at(kSwitch)).vector()).norm() < 1e-15 * 8);
  CHECK((se2_log(Pose2<double>(3, -4, below)) - se2_log(Pose2<double>(3, -4, kSwitch))).norm() < 1e-15 * 8);
  // (theta - sin theta) / theta^2 loses digits in its closed form: 1e-16 / 1e-3 relative to 1.
  CHECK((se2_right_jacobian(at(below)) - se2_right_jacobian(at(kSwitch))).norm() < 1e-11);
  CHECK((se2_right_jacobian_inverse(at(below)) - se2_right_jacobian_inverse(at(kSwitch))).norm() < 1e-11);
}

TEST_CASE("se2: the right Jacobian is the derivative of exp") {
  for (const Eigen::Vector3d& xi : twists()) {
    INFO(xi.transpose());
    const Pose2<double> middle = se2_exp<double>(xi);
    const Eigen::Matrix3d expected = numeric([&](const Eigen::Vector3d& d) {
      return se2_log(between(middle, se2_exp<double>(Eigen::Vector3d(xi + d))));
    });
    CHECK((se2_right_jacobian(xi) - expected).norm() < 1e-10);
  }
}

TEST_CASE("se2: the inverse of the right Jacobian is its inverse, also at pi and beyond") {
  for (Eigen::Vector3d xi : twists()) {
    for (const double factor : {1.0, 1.5}) {
      xi[2] *= factor;
      INFO(xi.transpose());
      const Eigen::Matrix3d product = se2_right_jacobian(xi) * se2_right_jacobian_inverse(xi);
      CHECK((product - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    }
  }
}

TEST_CASE("adjoint: X exp(xi) X^-1 = exp(Ad(X) xi)") {
  const Pose2<double> pose(3, -7, 2.5);
  for (Eigen::Vector3d xi : twists()) {
    INFO(xi.transpose());
    const Eigen::Matrix3d left = matrix_of(pose) * matrix_of(se2_exp<double>(xi)) * matrix_of(inverse(pose));
    const Eigen::Matrix3d right = matrix_of(se2_exp<double>(Eigen::Vector3d(se2_adjoint(pose) * xi)));
    CHECK((left - right).norm() < 1e-12);
  }
}

TEST_CASE("se2: adjoint of a product is the product of adjoints, of an inverse the inverse") {
  const Pose2<double> a(1, 2, 0.3);
  const Pose2<double> b(-4, 1, -2.9);
  CHECK((se2_adjoint(compose(a, b)) - se2_adjoint(a) * se2_adjoint(b)).norm() < 1e-14);
  CHECK((se2_adjoint(inverse(a)) - se2_adjoint(a).inverse()).norm() < 1e-14);
}

TEST_CASE("se2: compose, between and inverse are those of the matrices") {
  const Pose2<double> a(1, 2, 2.3);
  const Pose2<double> b(-4, 1, 1.9);
  CHECK((matrix_of(compose(a, b)) - matrix_of(a) * matrix_of(b)).norm() < 1e-14);
  CHECK((matrix_of(between(a, b)) - matrix_of(a).inverse() * matrix_of(b)).norm() < 1e-14);
  CHECK((matrix_of(inverse(a)) - matrix_of(a).inverse()).norm() < 1e-14);
  CHECK(compose(a, b).heading == Approx(4.2).epsilon(1e-15));  // windings are kept
}

TEST_CASE("wrap_angle: half a turn either way, and the identity inside it to the bit") {
  CHECK(wrap_angle(kPi) == kPi);
  CHECK(wrap_angle(-kPi) == kPi);
  CHECK(wrap_angle(0.1) == 0.1);
  CHECK(wrap_angle(std::nextafter(-kPi, 0)) == std::nextafter(-kPi, 0));
  for (int turns = -1000; turns <= 1000; turns += 7) {
    const double wrapped = wrap_angle(0.25 + turns * 2 * kPi);
    CHECK(wrapped == Approx(0.25).epsilon(1e-11));
  }
  for (double a = -100; a < 100; a += 0.01) {
    const double wrapped = wrap_angle(a);
    REQUIRE(wrapped > -kPi);
    REQUIRE(wrapped <= kPi);
  }
}

}  // namespace se2_test

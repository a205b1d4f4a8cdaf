// Steps that converge linearly, accelerated: theory says in how many steps.
#include <Eigen/Core>
#include <catch2/catch.hpp>

#include <waymark/core/optimize/detail/step_acceleration.hpp>

namespace step_acceleration_test {

using waymark::detail::StepAcceleration;

namespace {

/// Each step goes a share of the way to the minimum, another one in each direction.
Eigen::VectorXd step_at(const Eigen::VectorXd& place, const Eigen::VectorXd& minimum,
                        const Eigen::VectorXd& shares) {
  return shares.cwiseProduct(minimum - place);
}

}  // namespace

TEST_CASE("step acceleration: a linear iteration of three different rates ends with the fourth step") {
  const Eigen::VectorXd minimum = Eigen::VectorXd::LinSpaced(6, 1, 6);
  Eigen::VectorXd shares(6);
  shares << 0.05, 0.3, 0.9, 0.05, 0.3, 0.9;
  const Eigen::VectorXd weights = Eigen::VectorXd::Constant(6, 2);
  StepAcceleration acceleration(6);
  Eigen::VectorXd place = Eigen::VectorXd::Zero(6);
  for (int i = 0; i < 4; ++i) {
    const Eigen::VectorXd step = step_at(place, minimum, shares);
    CHECK(acceleration.accelerate(step, weights) == (i > 0));
    const Eigen::VectorXd& by = i > 0 ? acceleration.accelerated() : step;
    acceleration.moved(by);
    place += by;
  }
  // but for the damping; plain steps leave 0.95^4 of the first direction
  CHECK((place - minimum).norm() < 1e-3 * minimum.norm());
}

TEST_CASE("step acceleration: what was forgotten does not count") {
  StepAcceleration acceleration(2);
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(2);
  CHECK_FALSE(acceleration.accelerate(Eigen::Vector2d(1, 0), weights));
  acceleration.moved(Eigen::Vector2d(1, 0));
  acceleration.begin(Eigen::Vector2d(0, 1));
  acceleration.moved(Eigen::Vector2d(0, 1));
  REQUIRE(acceleration.accelerate(Eigen::Vector2d(0, 0.5), weights));
  CHECK(acceleration.accelerated()[0] == 0);
  CHECK(acceleration.accelerated()[1] ==
        Approx(1));  // half of the way is gone, half is left, and what is left of that is known
  acceleration.reset();
  CHECK_FALSE(acceleration.accelerate(Eigen::Vector2d(0, 0.5), weights));
}

}  // namespace step_acceleration_test

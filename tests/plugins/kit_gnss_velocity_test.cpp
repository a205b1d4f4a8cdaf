// Sensor kit: course and Doppler speed of a GNSS receiver.
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/plugins/gnss_velocity/gnss_velocity.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_gnss_velocity_test {

using namespace waymark;
using namespace waymark::plugins::gnss_velocity;
using namespace waymark_test;
using Catch::Contains;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;
constexpr double kCourseSigma = 1 * kDegree;
constexpr double kSpeedSigma = 0.1;
const Eigen::Vector2d kAntenna(1.2, -0.4);

/// Velocity of the antenna in the body frame: v + w x a.
Eigen::Vector2d antenna_velocity(double speed, double yaw_rate, const Eigen::Vector2d& antenna) {
  return {speed - yaw_rate * antenna[1], yaw_rate * antenna[0]};
}

Pose2<double> moved(const Pose2<double>& pose, double speed, double yaw_rate, double t) {
  return compose(pose, se2_exp<double>(Eigen::Vector3d(speed * t, 0, yaw_rate * t)));
}

Eigen::Vector2d antenna_of(const Pose2<double>& pose) {
  return pose.position + rotate(pose.heading, kAntenna);
}

/// A slowly winding drive whose receiver tells course and speed.
KitDrive drive_with_velocities(const KitRecipe& recipe, std::uint64_t seed) {
  KitDrive drive = make_kit_drive(recipe, seed);
  Noise noise(3000 + seed);
  for (Fix& fix : drive.fixes) {
    const auto node = static_cast<std::size_t>(fix.vertex);
    const Eigen::Vector2d motion = recipe.motion(0.1 * static_cast<double>(node));
    const Eigen::Vector2d velocity = antenna_velocity(motion[0], motion[1], recipe.antenna_m);
    fix.heading_rad =
        wrap_angle(drive.truth[node].heading + std::atan2(velocity[1], velocity[0]) + noise(kCourseSigma));
    fix.heading_sigma_rad = kCourseSigma;
    // The speed is the mean over the two intervals about the fix: the truth at its neighbours.
    const std::size_t from = node > 0 ? node - 1 : 0;
    const std::size_t to = std::min(node + 1, drive.truth.size() - 1);
    const auto place = [&](std::size_t i) {
      return Eigen::Vector2d(drive.truth[i].position + rotate(drive.truth[i].heading, recipe.antenna_m));
    };
    fix.speed_mps = (place(to) - place(from)).norm() / seconds_between(drive.stamps[from], drive.stamps[to]);
    *fix.speed_mps += noise(kSpeedSigma);
    fix.speed_sigma_mps = kSpeedSigma;
  }
  return drive;
}

KitRecipe winding() {
  KitRecipe recipe;
  recipe.fix_sigma_m = 10;
  recipe.antenna_m = kAntenna;
  recipe.motion = [](double t) { return Eigen::Vector2d(10, 0.1 * std::sin(0.2 * t)); };
  return recipe;
}

}  // namespace

TEST_CASE("gnss_velocity: the course is that of the turning antenna, forwards and backwards") {
  // Against the way of the antenna over a millisecond about the moment, in a left and a right turn.
  for (const double speed : {10.0, 1.0, -5.0}) {
    for (const double yaw_rate : {0.5, -0.3, 0.0}) {
      INFO(speed << " m/s, " << yaw_rate << " rad/s");
      const Pose2<double> pose(3, -4, 2.9);
      const Eigen::Vector2d way =
          antenna_of(moved(pose, speed, yaw_rate, 5e-4)) - antenna_of(moved(pose, speed, yaw_rate, -5e-4));
      const EdgeGnssCourse edge{std::atan2(way[1], way[0]), speed, yaw_rate, kAntenna};
      CHECK(edge.error(pose)[0] == Approx(0).margin(1e-7));
    }
  }
  // By hand: v = 10, w = 0.5, antenna 1.2 ahead and 0.4 to the right: (10.2, 0.6) in the body frame.
  CHECK(EdgeGnssCourse{0, 10, 0.5, kAntenna}.slip() == Approx(std::atan2(0.6, 10.2)));
  CHECK(EdgeGnssCourse{0, -5, 0, kAntenna}.slip() == Approx(kPi));
  // The vehicle heads 0.1 rad further left than the course says.
  CHECK(EdgeGnssCourse{1.0, 10, 0, kAntenna}.error(Pose2<double>(0, 0, 1.1))[0] == Approx(0.1));
}

TEST_CASE("gnss_velocity: the speed is the antenna's way over time") {
  // 1 m in 0.1 s is 1 m/s faster than the 9 m/s that were measured: 0.1 m.
  const EdgeGnssSpeed slow{9, 0.1, {0, 0}};
  CHECK(slow.error(Pose2<double>(2, 3, kPi / 2), Pose2<double>(2, 4, kPi / 2))[0] == Approx(0.1));
  // Turning left, an antenna on the right is faster than the body; the chord is (w dt)^2 / 24 shorter.
  const Pose2<double> from(3, -4, 2.9);
  const double true_speed = antenna_velocity(10, 0.5, kAntenna).norm();
  CHECK(true_speed > 10.2);
  const EdgeGnssSpeed turning{true_speed, 0.1, kAntenna};
  const double chord = -true_speed * 0.1 * std::pow(0.05, 2) / 24;
  CHECK(turning.error(from, moved(from, 10, 0.5, 0.1))[0] == Approx(chord).epsilon(1e-3));
  // A vehicle that did not move: no direction, no derivative, no NaN.
  const Dual<3> zero(0.0);
  const Pose2<Dual<3>> at{Dual<3>::variable(1, 0), Dual<3>::variable(2, 1), Dual<3>::variable(3, 2)};
  CHECK(slow.error(at, at)[0].derivative.isZero());
}

TEST_CASE("gnss_velocity: n courses add n / sigma^2 to the information on a stiff drive's heading") {
  constexpr int kSeeds = 40;
  double normalised = 0;
  double squared_without = 0;
  double squared_with = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    KitDrive without = drive_with_velocities(winding(), seed);
    KitDrive with = without;
    with.add_sensor("gnss_velocity", {}, {{"speed", "off"}});
    REQUIRE(edges_of(with.graph, "EDGE_GNSS_COURSE") == 61);
    CHECK(edges_of(with.graph, "EDGE_GNSS_SPEED") == 0);
    const Solution before = solve(without);
    const Solution after = solve(with);
    const double expected = std::pow(before.sigma(300, 2), -2) + 61 / (kCourseSigma * kCourseSigma);
    CHECK(std::pow(after.sigma(300, 2), -2) == Approx(expected).epsilon(0.02));
    normalised += after.normalised(300);
    squared_without += std::pow(before.rms_heading(), 2);
    squared_with += std::pow(after.rms_heading(), 2);
  }
  check_mean_chi_square(normalised, 3, kSeeds);
  CHECK(squared_with < squared_without / 4);
}

TEST_CASE("gnss_velocity: Doppler speeds calibrate the odometry's scale") {
  KitRecipe recipe = winding();
  recipe.speed_scale = 0.03;
  constexpr int kSeeds = 40;
  double squared_without = 0;
  double squared_with = 0;
  double state = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    KitDrive without = drive_with_velocities(recipe, seed);
    KitDrive with = without;
    with.add_sensor("gnss_velocity", {}, {{"course", "off"}});
    REQUIRE(edges_of(with.graph, "EDGE_GNSS_SPEED") == 61);
    const VertexIndex scale = find_state(without.graph, "VERTEX_SPEED_SCALE");
    const auto estimate = [&](KitDrive& drive) {
      (void)solve(drive);
      const double variance = marginal_covariances(drive.graph, std::array{scale})[0](0, 0);
      return std::pair(drive.graph.value(scale)[0] - recipe.speed_scale, variance);
    };
    const auto [error_without, variance_without] = estimate(without);
    const auto [error_with, variance_with] = estimate(with);
    // Each speed v' over T says the scale to (sigma T)^2 + q v T, divided by the way v T that the odometry
    // read; 59 of them over two intervals, those at the ends over one.
    const double reading = 10 / 1.03;
    const auto of_one = [&](double time) {
      const double way = reading * time;
      const double noise = recipe.noise.longitudinal_per_m * way + recipe.noise.position_per_s * time;
      return way * way / (std::pow(kSpeedSigma * time, 2) + noise);
    };
    const double expected = 1 / variance_without + 59 * of_one(0.2) + 2 * of_one(0.1);
    CHECK(1 / variance_with == Approx(expected).epsilon(0.05));
    squared_without += error_without * error_without;
    squared_with += error_with * error_with;
    state += error_with * error_with / variance_with;
  }
  CHECK(squared_with < squared_without / 3);
  check_mean_chi_square(state, 1, kSeeds);
}

TEST_CASE("gnss_velocity: slow moments are passed over and a receiver that tells nothing is an error") {
  KitRecipe recipe = winding();
  recipe.motion = [](double t) { return Eigen::Vector2d(t < 30 ? 10 : 2, 0); };
  KitDrive drive = drive_with_velocities(recipe, 1);
  drive.add_sensor("gnss_velocity", {});
  CHECK(edges_of(drive.graph, "EDGE_GNSS_COURSE") == 30);
  CHECK(edges_of(drive.graph, "EDGE_GNSS_SPEED") == 30);
  KitDrive silent = make_kit_drive(recipe, 1);
  CHECK_THROWS_WITH(silent.add_sensor("gnss_velocity", {}),
                    "no accepted fix has a course or a speed; does the gnss log have columns 'course' and "
                    "'speed'?");
  CHECK_THROWS_WITH(silent.add_sensor("gnss_velocity", {}, {{"course", "off"}, {"speed", "off"}}),
                    Contains("course and speed are both off"));
}

}  // namespace kit_gnss_velocity_test

// Drives that were read in a wrong unit or sense are named with what mends them; poor ones are not.
#include <cmath>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/comparison/misreading.hpp>
#include <waymark/types_se2/se2.hpp>

namespace misreading_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct Way {
  double speed_mps = 10;
  double turn_radps = 0.2;  ///< to and fro, for 5 s each
  double gyro_noise = 0;    ///< rad/sqrt(s)
  double gyro_bias = 0;     ///< rad/s
  double fix_noise_m = 0;   ///< per axis
  int seconds = 200;
  unsigned seed = 1;
  Eigen::Matrix2d written = Eigen::Matrix2d::Identity();  ///< what became of the positions
};

/// A drive with odometry at 10 Hz and fixes at 1 Hz. What is read is a factor of the truth.
std::optional<std::string> found(double speed_factor, double yaw_factor, const Way& way = {},
                                 const std::optional<GeodeticPoint>& place = {}) {
  std::mt19937_64 random(way.seed);
  std::normal_distribution<double> normal;
  std::vector<OdometrySample> odometry;
  std::vector<Fix> fixes;
  Pose2<double> truth;
  for (int k = 0; k <= 10 * way.seconds; ++k) {
    const Stamp stamp = Stamp::from_seconds(0.1 * k);
    const double turn = k / 50 % 2 == 0 ? way.turn_radps : -way.turn_radps;
    const double noise = way.gyro_noise * std::sqrt(10) * normal(random);
    odometry.push_back({stamp, way.speed_mps * speed_factor, (turn + way.gyro_bias + noise) * yaw_factor});
    if (k % 10 == 0) {
      Fix fix;
      fix.stamp = stamp;
      fix.position =
          way.written * (truth.position + way.fix_noise_m * Eigen::Vector2d(normal(random), normal(random)));
      fixes.push_back(fix);
    }
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(0.1 * way.speed_mps, 0, 0.1 * turn)));
  }
  return find_misreading(build_timeline(odometry, fixes, {}), fixes, 0.01, place);
}

std::string sentence(double speed_factor, double yaw_factor, const Way& way = {}) {
  const std::optional<std::string> misreading = found(speed_factor, yaw_factor, way);
  return misreading.value_or("");
}

}  // namespace

TEST_CASE("misreading: a drive that was read right is not doubted, whatever its scale and bias") {
  CHECK_FALSE(found(1, 1));
  CHECK_FALSE(found(1.1, 0.9));
  CHECK_FALSE(found(1, 1, {.turn_radps = 0}));
}

TEST_CASE("misreading: neither a poor gyro nor poor fixes are mended by a unit") {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    for (const double turn_radps : {0.0, 0.02, 0.2}) {
      INFO("seed " << seed << ", turns of " << turn_radps << " rad/s");
      CHECK_FALSE(found(1, 1, {.turn_radps = turn_radps, .gyro_noise = 0.1, .seed = seed}));
      CHECK_FALSE(found(1, 1, {.turn_radps = turn_radps, .fix_noise_m = 15, .seed = seed}));
      const Way slow{
          .speed_mps = 1, .turn_radps = turn_radps, .fix_noise_m = 5, .seconds = 600, .seed = seed};
      CHECK_FALSE(found(1, 1, slow));
    }
  }
}

TEST_CASE("misreading: the unit of the speed is named") {
  CHECK_THAT(sentence(3.6, 1),
             Catch::EndsWith("speeds divided by 3.6 (km/h read as m/s: state 'unit: km/h' of the "
                             "speed)"));
  CHECK_THAT(sentence(1 / 3.6, 1), Catch::Contains("(m/s read as km/h: state 'unit: m/s' of the speed)"));
  CHECK_THAT(sentence(1 / 0.44704, 1), Catch::Contains("'unit: mph'"));
  CHECK_THAT(sentence(3600.0 / 1852, 1), Catch::Contains("'unit: kn'"));
}

TEST_CASE("misreading: a factor that is no unit is a matter of calibration, unless no odometry has it") {
  for (const double factor : {0.5, 0.7, 0.8, 1.25, 1.33, 1.45, 1.7, 2.0, 2.5}) {
    INFO("factor " << factor);
    CHECK_FALSE(found(factor, 1, {}, GeodeticPoint{48, 11}));
  }
  CHECK_THAT(sentence(6, 1), Catch::EndsWith("speeds divided by 6 (check their column and unit)"));
  CHECK_THAT(sentence(1000, 1), Catch::Contains("'unit: mm/s'"));
}

TEST_CASE("misreading: the bias of a gyro is no unit either") {
  for (const double bias : {-0.1, 0.05, 0.1, 0.2}) {
    INFO("bias " << bias);
    CHECK_FALSE(found(1, 1, {.gyro_bias = bias}));
  }
  CHECK_THAT(sentence(1, -1, {.gyro_bias = 0.02}), Catch::Contains("'convention: cw'"));
}

TEST_CASE("misreading: unit and sense of the yaw rate are named, and with the speed") {
  CHECK_THAT(sentence(1, kDegrees),
             Catch::EndsWith("with yaw rates divided by 57.3 (deg/s read as rad/s: state "
                             "'unit: deg/s' of the yaw rate)"));
  CHECK_THAT(sentence(1, 1 / kDegrees), Catch::Contains("'unit: rad/s'"));
  CHECK_THAT(sentence(1, -1),
             Catch::EndsWith("with the yaw rate positive clockwise (state 'convention: cw' of the "
                             "yaw rate)"));
  const std::string all = sentence(3.6, -kDegrees);
  CHECK_THAT(all, Catch::Contains("'unit: km/h'") && Catch::Contains("'unit: deg/s'") &&
                      Catch::Contains("'convention: cw'"));
}

TEST_CASE("misreading: a gyro that turns in the wrong sense is told through its noise") {
  const Way noisy{.gyro_noise = 0.03, .fix_noise_m = 2};
  CHECK_THAT(sentence(1, -1, noisy), Catch::Contains("'convention: cw'"));
  CHECK_THAT(sentence(1, kDegrees, noisy), Catch::Contains("'unit: deg/s'"));
}

TEST_CASE("misreading: fixes that jump to and fro are no unit of an odometry that curls up") {
  // 0.05 rad/s are 164 degrees from fix to fix, if they were deg/s.
  std::vector<OdometrySample> odometry;
  std::vector<Fix> fixes;
  for (int k = 0; k <= 60; ++k) {
    odometry.push_back({Stamp::from_seconds(k), 10, 0.05});
    Fix fix;
    fix.stamp = Stamp::from_seconds(k);
    fix.position = {10.0 * k, k % 2 == 0 ? 200 : -200};
    fixes.push_back(fix);
  }
  CHECK_FALSE(find_misreading(build_timeline(odometry, fixes, {.gap_s = 5}), fixes, 0.01, {}));
}

TEST_CASE("misreading: a straight road does not show the sense of a yaw rate, and a short one nothing") {
  CHECK_FALSE(found(1, -1, {.turn_radps = 0}));
  CHECK_FALSE(found(1, -1, {.turn_radps = 1e-4}));
  CHECK_FALSE(found(3.6, -1, {.seconds = 20}));
}

TEST_CASE("misreading: coordinates that were written wrong are named, where the drive's place is known") {
  Eigen::Matrix2d mirrored = Eigen::Vector2d(-1, 1).asDiagonal();
  const std::optional<std::string> mirror = found(1, 1, {.written = mirrored}, GeodeticPoint{40, 80});
  REQUIRE(mirror);
  CHECK_THAT(*mirror, Catch::Contains("'convention: cw'") &&
                          Catch::Contains("the sign of a longitude (W) or latitude (S) is lost"));
  // Exchanged at 60 degrees north: 1 m east is written as 2 m north.
  const auto exchanged_at = [](double latitude_deg, double longitude_deg) {
    Eigen::Matrix2d exchanged;
    exchanged << 0, std::cos(longitude_deg / kDegrees), 1 / std::cos(latitude_deg / kDegrees), 0;
    return found(1, 1, {.written = exchanged}, GeodeticPoint{longitude_deg, latitude_deg});
  };
  const std::optional<std::string> far = exchanged_at(60, 10);
  REQUIRE(far);
  CHECK_THAT(*far, Catch::EndsWith("if latitude and longitude are exchanged"));
  // Near the equator this is a mirror.
  const std::optional<std::string> near = exchanged_at(10, 10);
  REQUIRE(near);
  CHECK_THAT(*near, Catch::Contains("'convention: cw'") &&
                        Catch::Contains("unless latitude and longitude are exchanged"));
}

TEST_CASE("misreading: a gyro of a wrong scale is a matter of calibration, not of units") {
  for (const double factor : {0.3, 0.7, 1.4, 2.5}) {
    INFO("turns " << factor << " times those of the vehicle");
    CHECK(sentence(1, factor, {.seconds = 400}).empty());
    CHECK(sentence(1, factor, {.fix_noise_m = 1, .seconds = 400}).empty());
  }
}

}  // namespace misreading_test

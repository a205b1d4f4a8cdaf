#include <catch2/catch.hpp>

#include <limits>
#include <numbers>

#include <waymark/tools/drive/logs/velocity.hpp>

namespace velocity_test {

using namespace waymark;
using namespace waymark::drive;

TEST_CASE("velocity: a log of its own gives fixes speed and course, the course the short way round north") {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kDegree = std::numbers::pi / 180;
  SensorTable readings;
  readings.columns = 4;
  for (int i = 0; i < 5; ++i) readings.stamps.push_back(Stamp::from_seconds(i));
  readings.values = {10,    0.1, 358 * kDegree, kNone, 12,    0.1, 2 * kDegree, kNone, 14,   0.1, 6 * kDegree,
                     kNone, 16,  0.1,           kNone, kNone, 18,  0.1,         kNone, kNone};
  std::vector<GeodeticFix> fixes(3);
  fixes[0].stamp = Stamp::from_seconds(0.5);
  fixes[1].stamp = Stamp::from_seconds(3.5);
  fixes[2].stamp = Stamp::from_seconds(9);  // long after the last reading
  CHECK(add_velocity(readings, fixes) == 2);
  CHECK(*fixes[0].speed_mps == Approx(11));
  CHECK(*fixes[0].speed_sigma_mps == Approx(0.1));
  CHECK(*fixes[0].course_rad == Approx(0).margin(1e-12));
  CHECK(*fixes[1].speed_mps == Approx(17));
  CHECK_FALSE(fixes[1].course_rad.has_value());
  CHECK_FALSE(fixes[2].speed_mps.has_value());
}

}  // namespace velocity_test

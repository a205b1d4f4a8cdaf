// Which motion of a receiver tells its clock: its own velocity, unless that lags behind its positions.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include <waymark/tools/drive/clocks/gnss_motion.hpp>

namespace gnss_motion_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

/// 5 minutes at 1 Hz on a straight road, exact to 0.3 m. The speed is 10 + 4 sin(0.2 t) m/s, and is told late.
std::vector<Fix> fixes_with(double lag_s) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.3);
  std::vector<Fix> fixes;
  for (int t = 0; t < 300; ++t) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(t);
    fix.position = {10 * t + 20 * (1 - std::cos(0.2 * t)) + noise(random), noise(random)};
    fix.speed_mps = 10 + 4 * std::sin(0.2 * (t - lag_s));
    fix.heading_rad = 0;
    fixes.push_back(fix);
  }
  return fixes;
}

}  // namespace

TEST_CASE("gnss motion: speeds that lag behind the positions are found, and the positions are taken") {
  for (const double lag_s : {0.6, 1.0, 2.0, -0.8}) {
    const std::vector<Fix> fixes = fixes_with(lag_s);
    INFO(lag_s);
    CHECK(velocity_lags(of_one_receiver(fixes)));
    CHECK(receiver_motion(of_one_receiver(fixes)).speeds.source == "distance between fixes");
    CHECK(receiver_motion(of_one_receiver(fixes)).turns.source == "angle between fixes");
  }
}

TEST_CASE("gnss motion: speeds on time are better than chords") {
  const std::vector<Fix> fixes = fixes_with(0);
  CHECK_FALSE(velocity_lags(of_one_receiver(fixes)));
  CHECK(receiver_motion(of_one_receiver(fixes)).speeds.source == "receiver's speed");
  CHECK(receiver_motion(of_one_receiver(fixes)).turns.source == "receiver's course");
}

}  // namespace gnss_motion_test

// Fixes that are elsewhere from a moment on, for good: the drive does not know which side is right, and says so.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/trials/lasting_jump.hpp>

#include "receivers_scene.hpp"

namespace lasting_jump_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

std::string told(const FusedDrive& fused) {
  return warning_with(" m elsewhere", fused);
}

/// Returns the size that is told, m; 0: nothing is told.
double told_size_m(const FusedDrive& fused) {
  const std::string warning = told(fused);
  const std::string before = " lie ";
  const auto place = warning.find(before);
  return place == std::string::npos ? 0 : std::stod(warning.substr(place + before.size()));
}

}  // namespace

TEST_CASE("lasting jump: it is told, the result lies between both sides, and its covariances contain both") {
  const ReceiversScene jumping = receivers_scene({{.jump_m = {12, -9}}}, 3);
  const FusedDrive result = fused(jumping);
  CHECK_THAT(told(result), Catch::StartsWith("the fixes of 'gnss' lie ") &&
                               Catch::Contains("from 239.0 s after the first fix on"));
  CHECK(told_size_m(result) == Approx(15).margin(2));
  const auto [rms_m, inside] = result_of(result, jumping);
  // half the jump, and what fixes are off in the mean; with all fixes alike it is 15 m / sqrt(2)
  CHECK(rms_m < 9.5);
  CHECK(inside > 0.9);
}

TEST_CASE("lasting jump: half a metre of fixes that are good to centimetres, at the very fix") {
  const ReceiversScene jumping = receivers_scene(
      {{.white_m = 0.012, .lasting_m = 0.01, .jump_m = {0.3, 0.4}, .jumps_at_s = 299.95}}, 4, 2);
  const FusedDrive result = fused(jumping);
  CHECK(told_size_m(result) == Approx(0.5).margin(0.03));
  for (const Fix& fix : result.model.placed.fixes)
    CHECK(fix.level == (seconds_between(Stamp::from_seconds(1000), fix.stamp) > 299.95 ? 1 : 0));
  CHECK(result_of(result, jumping).inside > 0.9);
}

TEST_CASE("lasting jump: another receiver that does not jump tells which side is right") {
  const ReceiversScene alone = receivers_scene({{}}, 5);
  const ReceiversScene both = receivers_scene({{.jump_m = {-8, 14}}, {.name = "other"}}, 5);
  const FusedDrive result = fused(both);
  CHECK(told_size_m(result) == Approx(16).margin(2));
  CHECK(result_of(result, both).rms_m < 1.5 * result_of(fused(alone), alone).rms_m);
}

TEST_CASE("lasting jump: reflections of a minute are none") {
  ReceiversScene reflected = receivers_scene({{}}, 3);
  for (Fix& fix : reflected.drive.fixes) {
    const double t = seconds_between(Stamp::from_seconds(1000), fix.stamp);
    if (t >= 240 && t < 300) fix.position += Eigen::Vector2d(7, -5);
  }
  CHECK(told(fused(reflected)).empty());
}

TEST_CASE("lasting jump: fixes that do not jump have none, nor has one at an end of the drive") {
  for (std::uint64_t seed = 10; seed < 16; ++seed) CHECK(told(fused(receivers_scene({{}}, seed))).empty());
  CHECK(told(fused(receivers_scene({{.jump_m = {12, 9}, .jumps_at_s = 450}}, 3))).empty());
}

TEST_CASE("lasting jump: the slow errors of each side are half as large as the larger jump beside it") {
  std::vector<Fix> fixes(4);
  for (std::size_t i = 0; i < fixes.size(); ++i)
    fixes[i].stamp = Stamp::from_seconds(100.0 * static_cast<double>(i));
  fixes[3].source = 1;
  const std::vector<LastingJump> jumps = {{0, Stamp::from_seconds(150), {0, 20}},
                                          {0, Stamp::from_seconds(50), {6, 8}}};
  take_jumps(jumps, fixes);
  CHECK(fixes[0].level == 0);
  CHECK(fixes[0].jump_sigma_m == 5);
  CHECK(fixes[1].level == 1);
  CHECK(fixes[1].jump_sigma_m == 10);
  CHECK(fixes[2].level == 2);
  CHECK(fixes[2].jump_sigma_m == 10);
  CHECK(fixes[3].level == 0);
  CHECK(fixes[3].jump_sigma_m == 0);
}

}  // namespace lasting_jump_test

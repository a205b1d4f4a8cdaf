// Receivers that err alike do not confirm each other: they are found, and taken for a group.
#include <cstdint>

#include <catch2/catch.hpp>

#include "receivers_scene.hpp"

namespace common_errors_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

/// Two receivers with errors of 3 m that last for 40 s. @param are_common whether both have the same
ReceiversScene scene(bool are_common, std::uint64_t seed) {
  const SceneReceiver front{.name = "front", .white_m = 0.5, .lasting_m = 3, .lasting_s = 40};
  SceneReceiver rear = front;
  rear.name = "rear";
  rear.errs_as_first = are_common;
  return receivers_scene({front, rear}, seed);
}

bool is_told(const FusedDrive& fused) {
  return !warning_with("receivers err alike, 'rear' as 'front' does", fused).empty();
}

}  // namespace

TEST_CASE("common errors: two receivers that err alike are told, and are as if 'common' were stated") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const ReceiversScene alike = scene(true, seed);
    const FusedDrive found = fused(alike);
    CHECK(is_told(found));
    CHECK(result_of(found, alike).inside > 0.9);
    FusionSettings stated;
    stated.sources["rear"].common = "front";
    const FusedDrive as_stated = fused(alike, stated);
    CHECK_FALSE(is_told(as_stated));
    CHECK(found.model.settings.sources.at("rear").common == "front");
    CHECK(found.minimum.summary.final_chi2 == Approx(as_stated.minimum.summary.final_chi2).epsilon(0.01));
  }
}

TEST_CASE("common errors: receivers with errors of their own are no group") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    CHECK_FALSE(is_told(fused(scene(false, seed))));
  }
}

TEST_CASE("common errors: what is stated for a receiver alone is left as it is") {
  FusionSettings stated;
  stated.sources["rear"].options["white_sigma"] = "0.5";
  CHECK_FALSE(is_told(fused(scene(true, 1), stated)));
}

}  // namespace common_errors_test

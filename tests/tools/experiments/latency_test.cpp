// How late the fixes are: found without bias and with a true sigma, whatever the gyro, and no free place for
// the errors of fixes.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/tools/drive/estimation/latency.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/simulation/simulation.hpp>

#include "support/registry.hpp"
#include "tools/experiments/simulated.hpp"

namespace latency_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::simulation;
using namespace waymark_test;

namespace {

/// A motorway, or streets, with a gyro whose heading walks by so much in the root of a second.
SimulatedDrive make_drive(const char* preset, double yaw_noise, double delay_s, std::uint64_t seed) {
  SimulationRecipe recipe = with_duration(simulation_preset(preset).recipe, 300);
  recipe.odometry.yaw_rate_noise_radps = yaw_noise * std::sqrt(recipe.odometry.rate_hz);
  recipe.gnss.delay_s = delay_s;
  return simulate(recipe, seed);
}

/// The only time offset that a drive estimates.
std::optional<VertexIndex> offset_in(const formats::GraphDocument& document) {
  const auto count = static_cast<std::int64_t>(document.graph.vertex_count());
  const std::vector<formats::VertexRange> all{
      {document.graph.id(0), document.graph.id(static_cast<VertexIndex>(count - 1))}};
  return time_offset_vertex(document.graph, all);
}

struct Found {
  double offset_s = 0;
  double sigma_s = 0;
  double raw_rmse_m = 0;
  double fused_rmse_m = 0;
};

Found fuse_late_fixes(const SimulatedDrive& simulated, const PreparedDrive& drive) {
  FusionSettings settings;
  settings.modeling_options["time_offset"] = "constant";  // stated, so that the odds do not leave it out
  const FusedDrive fused = fuse(drive, settings, registry());
  REQUIRE(fused.minimum.summary.converged());
  const formats::GraphDocument& document = fused.model.document;
  const evaluation::Evaluation result = evaluation::evaluate(against_truth(document, simulated));
  const std::vector<VertexIndex> offset{offset_in(document).value()};
  return {document.graph.value(offset[0])[0],
          std::sqrt(marginal_covariances(document.graph, offset)[0](0, 0)),
          result.truth->gnss.position.rmse_m, result.truth->fused.position.rmse_m};
}

}  // namespace

TEST_CASE("latency: found within its sigma under good and poor gyros, and never worse than the fixes") {
  double squares = 0;
  int drives = 0;
  for (const char* preset : {"highway", "urban"}) {
    for (const double yaw_noise : {5e-4, 0.033}) {
      for (const double delay_s : {-0.8, 0.0, 0.3, 1.0}) {
        const auto seed = static_cast<std::uint64_t>(100 + drives);
        const SimulatedDrive simulated = make_drive(preset, yaw_noise, delay_s, seed);
        const Found found = fuse_late_fixes(simulated, prepared(simulated));
        INFO(preset << ", yaw noise " << yaw_noise << ", delay " << delay_s << ": " << found.offset_s
                    << " +- " << found.sigma_s << " s, " << found.raw_rmse_m << " -> " << found.fused_rmse_m
                    << " m");
        CHECK(found.fused_rmse_m < 1.05 * found.raw_rmse_m);  // a constant bias stays with both
        CHECK(found.sigma_s < 0.15);                          // half of its prior
        squares += std::pow((found.offset_s - delay_s) / found.sigma_s, 2);
        ++drives;
      }
    }
  }
  // 1e-4 and 1 - 1e-4 of chi-square with 16 degrees of freedom.
  CHECK(squares > 2.9);
  CHECK(squares < 45.9);
}

TEST_CASE("latency: moving a receiver's clock by a second moves the offset by a second, and nothing else") {
  const SimulatedDrive simulated = make_drive("urban", 2e-3, 0, 7);
  const Found before = fuse_late_fixes(simulated, prepared(simulated));
  PreparedDrive moved = prepared(simulated);
  for (Fix& fix : moved.fixes) fix.stamp.nanoseconds += 1'000'000'000;
  while (moved.fixes.back().stamp > moved.odometry.back().stamp) moved.fixes.pop_back();
  const Found after = fuse_late_fixes(simulated, moved);
  // The prior of 0.3 s pulls both towards 0, each by the share of its information.
  const double pulled = std::pow(after.sigma_s / 0.3, 2);
  CHECK(after.offset_s - before.offset_s == Approx(1 - pulled).margin(0.5 * before.sigma_s));
  CHECK(after.sigma_s == Approx(before.sigma_s).epsilon(0.1));
}

TEST_CASE("latency: the odds of no delay are the ratio of its densities after and before the drive") {
  // Normal densities at 0: exp(-2) / 0.02 over 1 / 0.3.
  CHECK(TimeOffset{0.04, 0.02, 0.3}.odds_of_none() == Approx(15 * std::exp(-2.0)));
  CHECK(TimeOffset{0, 0.3, 0.3}.odds_of_none() == Approx(1));  // the drive says nothing
  CHECK(TimeOffset{0, 0.02, 0}.odds_of_none() == 0);           // a modeling without a stated prior
}

TEST_CASE("latency: fixes that are not late get no offset, late ones do, and it is said") {
  const auto offset_of = [](double delay_s, const FusionSettings& settings) {
    return fuse(prepared(make_drive("urban", 5e-4, delay_s, 11)), settings, registry()).model;
  };
  const ModeledDrive in_time = offset_of(0, {});
  CHECK_FALSE(offset_in(in_time.document).has_value());
  REQUIRE(in_time.notes.size() == 1);
  CHECK(in_time.notes[0].starts_with("the fixes are taken as not late"));
  const ModeledDrive late = offset_of(0.5, {});
  CHECK(offset_in(late.document).has_value());
  CHECK(late.notes.empty());
  FusionSettings stated;
  stated.calibration = Options{{"time_offset", "constant"}};
  CHECK(offset_in(offset_of(0, stated).document).has_value());

  CHECK_FALSE(in_time.notes[0].ends_with("to the covariances"));

  // A straight way at an even speed tells nothing of a delay: what that leaves open is said.
  SimulationRecipe straight = with_duration(simulation_preset("highway").recipe, 120);
  for (RoadRecipe& road : straight.roads) road.speed_wander = road.bend_sigma_deg = 0;
  PreparedDrive drive = prepared(simulate(straight, 11));
  const Stamp even = drive.odometry.front().stamp.later(60);  // at its speed
  std::erase_if(drive.odometry, [&](const OdometrySample& sample) { return sample.stamp < even; });
  std::erase_if(drive.fixes, [&](const Fix& fix) { return fix.stamp < even; });
  const ModeledDrive blind = fuse(drive, {}, registry()).model;
  REQUIRE(blind.notes.size() == 1);
  CHECK(blind.notes[0].ends_with("m along the way that this leaves open to the covariances"));
}

}  // namespace latency_test

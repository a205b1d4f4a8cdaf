/// Simulated drives in memory, as if they had been written and read.
#pragma once

#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/logs/projection.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark_test {

[[nodiscard]] inline waymark::drive::PreparedDrive prepared(
    const waymark::simulation::SimulatedDrive& simulated) {
  waymark::drive::PreparedDrive drive;
  drive.frame = simulated.frame;
  const waymark::drive::Projection projection(simulated.frame);
  drive.odometry = simulated.odometry;
  for (const waymark::simulation::SimulatedFix& fix : simulated.fixes) {
    drive.fixes.push_back(projection.project(fix.fix));
    drive.fixes.back().epoch = static_cast<int>(drive.fixes.size()) - 1;
  }
  for (const waymark::GeodeticTruth& truth : simulated.truth)
    drive.truth.push_back(projection.project(truth));
  return drive;
}

/// The fused poses at the fixes against the exact truth.
[[nodiscard]] inline waymark::evaluation::EvaluationInput against_truth(
    const waymark::formats::GraphDocument& document, const waymark::simulation::SimulatedDrive& simulated) {
  waymark::evaluation::EvaluationInput input;
  input.fused = waymark::drive::poses_at_fixes(document);
  input.fixes = document.fixes;
  input.truth = waymark::evaluation::truth_from_poses(simulated.poses);
  return input;
}

/// One straight road without end, driven at 20 m/s.
[[nodiscard]] inline waymark::simulation::RoadRecipe straight_road() {
  waymark::simulation::RoadRecipe road;
  road.cruise_min_mps = road.cruise_max_mps = 20;
  road.speed_wander = 0;
  road.bend_sigma_deg = 0;
  road.corner_probability = 0;
  road.stop_probability = 0;
  return road;
}

}  // namespace waymark_test

/// Simulated drives in memory, as if they had been written and read.
#pragma once

#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
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

/// All sources of a simulated drive, as if their logs had been read.
/// @param period_s to which the fixes of each receiver are thinned; 0: all are kept
[[nodiscard]] inline waymark::drive::PreparedDrive prepared_sources(
    const waymark::simulation::SimulatedDrive& simulated, double period_s) {
  using namespace waymark::drive;
  DriveLogs logs;
  DriveDescription description;
  description.time_scale = waymark::TimeScale::gps;
  const auto add_odometry = [&](const std::string& name,
                                const std::vector<waymark::OdometrySample>& samples) {
    DriveLogs::Log log;
    log.file = name;
    log.data.odometry = samples;
    logs.odometry.push_back({log});
    description.odometry.emplace_back().name = name;
  };
  const auto add_gnss = [&](const waymark::simulation::GnssRecipe& recipe,
                            const std::vector<waymark::simulation::SimulatedFix>& fixes) {
    DriveLogs::Log log;
    log.file = recipe.name;
    for (const waymark::simulation::SimulatedFix& fix : fixes) {
      log.data.fixes.push_back(fix.fix);
      log.data.fixes.back().source = static_cast<int>(logs.gnss.size());
    }
    logs.gnss.push_back(log);
    GnssConfig& receiver = description.gnss.emplace_back();
    receiver.name = recipe.name;
    receiver.antenna_m = recipe.antenna_m;
    receiver.period_s = period_s;
  };
  add_odometry(simulated.recipe.odometry.name, simulated.odometry);
  for (const waymark::simulation::SimulatedOdometry& further : simulated.further_odometry)
    add_odometry(further.name, further.samples);
  add_gnss(simulated.recipe.gnss, simulated.fixes);
  for (std::size_t i = 0; i < simulated.further_gnss.size(); ++i)
    add_gnss(simulated.recipe.further_gnss[i], simulated.further_gnss[i].fixes);
  logs.truth.emplace_back();
  logs.truth.back().data.truth = simulated.truth;
  return prepare_drive(logs, description);
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

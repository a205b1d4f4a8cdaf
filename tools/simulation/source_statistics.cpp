#include <waymark/tools/simulation/source_statistics.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/evaluation/numbers/truth_interpolation.hpp>

namespace waymark::simulation {
namespace {

double availability_percent(std::size_t readings, double duration_s, double first_s, double rate_hz) {
  // A reading is due at first_s, and none at the very end; a tenth of a tick is for rounding.
  const double due = std::ceil((duration_s - first_s - 1e-3) * rate_hz);
  return due > 0 ? 100 * static_cast<double>(readings) / due : 0;
}

double position_rms(const SimulatedDrive& drive, const std::vector<SimulatedFix>& fixes,
                    const Eigen::Vector2d& antenna_m) {
  if (fixes.empty()) return evaluation::kUndefined;
  const drive::Projection projection(drive.frame);
  std::vector<Stamp> stamps;
  for (const SimulatedFix& fix : fixes) stamps.push_back(fix.fix.stamp);
  const evaluation::TruthMatch match =
      evaluation::interpolate_truth(evaluation::truth_from_poses(drive.poses), stamps);
  std::vector<Eigen::Vector2d> offsets;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (!match.at[i]) continue;
    const TruthPose& body = match.at[i]->pose;
    const Fix fix = projection.project(fixes[i].fix);
    const Eigen::Vector2d antenna =
        body.position + fix.grid_scale * (Eigen::Rotation2Dd(*body.heading_rad) * antenna_m);
    offsets.push_back(fix.position - antenna);
  }
  return evaluation::position_metrics(offsets).rmse_m;
}

SourceStatistics judge_source(const SimulatedDrive& drive, const OdometryRecipe& recipe,
                              const std::vector<OdometrySample>& samples) {
  return {recipe.name, "odometry", recipe.rate_hz, samples.size(),
          availability_percent(samples.size(), drive.recipe.duration_s, recipe.first_s, recipe.rate_hz)};
}

SourceStatistics judge_source(const SimulatedDrive& drive, const GnssRecipe& recipe,
                              const std::vector<SimulatedFix>& fixes) {
  return {recipe.name,
          "gnss",
          recipe.rate_hz,
          fixes.size(),
          availability_percent(fixes.size(), drive.recipe.duration_s, recipe.first_s, recipe.rate_hz),
          position_rms(drive, fixes, recipe.antenna_m)};
}

}  // namespace

std::vector<SourceStatistics> source_statistics(const SimulatedDrive& drive) {
  const SimulationRecipe& recipe = drive.recipe;
  std::vector<SourceStatistics> all = {judge_source(drive, recipe.odometry, drive.odometry)};
  for (std::size_t i = 0; i < drive.further_odometry.size(); ++i)
    all.push_back(judge_source(drive, recipe.further_odometry[i], drive.further_odometry[i].samples));
  all.push_back(judge_source(drive, recipe.gnss, drive.fixes));
  for (std::size_t i = 0; i < drive.further_gnss.size(); ++i)
    all.push_back(judge_source(drive, recipe.further_gnss[i], drive.further_gnss[i].fixes));
  return all;
}

}  // namespace waymark::simulation

#include <algorithm>
#include <cmath>
#include <map>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/reproduction/experiment/outlier_treatment.hpp>
#include <waymark/tools/reproduction/experiment/run_setting.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::reproduction {
namespace {

std::vector<Eigen::Vector3d> vehicle_poses(const Graph& graph, std::size_t count) {
  std::vector<Eigen::Vector3d> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = graph.value(static_cast<VertexIndex>(i));
    poses.emplace_back(value[0], value[1], value[2]);
  }
  return poses;
}

PoseDifference largest_difference(const std::vector<Eigen::Vector3d>& a,
                                  const std::vector<Eigen::Vector3d>& b) {
  PoseDifference largest{0, 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest.position_m = std::max(largest.position_m, (a[i] - b[i]).head<2>().norm());
    largest.heading_rad = std::max(largest.heading_rad, std::abs(wrap_angle(a[i][2] - b[i][2])));
  }
  return largest;
}

}  // namespace

double Outcome::rejected_percent() const {
  return 100.0 * static_cast<double>(rejected) / static_cast<double>(accepted + rejected);
}

StudiedDrive::StudiedDrive(drive::DriveDescription description, const drive::DriveLogs& logs,
                           const TypeRegistry& registry)
    : description_(std::move(description)),
      drive_(drive::prepare_drive(logs, description_)),
      fusion_(drive_, registry) {}

namespace {

/// Returns the drive with a setting. The covariances of its fixes are inflated if their residuals
/// are too large.
drive::ModeledDrive inflated(const StudiedDrive& drive, const Setting& setting,
                             const evaluation::Evaluation& residuals, const TypeRegistry& registry) {
  drive::PreparedDrive prepared = drive.drive();
  prepared.fixes = inflate_fixes(prepared.fixes, residuals.epochs);
  return drive::Fusion(prepared, registry).model(setting.fusion);
}

/// Fuses the drive. The outcome has everything but noise and evaluation. Returns the drive at the minimum.
drive::ModeledDrive fuse(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory,
                         Outcome& outcome) {
  const TypeRegistry& registry = laboratory.registry;
  drive::ModeledDrive model = drive.model(setting);
  outcome.accepted = model.placed.gate.accepted;
  outcome.rejected = model.placed.gate.rejected;
  if (setting.outliers == OutlierTreatment::graduation) {
    Graduated found = graduate_fixes(model.document.graph, setting, registry, laboratory.cancel);
    outcome.accepted -= found.outliers;
    outcome.rejected += found.outliers;
    outcome.ending = std::move(found.ending);
  } else {
    outcome.ending = minimize(model.document.graph, setting, registry, laboratory.cancel);
  }
  if (setting.outliers == OutlierTreatment::inflation) {
    model = inflated(drive, setting, laboratory.evaluate(model, {}, false), registry);
    outcome.ending = minimize(model.document.graph, setting, registry, laboratory.cancel);
  }
  if (!setting.objective.empty())
    outcome.poses = vehicle_poses(model.document.graph, model.placed.timeline.stamps.size());
  return model;
}

}  // namespace

Outcome run_setting(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory) {
  if (laboratory.progress) laboratory.progress(setting.name);
  Outcome outcome;
  outcome.setting = setting;
  try {
    drive::ModeledDrive fused = fuse(drive, setting, laboratory, outcome);
    if (setting.evaluated) {
      outcome.evaluation = laboratory.evaluate(fused, drive.drive().truth, outcome.ending.converged);
      outcome.evaluation.epochs = {};
      if (outcome.evaluation.truth) outcome.evaluation.truth->match.at = {};
    }
    outcome.noise = std::move(fused.noise);
    outcome.noise.spread = {};
  } catch (const InputError& error) {
    outcome.failure = error.what();
  } catch (const UsageError& error) {
    outcome.failure = error.what();
  }
  return outcome;
}

std::vector<Outcome> run_settings(StudiedDrive& drive, const std::vector<Setting>& settings,
                                  const Laboratory& laboratory) {
  std::vector<Outcome> outcomes;
  outcomes.reserve(settings.size());
  for (const Setting& setting : settings) outcomes.push_back(run_setting(drive, setting, laboratory));
  compare_outcomes(outcomes);
  return outcomes;
}

void compare_outcomes(std::vector<Outcome>& outcomes) {
  std::map<std::string, const Outcome*> lowest;
  for (const Outcome& outcome : outcomes) {
    if (outcome.poses.empty()) continue;
    const Outcome*& best = lowest[outcome.setting.objective];
    if (best == nullptr || outcome.ending.chi2 < best->ending.chi2) best = &outcome;
  }
  for (Outcome& outcome : outcomes) {
    if (outcome.poses.empty()) continue;
    const Outcome& minimum = *lowest.at(outcome.setting.objective);
    outcome.from_minimum = largest_difference(outcome.poses, minimum.poses);
    outcome.minimum_chi2 = minimum.ending.chi2;
  }
  for (Outcome& outcome : outcomes) outcome.poses = {};
}

bool at_minimum(const Outcome& outcome) {
  return outcome.from_minimum.position_m <= kSamePoses.position_m &&
         outcome.from_minimum.heading_rad <= kSamePoses.heading_rad;
}

bool near_minimum(const Outcome& outcome) {
  // false if there is no minimum (NaN)
  return outcome.ending.chi2 - outcome.minimum_chi2 <= kReachedChi2;
}

const Outcome* find_outcome(const std::vector<Outcome>& outcomes, const std::string& name) {
  const auto found = std::find_if(outcomes.begin(), outcomes.end(),
                                  [&](const Outcome& outcome) { return outcome.setting.name == name; });
  return found == outcomes.end() ? nullptr : &*found;
}

}  // namespace waymark::reproduction

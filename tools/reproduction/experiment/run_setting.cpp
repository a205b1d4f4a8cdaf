#include <algorithm>
#include <cmath>
#include <map>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/reproduction/experiment/outlier_treatment.hpp>
#include <waymark/tools/reproduction/experiment/run_setting.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::reproduction {
namespace {

drive::DriveConfig without_choices(drive::DriveConfig config) {
  config.modeling_options.clear();
  config.loss.clear();
  config.sensors.clear();
  config.odometry_model = drive::DriveConfig().odometry_model;
  config.modeling = drive::DriveConfig().modeling;
  return config;
}

drive::PreparedDrive prepare(const drive::DriveLogs& logs, const drive::DriveConfig& config) {
  drive::DriveLogs needed = logs;
  needed.sensors.clear();
  return drive::prepare_drive(needed, config);
}

/// Turns the start about its first pose.
void turn_start(double first_heading, drive::DriveSkeleton& skeleton) {
  std::vector<Eigen::Vector3d>& poses = skeleton.start.poses;
  const Eigen::Vector3d first = poses.front();
  const double turn = first_heading - first[2];
  Graph& graph = skeleton.document.graph;
  std::vector<double> values = graph.values();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector2d place =
        first.head<2>() + rotate(turn, Eigen::Vector2d((poses[i] - first).head<2>()));
    poses[i] = {place[0], place[1], wrap_angle(poses[i][2] + turn)};
    std::copy_n(poses[i].data(), 3, values.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  graph.set_values(std::move(values));
}

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

StudiedDrive::StudiedDrive(drive::DriveConfig config, const drive::DriveLogs& logs)
    : config_(without_choices(std::move(config))), drive_(prepare(logs, config_)) {}

drive::DriveConfig StudiedDrive::changed(const DriveChanges& changes) const {
  drive::DriveConfig config = config_;
  config.gate_stated = changes.gate.has_value();
  config.gate.enabled = changes.gate.value_or(true);
  if (changes.gate_chord_s > 0) {
    config.gate.chord_s = changes.gate_chord_s;
    config.gate.max_chord_s = std::max(config.gate.max_chord_s, 2 * changes.gate_chord_s);
  }
  config.start.method = changes.start;
  config.odometry_options = changes.odometry_options;
  config.calibration_stated = changes.calibration.has_value();
  config.calibration = changes.calibration.value_or(Options());
  config.estimates_noise = changes.estimates_noise;
  return config;
}

const drive::DriveSkeleton& StudiedDrive::skeleton(const DriveChanges& changes,
                                                   const TypeRegistry& registry) {
  for (const auto& [known, skeleton] : skeletons_) {
    if (known == changes) return skeleton;
  }
  const drive::DriveConfig config = changed(changes);
  drive::PreparedDrive drive = drive_;
  if (!changes.lever_arm) drive.antenna_m.setZero();
  drive::DriveSkeleton skeleton = drive::build_skeleton(drive, config, registry);
  if (changes.first_heading_rad) turn_start(*changes.first_heading_rad, skeleton);
  return skeletons_.emplace_back(changes, std::move(skeleton)).second;
}

namespace {

std::optional<Loss> make_loss(const Setting& setting, const TypeRegistry& registry) {
  if (!setting.loss) return std::nullopt;
  const LossType* type = registry.find_loss(setting.loss->name);
  if (type == nullptr) throw UsageError("unknown loss '" + setting.loss->name + "'");
  return Loss{type->name, type->evaluate, setting.loss->scale};
}

/// The graph of a setting at its start, and what came about on the way.
struct Built {
  formats::GraphDocument document;
  drive::GateSummary gate;
  std::size_t poses = 0;
  drive::NoiseEstimate noise;
};

Built build(StudiedDrive& drive, const std::vector<Fix>& fixes, const Setting& setting,
            const TypeRegistry& registry) {
  const std::optional<Loss> loss = make_loss(setting, registry);
  if (setting.changes.shares_skeleton() && setting.outliers != OutlierTreatment::inflation) {
    const drive::DriveSkeleton& skeleton = drive.skeleton(setting.changes, registry);
    return {drive::add_modeling(skeleton, setting.modeling, setting.modeling_options, registry, loss),
            skeleton.gate,
            skeleton.start.poses.size(),
            {}};
  }
  drive::PreparedDrive prepared = drive.drive();
  prepared.fixes = fixes;
  if (!setting.changes.lever_arm) prepared.antenna_m.setZero();
  drive::ModeledDrive modeled = drive::model_drive(prepared, drive.changed(setting.changes), setting.modeling,
                                                   setting.modeling_options, registry, loss);
  return {std::move(modeled.document), std::move(modeled.gate), modeled.start.poses.size(),
          std::move(modeled.noise)};
}

/// Fuses the drive; the outcome has everything but its evaluation. Returns the optimised document.
formats::GraphDocument fuse(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory,
                            Outcome& outcome) {
  Built built = build(drive, drive.drive().fixes, setting, laboratory.registry);
  outcome.accepted = built.gate.accepted;
  outcome.rejected = built.gate.rejected;
  Graph& graph = built.document.graph;
  if (setting.outliers == OutlierTreatment::graduation) {
    Graduated found = graduate_fixes(graph, setting.minimization, laboratory.registry, laboratory.cancel);
    outcome.accepted -= found.outliers;
    outcome.rejected += found.outliers;
    outcome.ending = std::move(found.ending);
  } else {
    outcome.ending = minimize(graph, setting.minimization, laboratory.registry, laboratory.cancel);
  }
  if (setting.outliers == OutlierTreatment::inflation) {
    const evaluation::Evaluation residuals = laboratory.evaluate(built.document, {}, false);
    built = build(drive, inflate_fixes(drive.drive().fixes, residuals.epochs), setting, laboratory.registry);
    outcome.ending = minimize(graph, setting.minimization, laboratory.registry, laboratory.cancel);
  }
  if (!setting.objective.empty()) outcome.poses = vehicle_poses(graph, built.poses);
  outcome.noise = std::move(built.noise);
  return std::move(built.document);
}

}  // namespace

Outcome run_setting(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory) {
  if (laboratory.progress) laboratory.progress(setting.name);
  Outcome outcome;
  outcome.setting = setting;
  try {
    formats::GraphDocument document = fuse(drive, setting, laboratory, outcome);
    if (setting.evaluated) {
      outcome.evaluation = laboratory.evaluate(document, drive.drive().truth, outcome.ending.converged);
      outcome.evaluation.epochs = {};
      if (outcome.evaluation.truth) outcome.evaluation.truth->match.at = {};
    }
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
  return outcome.ending.chi2 - outcome.minimum_chi2 <= kReachedChi2;  // not where there is none: NaN
}

const Outcome* find_outcome(const std::vector<Outcome>& outcomes, const std::string& name) {
  const auto found = std::find_if(outcomes.begin(), outcomes.end(),
                                  [&](const Outcome& outcome) { return outcome.setting.name == name; });
  return found == outcomes.end() ? nullptr : &*found;
}

}  // namespace waymark::reproduction

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/core/multi_start.hpp>
#include <waymark/tools/reproduction/run_setting.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark {
namespace {

/// g2o's rule, as an observer that cancels.
class GainRule {
 public:
  explicit GainRule(const std::atomic<bool>* outer) : outer_(outer) {}

  void observe(const IterationRecord& record) {
    if (outer_ != nullptr && outer_->load()) stop_ = true;
    attempts_ = record.accepted ? 0 : attempts_ + 1;
    if (attempts_ >= kGainAttempts) end(fmt::format("{} steps in a row were of no use", attempts_), false);
    if (!record.accepted) return;
    ++taken_;
    const double gain = record.decrease / record.chi2;
    // The first iteration has no gain in g2o: it counts from the chi2 after it.
    if (taken_ > 1 && gain >= 0 && gain < kGain)
      end(fmt::format("a {} step lowered chi2 by {:.2g} of it", record.kind, gain), true);
    if (taken_ >= kGainIterations) end(fmt::format("{} iterations", taken_), false);
  }

  [[nodiscard]] bool ended() const { return !message_.empty(); }
  [[nodiscard]] bool converged() const { return converged_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::atomic<bool>* token() const { return &stop_; }

 private:
  void end(std::string message, bool converged) {
    if (ended()) return;
    message_ = std::move(message);
    converged_ = converged;
    stop_ = true;
  }

  const std::atomic<bool>* outer_;
  std::atomic<bool> stop_{false};
  int taken_ = 0;
  int attempts_ = 0;
  bool converged_ = false;
  std::string message_;
};

Ending describe(const Summary& summary) {
  Ending ending;
  ending.converged = summary.converged();
  ending.message = summary.message;
  for (const IterationRecord& record : summary.records)
    ++(record.accepted ? ending.iterations : ending.rejected_steps);
  ending.initial_chi2 = summary.initial_chi2;
  ending.chi2 = summary.final_chi2;
  return ending;
}

Ending minimize(Graph& graph, const Minimization& how, const Laboratory& laboratory) {
  const TypeRegistry& registry = laboratory.registry;
  const auto algorithm = registry.make_algorithm(how.algorithm, how.options);
  const auto solver = registry.make_linear_solver(registry.linear_solvers().front().type.name);
  OptimizerOptions options;
  options.max_iterations = how.max_iterations;
  options.decrement_tolerance = how.tolerance;
  options.cancel = laboratory.cancel;
  if (how.all_starts)
    return describe(optimize_from_best_start(graph, registry.starts(), *algorithm, *solver, options).summary);
  if (how.stopping == StoppingRule::full_steps)
    return describe(optimize(graph, *algorithm, *solver, options));

  GainRule rule(laboratory.cancel);
  options.max_iterations = kGainIterations * kGainAttempts;
  options.decrement_tolerance = 1e-300;  // the rule alone ends the run
  options.gradient_tolerance = 0;
  options.step_tolerance = 0;
  options.cancel = rule.token();
  options.observer = [&](const IterationRecord& record) { rule.observe(record); };
  Ending ending = describe(optimize(graph, *algorithm, *solver, options));
  if (rule.ended()) {
    ending.converged = rule.converged();
    ending.message = rule.message();
  }
  return ending;
}

void apply(const DriveChanges& changes, DriveConfig& config) {
  config.gate.enabled = changes.gate;
  config.start.method = changes.start;
  config.odometry_options = changes.odometry_options;
  config.calibration = changes.calibration;
}

DriveConfig without_choices(DriveConfig config) {
  config.modeling_options.clear();
  config.loss.clear();
  config.sensors.clear();
  config.odometry_model = DriveConfig().odometry_model;
  return config;
}

PreparedDrive prepare(const DriveLogs& logs, const DriveConfig& config) {
  DriveLogs needed = logs;
  needed.sensors.clear();
  return prepare_drive(needed, config);
}

/// Turns the start about its first pose.
void turn_start(double first_heading, DriveSkeleton& skeleton) {
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

StudiedDrive::StudiedDrive(DriveConfig config, const DriveLogs& logs)
    : config_(without_choices(std::move(config))), drive_(prepare(logs, config_)) {}

const DriveSkeleton& StudiedDrive::skeleton(const DriveChanges& changes, const TypeRegistry& registry) {
  for (const auto& [known, skeleton] : skeletons_) {
    if (known == changes) return skeleton;
  }
  DriveConfig config = config_;
  apply(changes, config);
  PreparedDrive drive = drive_;
  if (!changes.lever_arm) drive.antenna_m.setZero();
  DriveSkeleton skeleton = build_skeleton(drive, config, registry);
  if (changes.first_heading_rad) turn_start(*changes.first_heading_rad, skeleton);
  return skeletons_.emplace_back(changes, std::move(skeleton)).second;
}

Outcome run_setting(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory) {
  if (laboratory.progress) laboratory.progress(setting.name);
  Outcome outcome;
  outcome.setting = setting;
  try {
    const DriveSkeleton& skeleton = drive.skeleton(setting.changes, laboratory.registry);
    GraphDocument document =
        add_modeling(skeleton, setting.modeling, setting.modeling_options, laboratory.registry);
    outcome.accepted = skeleton.gate.accepted;
    outcome.rejected = skeleton.gate.rejected;
    outcome.ending = minimize(document.graph, setting.minimization, laboratory);
    if (!setting.objective.empty())
      outcome.poses = vehicle_poses(document.graph, skeleton.start.poses.size());
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

}  // namespace waymark

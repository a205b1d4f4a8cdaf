#include <waymark/tools/evaluation/evaluation.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::evaluation {
namespace {

void check(const EvaluationInput& input) {
  const std::size_t n = input.fused.size();
  if (!input.fixes.empty() && input.fixes.size() != n)
    throw UsageError(fmt::format("evaluate: {} fused poses for {} fixes", n, input.fixes.size()));
  if (!input.when_measured.empty() && input.when_measured.size() != n)
    throw UsageError(fmt::format("evaluate: {} poses at the times of measurement for {} fixes",
                                 input.when_measured.size(), n));
  if (!input.position_covariances.empty() && input.position_covariances.size() != n)
    throw UsageError(
        fmt::format("evaluate: {} covariances for {} poses", input.position_covariances.size(), n));
  if (!input.heading_sigmas_rad.empty() && input.heading_sigmas_rad.size() != n)
    throw UsageError(
        fmt::format("evaluate: {} sigmas of headings for {} poses", input.heading_sigmas_rad.size(), n));
  const bool levers = std::all_of(input.fixes.begin(), input.fixes.end(),
                                  [](const Fix& fix) { return fix.antenna_m.allFinite(); });
  if (!levers || !input.truth_reference_m.allFinite())
    throw UsageError("evaluate: a lever arm is not finite");
  if (!input.heights_m.empty() && input.heights_m.size() != n)
    throw UsageError(fmt::format("evaluate: {} heights for {} poses", input.heights_m.size(), n));
  for (const StampedPose& fused : input.fused) {
    if (!fused.pose.allFinite())
      throw InputError(
          fmt::format("evaluate: fused pose at {} s is not finite", formats::decimal_seconds(fused.stamp)));
  }
  for (std::size_t i = 0; i < input.fixes.size(); ++i) {
    const Stamp stamp = input.fixes[i].stamp;
    if (std::abs(seconds_between(input.fused[i].stamp, stamp)) > input.max_stamp_offset_s)
      throw UsageError(fmt::format("evaluate: fused pose {} at {} s does not belong to the fix at {} s", i,
                                   formats::decimal_seconds(input.fused[i].stamp),
                                   formats::decimal_seconds(stamp)));
    if (!input.fixes[i].position.allFinite())
      throw InputError(fmt::format("evaluate: fix at {} s is not finite", formats::decimal_seconds(stamp)));
  }
}

ResidualKind residual_kind(FixStatus status) {
  switch (status) {
    case FixStatus::accepted:
      return ResidualKind::post_fit;
    case FixStatus::rejected:
      return ResidualKind::gated;
    case FixStatus::withheld:
      return ResidualKind::prediction;
  }
  return ResidualKind::post_fit;
}

/// Returns the fused pose at the moment when fix i was measured.
const Eigen::Vector3d& pose_when_measured(const EvaluationInput& input, std::size_t i) {
  return input.when_measured.empty() ? input.fused[i].pose : input.when_measured[i];
}

/// Returns the position of the antenna of fix i by the fused trajectory.
Eigen::Vector2d predicted_antenna(const EvaluationInput& input, std::size_t i) {
  const Eigen::Vector3d& pose = pose_when_measured(input, i);
  return pose.head<2>() + rotate(pose[2], input.fixes[i].antenna_seen_m());
}

/// The offsets of one system over the epochs.
struct Gathered {
  std::vector<Stamp> stamps;
  std::vector<Eigen::Vector2d> offsets;
  std::vector<std::optional<double>> directions;
  std::vector<double> heading_errors;

  void add(Stamp stamp, const Eigen::Vector2d& offset, const std::optional<double>& direction) {
    stamps.push_back(stamp);
    offsets.push_back(offset);
    directions.push_back(direction);
  }

  [[nodiscard]] SystemMetrics metrics() const {
    return SystemMetrics{.position = position_metrics(offsets),
                         .track = track_metrics(offsets, directions),
                         .heading = scalar_statistics(heading_errors)};
  }

  [[nodiscard]] std::vector<double> autocorrelation() const {
    return error_autocorrelation(stamps, offsets, kAutocorrelationLags);
  }
};

void compare_with_truth(const EvaluationInput& input, std::size_t i, const TruthPose& truth,
                        EpochResult& result) {
  const Eigen::Vector3d& fused = input.fused[i].pose;
  const double heading = truth.heading_rad.value_or(fused[2]);
  const Eigen::Vector2d truth_body = truth.position - rotate(heading, input.truth_reference_m);
  if (!input.fixes.empty())
    result.gnss_offset_m = input.fixes[i].position - rotate(heading, input.fixes[i].antenna_m) - truth_body;
  result.fused_offset_m = fused.head<2>() - truth_body;
  if (!input.heights_m.empty() && std::isfinite(truth.height_m))
    result.height_error_m = input.heights_m[i] - truth.height_m;
  if (truth.heading_rad) result.heading_error_rad = wrap_angle(fused[2] - *truth.heading_rad);
}

/// Compares the motions of the fused poses with those of the truth.
std::vector<RelativePoseError> relative_errors(const EvaluationInput& input, const TruthMatch& match,
                                               const std::vector<EpochResult>& epochs) {
  std::vector<Eigen::Vector3d> truth;
  std::vector<Eigen::Vector3d> fused;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    if (!match.at[i] || !epochs[i].fused_offset_m) continue;
    const Eigen::Vector3d& pose = input.fused[i].pose;
    const Eigen::Vector2d place = pose.head<2>() - *epochs[i].fused_offset_m;
    truth.emplace_back(place.x(), place.y(), match.at[i]->pose.heading_rad.value_or(pose[2]));
    fused.push_back(pose);
  }
  std::vector<RelativePoseError> errors;
  for (const double distance : kRelativeDistances)
    errors.push_back(relative_pose_error(truth, fused, distance));
  return errors;
}

/// Adds the errors in space, or the reason why there are none.
void add_space(const EvaluationInput& input, const std::vector<EpochResult>& epochs,
               TruthEvaluation& evaluation) {
  std::vector<Eigen::Vector2d> offsets;
  std::vector<double> heights;
  for (const EpochResult& epoch : epochs) {
    if (!epoch.fused_offset_m || !epoch.height_error_m) continue;
    offsets.push_back(*epoch.fused_offset_m);
    heights.push_back(*epoch.height_error_m);
  }
  if (!offsets.empty()) {
    evaluation.space = space_metrics(offsets, heights);
  } else {
    evaluation.no_space =
        std::string(input.heights_m.empty() ? "the graph has no height state" : kNoTruthHeights);
  }
}

TruthEvaluation evaluate_truth(const EvaluationInput& input, std::vector<EpochResult>& epochs) {
  std::vector<Stamp> stamps;
  stamps.reserve(epochs.size());
  for (const EpochResult& epoch : epochs) stamps.push_back(epoch.stamp);

  TruthEvaluation evaluation;
  evaluation.match = interpolate_truth(input.truth, stamps, input.truth_options);
  Gathered gnss;
  Gathered gnss_accepted;
  Gathered fused;
  std::vector<Eigen::Matrix2d> covariances;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    const std::optional<TruthAtEpoch>& truth = evaluation.match.at[i];
    if (!truth) continue;
    EpochResult& epoch = epochs[i];
    compare_with_truth(input, i, truth->pose, epoch);
    epoch.direction_rad = truth->pose.heading_rad ? truth->pose.heading_rad : truth->direction_rad;
    if (epoch.gnss_offset_m) gnss.add(epoch.stamp, *epoch.gnss_offset_m, epoch.direction_rad);
    fused.add(epoch.stamp, *epoch.fused_offset_m, epoch.direction_rad);
    if (epoch.position_covariance) {
      covariances.push_back(*epoch.position_covariance);
      epoch.nees = normalised_innovation_squared(*epoch.fused_offset_m, *epoch.position_covariance);
    }
    if (epoch.status == FixStatus::accepted)
      gnss_accepted.add(epoch.stamp, *epoch.gnss_offset_m, epoch.direction_rad);
    if (epoch.heading_error_rad) fused.heading_errors.push_back(*epoch.heading_error_rad);
  }
  evaluation.gnss = gnss.metrics();
  evaluation.gnss_accepted = gnss_accepted.metrics();
  evaluation.fused = fused.metrics();
  evaluation.improvement = improvement(evaluation.gnss.position, evaluation.fused.position);
  evaluation.gnss_without_offset = without_constant_offset(gnss.offsets, gnss.directions);
  evaluation.fused_without_offset = without_constant_offset(fused.offsets, fused.directions);
  evaluation.relative = relative_errors(input, evaluation.match, epochs);
  evaluation.gnss_autocorrelation = gnss.autocorrelation();
  evaluation.fused_autocorrelation = fused.autocorrelation();
  add_space(input, epochs, evaluation);
  if (!input.position_covariances.empty())
    evaluation.consistency = consistency_statistics(fused.stamps, fused.offsets, covariances);
  return evaluation;
}

/// Fills everything that needs no truth, except `nu`.
std::vector<EpochResult> epochs_without_truth(const EvaluationInput& input) {
  const std::vector<std::optional<double>> speeds = fused_speeds(input.fused);
  std::vector<EpochResult> epochs(input.fused.size());
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    epochs[i].stamp = input.fixes.empty() ? input.fused[i].stamp : input.fixes[i].stamp;
    if (!input.fixes.empty()) {
      const Fix& fix = input.fixes[i];
      epochs[i].status = fix.status;
      epochs[i].reason = fix.reason;
      epochs[i].fix_sigma_m = fix.covariance.diagonal().cwiseSqrt();
      epochs[i].jump_sigma_m = fix.jump_sigma_m;
      epochs[i].told = fix.told;
    }
    if (!input.heading_sigmas_rad.empty()) epochs[i].heading_sigma_rad = input.heading_sigmas_rad[i];
    epochs[i].fused_position = input.fused[i].pose.head<2>();
    epochs[i].speed_mps = speeds[i];
    if (!input.position_covariances.empty()) epochs[i].position_covariance = input.position_covariances[i];
  }
  return epochs;
}

/// Computes the residuals of all fixes against the fused trajectory. This needs no truth.
void evaluate_residuals(const EvaluationInput& input, Evaluation& evaluation) {
  std::vector<double> post_fit;
  std::vector<double> gated;
  std::vector<double> prediction;
  Gathered withheld;
  for (std::size_t i = 0; i < input.fixes.size(); ++i) {
    const Fix& fix = input.fixes[i];
    const ResidualKind kind = residual_kind(fix.status);
    const Eigen::Vector2d residual = fix.position - predicted_antenna(input, i);
    evaluation.epochs[i].fix_residual_m = residual;
    const Eigen::Matrix2d* pose_covariance =
        input.position_covariances.empty() ? nullptr : &input.position_covariances[i];
    const double nu =
        normalised_innovation_squared(residual, residual_covariance(kind, fix.covariance, pose_covariance));
    if (input.independent_errors) evaluation.epochs[i].nu = nu;
    if (kind == ResidualKind::post_fit) post_fit.push_back(nu);
    if (kind == ResidualKind::gated) gated.push_back(nu);
    if (kind == ResidualKind::prediction) {
      prediction.push_back(nu);
      withheld.add(fix.stamp, -residual, input.fused[i].pose[2]);
    }
  }
  evaluation.accepted = post_fit.size();
  evaluation.rejected = gated.size();
  evaluation.withheld = prediction.size();
  if (!withheld.offsets.empty()) evaluation.withheld_fixes = withheld.metrics();
  if (!input.independent_errors) {
    post_fit.clear();
    gated.clear();
    prediction.clear();
  }
  evaluation.post_fit = innovation_statistics(ResidualKind::post_fit, post_fit);
  evaluation.gated = innovation_statistics(ResidualKind::gated, gated);
  evaluation.prediction = innovation_statistics(ResidualKind::prediction, prediction);
}

std::vector<QualityMetrics> metrics_by_quality(const EvaluationInput& input,
                                               const std::vector<EpochResult>& epochs) {
  std::vector<QualityMetrics> all;
  for (const FixQuality quality : kFixQualities) {
    QualityMetrics metrics{.quality = quality, .gnss = {}, .fused = {}};
    std::vector<Eigen::Vector2d> gnss;
    std::vector<Eigen::Vector2d> fused;
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      if (input.fixes[i].told.quality != quality) continue;
      ++metrics.fixes;
      metrics.accepted += input.fixes[i].status == FixStatus::accepted;
      if (!epochs[i].gnss_offset_m || !epochs[i].fused_offset_m) continue;
      gnss.push_back(*epochs[i].gnss_offset_m);
      fused.push_back(*epochs[i].fused_offset_m);
    }
    if (metrics.fixes == 0) continue;
    metrics.gnss = position_metrics(gnss);
    metrics.fused = position_metrics(fused);
    all.push_back(metrics);
  }
  const bool told = all.size() > 1 || (all.size() == 1 && all[0].quality != FixQuality::unknown);
  return told ? all : std::vector<QualityMetrics>();
}

/// Returns the fused poses as one of the predictions.
Prediction fused_prediction(const EvaluationInput& input) {
  Prediction fused{.label = "fused", .poses = {}, .position_covariances = {}};
  for (std::size_t i = 0; i < input.fixes.size(); ++i) fused.poses.emplace_back(pose_when_measured(input, i));
  for (const Eigen::Matrix2d& covariance : input.position_covariances)
    fused.position_covariances.emplace_back(covariance);
  return fused;
}

void compare_at_withheld(const EvaluationInput& input, Evaluation& evaluation) {
  if (evaluation.withheld == 0) return;
  evaluation.outages = outage_ends(input.fixes).size();
  const auto add = [&](const Prediction& prediction) {
    evaluation.at_withheld.push_back(withheld_metrics(prediction, input.fixes));
  };
  add(fused_prediction(input));
  for (const Prediction& prediction : input.predictions) add(prediction);
}

}  // namespace

std::optional<double> EpochResult::sigma_m() const {
  return position_covariance ? std::optional(std::sqrt(0.5 * position_covariance->trace())) : std::nullopt;
}

const WithheldMetrics& HeldOut::fused() const {
  const auto lasting = std::find_if(predictions.begin(), predictions.end(), [](const WithheldMetrics& way) {
    return way.label == "with lasting errors";
  });
  return lasting == predictions.end() ? predictions.front() : *lasting;
}

std::vector<std::optional<double>> fused_speeds(std::span<const StampedPose> poses) {
  constexpr double kLongestSide = 5;  // s; a longer chord says little about the speed here
  std::vector<std::optional<double>> speeds(poses.size());
  std::size_t before = 0;  // the last pose with an earlier stamp, if there is one
  std::size_t after = 0;   // the first pose with a later stamp
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Stamp now = poses[i].stamp;
    if (i > 0 && poses[i - 1].stamp < now) before = i - 1;
    while (after < poses.size() && poses[after].stamp <= now) ++after;
    const auto reaches = [&](std::size_t j) {
      const double dt = j < poses.size() ? std::abs(seconds_between(poses[j].stamp, now)) : 0;
      return dt > 0 && dt <= kLongestSide;
    };
    const StampedPose& from = poses[reaches(before) ? before : i];
    const StampedPose& to = poses[reaches(after) ? after : i];
    const double dt = seconds_between(from.stamp, to.stamp);
    if (!(dt > 0)) continue;
    const Eigen::Vector2d chord = to.pose.head<2>() - from.pose.head<2>();
    const double ahead = track_offset(chord, poses[i].pose[2]).along_m;
    speeds[i] = std::copysign(chord.norm() / dt, ahead);
  }
  return speeds;
}

Evaluation evaluate(const EvaluationInput& input) {
  check(input);
  Evaluation evaluation;
  evaluation.frame = input.frame;
  evaluation.epochs = epochs_without_truth(input);
  evaluate_residuals(input, evaluation);
  compare_at_withheld(input, evaluation);
  if (!input.truth.empty()) evaluation.truth = evaluate_truth(input, evaluation.epochs);
  evaluation.by_quality = metrics_by_quality(input, evaluation.epochs);
  return evaluation;
}

}  // namespace waymark::evaluation

/// Evaluation of a fused drive: against truth where there is one, against withheld fixes, and by its
/// innovations.
///
/// All positions are compared at ONE point, the body point (the pose of the graph). The truth is moved there
/// from its reference point and the raw fix from its antenna, both by the truth's heading where it has one at
/// that epoch, else by the fused heading. With zero lever arms no heading is needed. Lever arms are taken as
/// grid metres (UTM's scale changes a 3 m arm by about a millimetre).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/evaluation/numbers/autocorrelation.hpp>
#include <waymark/tools/evaluation/numbers/consistency.hpp>
#include <waymark/tools/evaluation/numbers/innovation.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/evaluation/numbers/truth_interpolation.hpp>
#include <waymark/tools/evaluation/numbers/withheld.hpp>

namespace waymark::evaluation {

struct EvaluationInput {
  /// The pose at each fix: same length, same order, stamps within max_stamp_offset_s.
  std::vector<StampedPose> fused;
  /// The pose when each fix was really measured, where a time offset was estimated; empty: `fused`. Residuals
  /// of the fixes are formed with it.
  std::vector<Eigen::Vector3d> when_measured;
  std::vector<Fix> fixes;                   ///< all that entered the drive, whatever became of them
  std::vector<TruthPose> truth;             ///< empty: no truth
  Eigen::Vector2d antenna_m{0, 0};          ///< GNSS antenna in the body frame (x forward, y left)
  Eigen::Vector2d truth_reference_m{0, 0};  ///< truth reference point in the body frame
  /// Of the fused poses, m^2, frame axes; empty or one per pose.
  std::vector<Eigen::Matrix2d> position_covariances;
  std::vector<Prediction> predictions;  ///< what the fused poses are compared with at withheld fixes
  Frame frame;
  TruthOptions truth_options;
  double max_stamp_offset_s = 0.001;  ///< a fix may share a pose this far from it in time (timeline's snap_s)
};

/// What one localisation system achieved.
struct SystemMetrics {
  PositionMetrics position;
  TrackMetrics track;        ///< along the truth's heading where given, else the direction of its motion
  ScalarStatistics heading;  ///< heading error, rad, wrapped; only where the truth has a heading
};

/// What was found at one fix; for plots, reports and PREFIX.epochs.csv (epochs_csv.hpp).
struct EpochResult {
  Stamp stamp;
  FixStatus status = FixStatus::accepted;
  std::string reason;                                   ///< of the status
  Eigen::Vector2d fix_sigma_m{kUndefined, kUndefined};  ///< stated by the receiver: grid east, north
  std::optional<double> speed_mps;                      ///< fused; see fused_speeds
  std::optional<Eigen::Matrix2d> position_covariance;   ///< stated, of the fused position, m^2
  std::optional<Eigen::Vector2d> gnss_offset_m;         ///< raw fix - truth, at the body point
  std::optional<Eigen::Vector2d> fused_offset_m;        ///< fused - truth, at the body point
  std::optional<double> direction_rad;                  ///< what along and across track refer to: the
                                                        ///< truth's heading, else that of its motion
  std::optional<double> heading_error_rad;              ///< fused - truth
  double nees = kUndefined;                             ///< d^T P^-1 d of the fused offset d
  double nu = kUndefined;                               ///< normalised innovation squared
};

struct TruthEvaluation {
  TruthMatch match;  ///< what was matched, what not and why
  /// Raw fixes at every matched epoch, whatever the gate said and whether withheld or not: what the receiver
  /// gives does not depend on how it is fused.
  SystemMetrics gnss;
  /// Raw fixes, accepted ones only: other epochs than those of `fused`, so no improvement is formed from
  /// them.
  SystemMetrics gnss_accepted;
  SystemMetrics fused;      ///< at the very epochs of `gnss`
  Improvement improvement;  ///< of `fused` relative to `gnss`
  /// Stated against actual error of the fused poses; empty where no covariances were given.
  std::optional<ConsistencyStatistics> consistency;
  /// error_autocorrelation at kAutocorrelationLags.
  std::vector<double> gnss_autocorrelation;
  std::vector<double> fused_autocorrelation;
};

struct Evaluation {
  std::size_t accepted = 0;
  std::size_t rejected = 0;
  std::size_t withheld = 0;
  std::optional<TruthEvaluation> truth;  ///< empty where no truth was given
  /// Fused antenna - withheld fix, along the fused heading; the noise of the fixes is in it. Empty where none
  /// was withheld.
  std::optional<SystemMetrics> withheld_fixes;
  std::size_t outages = 0;                   ///< runs of withheld fixes over more than one epoch
  std::vector<WithheldMetrics> at_withheld;  ///< the fused poses ("fused") and each prediction
  InnovationStatistics post_fit;             ///< accepted fixes: residuals after the fit, not innovations
  InnovationStatistics gated;                ///< rejected fixes
  InnovationStatistics prediction;           ///< withheld fixes: innovations proper
  Frame frame;
  std::vector<EpochResult> epochs;  ///< one per fix

  [[nodiscard]] std::size_t fixes() const { return accepted + rejected + withheld; }
};

/// Speed at each of a row of fused poses, m/s: the chord between the poses before and after it, or between
/// one of them and it where the other is more than 5 s away; negative in reverse, against the heading. Empty
/// where both are that far. Poses of the same stamp (fixes of two receivers) are one.
[[nodiscard]] std::vector<std::optional<double>> fused_speeds(std::span<const StampedPose> poses);

/// Evaluates one fused drive. O(n log n).
/// @throws UsageError where the vectors do not belong together;
///         InputError for a pose or fix that is not finite and a truth that cannot be matched.
[[nodiscard]] Evaluation evaluate(const EvaluationInput& input);

}  // namespace waymark::evaluation

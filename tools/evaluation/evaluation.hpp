/// Evaluation of a fused drive: against truth if there is one, against withheld fixes, and by its
/// innovations.
///
/// All positions are compared at ONE point, the body point (the pose of the graph). The truth is
/// moved there from its reference point, and a raw fix from its antenna. Both use the heading of
/// the truth if it has one at that epoch, or else the fused heading. With zero lever arms no
/// heading is needed. Lever arms are taken as grid metres (the scale of UTM changes a 3 m arm by
/// about a millimetre).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/evaluation/document/group_residuals.hpp>
#include <waymark/tools/evaluation/document/source_residuals.hpp>
#include <waymark/tools/evaluation/numbers/autocorrelation.hpp>
#include <waymark/tools/evaluation/numbers/consistency.hpp>
#include <waymark/tools/evaluation/numbers/constant_offset.hpp>
#include <waymark/tools/evaluation/numbers/innovation.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/evaluation/numbers/relative_pose_error.hpp>
#include <waymark/tools/evaluation/numbers/space_metrics.hpp>
#include <waymark/tools/evaluation/numbers/truth_interpolation.hpp>
#include <waymark/tools/evaluation/numbers/withheld.hpp>
#include <waymark/tools/evaluation/source_comparison.hpp>

namespace waymark::evaluation {

struct EvaluationInput {
  /// The pose at each fix: same length and order as `fixes`, stamps within max_stamp_offset_s. Without
  /// fixes, the poses to evaluate.
  std::vector<StampedPose> fused;
  /// The pose at the moment when each fix was really measured, if a time offset was estimated.
  /// Empty: `fused`. The residuals of the fixes use it.
  std::vector<Eigen::Vector3d> when_measured;
  std::vector<Fix> fixes;                   ///< all fixes of the drive, whatever their status
  std::vector<TruthPose> truth;             ///< empty: no truth
  Eigen::Vector2d truth_reference_m{0, 0};  ///< truth reference point in the body frame
  /// Covariances of the fused positions, m^2, frame axes; empty or one per pose.
  std::vector<Eigen::Matrix2d> position_covariances;
  /// Standard deviations of the fused headings, rad; empty or one per pose.
  std::vector<double> heading_sigmas_rad{};
  /// Heights above the ellipsoid, m, as a state of the graph has them; empty or one per pose.
  std::vector<double> heights_m{};
  /// The graph takes the errors of the fixes as independent, with the covariances that they claim. Otherwise
  /// the normalised innovations have no meaning and are left out.
  bool independent_errors = true;
  std::vector<Prediction> predictions;  ///< compared with the fused poses at withheld fixes
  Frame frame;
  TruthOptions truth_options;
  /// largest time between a fix and its pose (snap_s of the timeline)
  double max_stamp_offset_s = 0.001;
};

/// The metrics of one localisation system.
struct SystemMetrics {
  PositionMetrics position;
  /// along the heading of the truth if given, else along its direction of motion
  TrackMetrics track;
  ScalarStatistics heading;  ///< heading error, rad, wrapped; only if the truth has a heading
};

/// The result at one fix, or at one pose of a drive without receivers, for plots, reports and PREFIX.epochs.csv (epochs_csv.hpp).
struct EpochResult {
  Stamp stamp;
  std::optional<FixStatus> status;  ///< empty: the drive has no receiver
  std::string reason;               ///< reason for the status
  /// stated by the receiver: grid east, north
  Eigen::Vector2d fix_sigma_m{kUndefined, kUndefined};
  double jump_sigma_m = 0;                             ///< Fix::jump_sigma_m
  std::optional<double> speed_mps;                     ///< fused; see fused_speeds
  std::optional<Eigen::Matrix2d> position_covariance;  ///< stated, of the fused position, m^2
  std::optional<Eigen::Vector2d> gnss_offset_m;        ///< raw fix - truth, at the body point
  std::optional<Eigen::Vector2d> fused_offset_m;       ///< fused - truth, at the body point
  /// direction for along and across track: the heading of the truth, else its direction of motion
  std::optional<double> direction_rad;
  std::optional<double> heading_error_rad;  ///< fused - truth
  std::optional<double> height_error_m{};   ///< fused - truth
  double nees = kUndefined;                 ///< d^T P^-1 d of the fused offset d
  double nu = kUndefined;                   ///< normalised innovation squared
  /// Fix - fused antenna, at the moment when the fix was measured: an estimated delay is applied.
  std::optional<Eigen::Vector2d> fix_residual_m{};
  std::optional<Eigen::Vector2d> fused_position{};  ///< of the body point, m, frame
  std::optional<double> heading_sigma_rad{};        ///< stated, of the fused heading
  FixDetails told{};                                ///< what the receiver told of the fix
  std::optional<GeodeticPoint> raw_place{};         ///< of the antenna; empty from evaluate()
  std::optional<GeodeticPoint> fused_place{};       ///< of the body point; empty from evaluate()

  /// Returns the stated sigma of the fused position: root mean square of both axes.
  [[nodiscard]] std::optional<double> sigma_m() const;
};

/// Fixes that were kept out of a second fusion of the same drive, and how well it predicts them.
/// All fixes of a run are kept out, so that no neighbour in time tells the answer. Only fixes that
/// the first fusion accepted are judged. Errors that last longer than a run are in the neighbouring
/// fixes too, and remain unseen.
struct HeldOut {
  double run_s = 0;                            ///< length of a run of fixes that are kept out
  double every_s = 0;                          ///< from run to run
  std::vector<WithheldMetrics> predictions{};  ///< "fused", "dead reckoning", "with lasting errors"
  InnovationStatistics innovation{};           ///< of errors that last: with their states, at some fixes
  /// Root mean of the traces of the covariances of innovations: the error that they promise. kUndefined
  /// without them
  double expected_rmse_m = kUndefined;
  std::vector<Stamp> stamps{};     ///< of the judged fixes
  std::vector<double> errors_m{};  ///< of the fused prediction at each of them

  /// Returns the prediction of the fused poses; with the lasting errors of the fixes if the
  /// modeling expects any.
  [[nodiscard]] const WithheldMetrics& fused() const;
};

/// Raw and fused positions at the fixes of one quality.
struct QualityMetrics {
  FixQuality quality = FixQuality::unknown;
  std::size_t fixes = 0;     ///< of this quality
  std::size_t accepted = 0;  ///< of these
  PositionMetrics gnss;      ///< at those matched with the truth; no count without truth
  PositionMetrics fused;     ///< at the same epochs
};

/// TruthEvaluation::no_space if only the truth lacks heights.
inline constexpr std::string_view kNoTruthHeights = "the truth has no heights";

struct TruthEvaluation {
  TruthMatch match;  ///< the matched epochs, and why others are not matched
  /// Raw fixes at every matched epoch, whatever the gate decided, withheld or not. The output of
  /// the receiver does not depend on the fusion.
  SystemMetrics gnss;
  /// Raw fixes, only accepted ones. Their epochs differ from those of `fused`, so no improvement is
  /// computed from them.
  SystemMetrics gnss_accepted;
  SystemMetrics fused;                    ///< at the same epochs as `gnss`
  Improvement improvement;                ///< of `fused` relative to `gnss`
  OffsetTakenOut gnss_without_offset{};   ///< raw errors without a constant offset of the vehicle
  OffsetTakenOut fused_without_offset{};  ///< fused errors, likewise
  /// Of the fused poses at kRelativeDistances. Without a heading of the truth the fused one stands
  /// for it, so there are no rotations.
  std::vector<RelativePoseError> relative{};
  /// Stated against actual error of the fused poses. Empty without covariances.
  std::optional<ConsistencyStatistics> consistency;
  /// of the fused poses with their height. The height is that of the point that the state describes, such as
  /// an antenna: a constant difference to the point of the truth is in its mean.
  std::optional<SpaceMetrics> space{};
  std::string no_space{};  ///< why there is none, as the rest of a sentence
  /// error_autocorrelation of raw fixes at kAutocorrelationLags.
  std::vector<double> gnss_autocorrelation;
  std::vector<double> fused_autocorrelation;
};

struct Evaluation {
  std::size_t accepted = 0;
  std::size_t rejected = 0;
  std::size_t withheld = 0;
  std::optional<TruthEvaluation> truth;  ///< empty without truth
  /// Fused antenna - withheld fix, along the fused heading; it contains the noise of the fixes.
  /// Empty if none was withheld.
  std::optional<SystemMetrics> withheld_fixes;
  std::size_t outages = 0;                   ///< runs of withheld fixes over several epochs
  std::optional<HeldOut> held_out{};         ///< empty from evaluate(): it takes a further fusion
  std::vector<WithheldMetrics> at_withheld;  ///< the fused poses ("fused") and each prediction
  /// accepted fixes: residuals after the fit, not innovations
  InnovationStatistics post_fit;
  InnovationStatistics gated;       ///< rejected fixes
  InnovationStatistics prediction;  ///< withheld fixes: true innovations
  Frame frame;
  std::vector<EpochResult> epochs;           ///< one per fused pose
  SourceComparison sources;                  ///< empty from evaluate(): it takes further fusions
  std::vector<SourceResiduals> residuals{};  ///< empty from evaluate(): it takes the graph
  /// of sensors that tell of groups, without GroupedResiduals::measurements; empty from evaluate()
  std::vector<GroupedResiduals> groups{};
  std::vector<QualityMetrics> by_quality{};  ///< of the fixes; empty if no quality is told

  [[nodiscard]] std::size_t fixes() const { return accepted + rejected + withheld; }
};

/// Returns the speed at each fused pose of a sequence, m/s. It is the chord between the poses
/// before and after it. If one of these is more than 5 s away, it is the chord between the pose and
/// the other one; empty if both are. It is negative in reverse, against the heading. Poses with the
/// same stamp (fixes of two receivers) count as one.
[[nodiscard]] std::vector<std::optional<double>> fused_speeds(std::span<const StampedPose> poses);

/// Evaluates one fused drive. O(n log n).
/// @throws UsageError if the vectors do not belong together; InputError for a pose or fix that is
/// not finite, and for a truth that cannot be matched
[[nodiscard]] Evaluation evaluate(const EvaluationInput& input);

}  // namespace waymark::evaluation

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/program/jobs/result_warnings.hpp>

namespace waymark::program {
namespace {

constexpr double kStateSigmas = 6;
constexpr double kHeldSigmas = 3;
constexpr double kNearEnd = 0.95;  // of what is usual
constexpr double kWorseThanRaw = 1.5;
constexpr const char* kRemedy = "check units, signs, columns and clocks";

/// The prior holds on the first value of a state. A short drive moves it by less than its error.
void check_held(const evaluation::StateReport& state, std::vector<std::string>& warnings) {
  if (!(state.surprise > kHeldSigmas)) return;
  warnings.push_back(fmt::format(
      "the estimate of {} begins at {:.3g}{}, which its prior ({:.3g}) does not expect: {:.1f} times as far from "
      "zero as this drive would move it, so the prior may hold it back: {}; if it is real, widen the "
      "prior ({}_sigma)",
      state.name, state.first, state.unit == "1" ? "" : " " + state.unit, state.prior_sigma, state.surprise,
      kRemedy, state.name));
}

void check_states(const std::vector<evaluation::StateReport>& states, const Options& calibration,
                  std::vector<std::string>& warnings) {
  for (const evaluation::StateReport& state : states) {
    const double farthest = std::max(std::abs(state.smallest), std::abs(state.largest));
    if (!(state.prior_sigma > 0)) continue;
    if (!(farthest > kStateSigmas * state.prior_sigma)) {
      if (calibration.contains(state.name)) check_held(state, warnings);
      continue;
    }
    const double value = std::abs(state.smallest) > std::abs(state.largest) ? state.smallest : state.largest;
    warnings.push_back(fmt::format(
        "the estimate of {} is {:.3g}{}, {:.0f} times its usual value ({:.3g}): {}", state.name, value,
        state.unit == "1" ? "" : " " + state.unit, farthest / state.prior_sigma, state.prior_sigma, kRemedy));
  }
}

void check_noise(const drive::NoiseEstimate& noise, std::vector<std::string>& warnings) {
  for (const drive::NoiseParameter& parameter : noise.parameters) {
    if (parameter.prior.linear || !(parameter.value > 0) || !(parameter.prior.mean > 0)) continue;
    const double factor = parameter.value / parameter.prior.mean;
    if (!(std::log(factor) > kNearEnd * drive::kUsualNoise * parameter.prior.deviation)) continue;
    warnings.push_back(fmt::format("the estimate of {} {} is {:.3g} {}, {:.0f} times its usual value: {}",
                                   parameter.owner, parameter.name(), parameter.value, parameter.unit, factor,
                                   kRemedy));
  }
}

/// Fixed ambiguities are so good that a model of errors that last can spoil them.
void check_qualities(const evaluation::Evaluation& evaluation, std::vector<std::string>& warnings) {
  constexpr std::size_t kFewest = 30;
  constexpr double kWorse = 1.1;
  for (const evaluation::QualityMetrics& m : evaluation.by_quality) {
    if (m.gnss.count < kFewest || !(m.fused.median_m > kWorse * m.gnss.median_m)) continue;
    warnings.push_back(fmt::format(
        "at the {} fixes of quality {} the fused positions are {:.3g} m from the truth in the median, "
        "the raw ones {:.3g} m: their accuracy may be stated too large (accuracy: by_quality)",
        m.gnss.count, to_string(m.quality), m.fused.median_m, m.gnss.median_m));
  }
}

/// Residuals after the fit are below innovations, so that only a factor of two in the sigma is told, and
/// one of four below.
void check_innovations(const evaluation::InnovationStatistics& fixes, std::vector<std::string>& warnings) {
  constexpr std::size_t kFewest = 30;
  constexpr double kTooLarge = 4 * evaluation::InnovationStatistics::kExpectedMean;
  constexpr double kTooSmall = evaluation::InnovationStatistics::kExpectedMean / 16;
  if (fixes.count < kFewest || (fixes.mean <= kTooLarge && fixes.mean >= kTooSmall)) return;
  const double factor = std::sqrt(fixes.mean / evaluation::InnovationStatistics::kExpectedMean);
  warnings.push_back(fmt::format(
      "the residuals of the accepted fixes are {:.3g} times as large as their accuracies say (mean NIS {:.3g} "
      "of {} fixes; 2 is expected): the accuracies are stated too {} ('accuracy: {{meaning: ...}}'){}",
      factor, fixes.mean, fixes.count, factor > 1 ? "small" : "large",
      factor > 1
          ? ", or units, signs or clocks are wrong; the modeling correlated estimates how good the fixes are"
          : ""));
}

/// Errors that last are states, which take in whatever the odometry does wrong. Each fix is compared with its own claim
/// and what a lasting jump leaves open, and a few wild ones say nothing about the others.
void check_distances(const std::vector<evaluation::EpochResult>& epochs, std::vector<std::string>& warnings) {
  constexpr std::size_t kFewest = 30;
  constexpr double kFactor = 10;
  constexpr double kLeast_m = 10;
  constexpr double kWild = 0.07;  // of the accepted fixes
  std::vector<double> claims_of_far;
  std::size_t accepted = 0;
  double squares = 0;
  for (const evaluation::EpochResult& epoch : epochs) {
    if (epoch.status != FixStatus::accepted || !epoch.fix_residual_m) continue;
    ++accepted;
    const double claim_m = std::hypot(epoch.fix_sigma_m.norm() / std::sqrt(2), epoch.jump_sigma_m);
    if (!(epoch.fix_residual_m->norm() > std::max(kLeast_m, kFactor * claim_m))) continue;
    squares += epoch.fix_residual_m->squaredNorm();
    claims_of_far.push_back(claim_m);
  }
  const auto far = static_cast<double>(claims_of_far.size());
  if (accepted < kFewest || far <= kWild * static_cast<double>(accepted)) return;
  const double claim_m = upper_median(std::move(claims_of_far));
  warnings.push_back(fmt::format(
      "{:.0f} of {} accepted fixes are {:.0f} m (rms) from the fused positions and claim {:.2g} m: the receiver is far "
      "worse than it claims, or the odometry is wrong in places (slips, loses its sign in reverse, lags): compare "
      "both in the report",
      far, accepted, std::sqrt(squares / far), claim_m));
}

/// A few wrong readings of a sensor without a loss bend the drive, and the blame falls on others.
void check_sensors(const std::vector<evaluation::SourceResiduals>& sources,
                   std::vector<std::string>& warnings) {
  constexpr std::size_t kFewest = 10;
  constexpr double kTooLarge = 2;
  for (const evaluation::SourceResiduals& source : sources) {
    const bool is_sensor = source.kind != "odometry" && source.kind != "gnss";
    if (!is_sensor || source.robust > 0 || source.measurements < kFewest || !(source.rms > kTooLarge))
      continue;
    warnings.push_back(fmt::format(
        "the {} readings of {} are {:.2g} times as far from the result as their sigmas say, the worst one {:.2g} "
        "times: some are wrong, or the sigmas are too small; the sensor's 'loss: \"cauchy:1\"' leaves out those "
        "that are wrong",
        source.measurements, source.source, source.rms, source.largest));
  }
}

/// A narrow loss takes weight from errors that are no larger than their sigmas too; they are not meant.
void check_weights(const std::vector<evaluation::SourceResiduals>& sources,
                   std::vector<std::string>& warnings) {
  for (const evaluation::SourceResiduals& source : sources) {
    if (source.robust == 0 || 3 * source.down_weighted <= source.robust || source.rms <= 1) continue;
    warnings.push_back(fmt::format(
        "the loss takes more than half of its weight from {} of {} measurements of {} ({:.0f} %): what is left "
        "may be a chance agreement: {}",
        source.down_weighted, source.robust, source.source,
        100.0 * static_cast<double>(source.down_weighted) / static_cast<double>(source.robust), kRemedy));
  }
}

/// An offset that stays in the axes of the vehicle while it turns is one of two points of it, and no error.
void check_reference(const evaluation::Evaluation& evaluation, std::vector<std::string>& warnings) {
  constexpr double kLeast_m = 0.2;
  constexpr double kDeviations = 5;
  constexpr double kOneWay = 0.8;  // a mean direction of this length: it is an offset in the frame as well
  const evaluation::TrackMetrics& track = evaluation.truth->fused.track;
  const double offset_m = std::hypot(track.along.mean, track.cross.mean);
  const double deviation_m = std::hypot(track.along.deviation, track.cross.deviation);
  if (!(offset_m > std::max(kLeast_m, kDeviations * deviation_m))) return;
  Eigen::Vector2d directions = Eigen::Vector2d::Zero();
  double count = 0;
  for (const evaluation::EpochResult& epoch : evaluation.epochs) {
    if (!epoch.direction_rad) continue;
    directions += Eigen::Vector2d(std::cos(*epoch.direction_rad), std::sin(*epoch.direction_rad));
    ++count;
  }
  if (!(directions.norm() < kOneWay * count)) return;
  const double ahead_m = -track.along.mean;
  const double left_m = -track.cross.mean;
  warnings.push_back(fmt::format(
      "the truth is always {:.2f} m {} the fused position and {:.2f} m to its {}: if it is that of another point of "
      "the vehicle, state 'truth: {{reference: [{:.2f}, {:.2f}]}}' (added to what is stated); else the 'antenna' of "
      "the receiver",
      std::abs(ahead_m), ahead_m < 0 ? "behind" : "ahead of", std::abs(left_m), left_m < 0 ? "right" : "left",
      ahead_m, left_m));
}

}  // namespace

std::vector<std::string> warnings_of_result(const std::vector<evaluation::StateReport>& states,
                                            const drive::FusionSettings& modeled,
                                            const drive::NoiseEstimate& noise,
                                            const evaluation::Evaluation& evaluation) {
  std::vector<std::string> warnings;
  check_states(states, *modeled.calibration, warnings);
  check_noise(noise, warnings);
  check_innovations(evaluation.post_fit, warnings);
  check_distances(evaluation.epochs, warnings);
  check_sensors(evaluation.residuals, warnings);
  check_weights(evaluation.residuals, warnings);
  if (!evaluation.truth) return warnings;
  check_qualities(evaluation, warnings);
  check_reference(evaluation, warnings);
  const double fused_m = evaluation.truth->fused.position.rmse_m;
  const evaluation::PositionMetrics& raw = evaluation.truth->gnss.position;
  if (raw.are_truth())
    warnings.push_back(
        "the fixes are the truth, to a millimetre: the same log seems to be stated as 'gnss' and 'truth', and "
        "nothing can be said against it; state another 'truth', or none");
  else if (fused_m > kWorseThanRaw * raw.rmse_m)
    warnings.push_back(
        fmt::format("fused positions are {:.1f} times as far from the truth as raw GNSS (RMSE): {}",
                    fused_m / raw.rmse_m, kRemedy));
  return warnings;
}

}  // namespace waymark::program

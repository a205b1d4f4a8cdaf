#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/report/drive/verdict.hpp>

namespace waymark::report {
namespace {

using Innovations = evaluation::InnovationStatistics;

/// A factor between stated and found errors that is no cause for doubt: errors of GNSS last, so a
/// drive has few independent ones.
constexpr double kFits = 1.5;
constexpr double kFarOff = 2.5;

/// Returns how many times as large the errors are as their covariances say.
double times_as_large(const Innovations& nis) {
  return std::sqrt(nis.mean / Innovations::kExpectedMean);
}

/// Describes what became worse, because a summary must not only praise.
std::string describe_losses(const evaluation::Improvement& i) {
  constexpr double kWorthTelling = -2;  // percent
  std::string text;
  for (const auto& [name, percent] :
       {std::pair{"the mean offset (Acc)", i.accuracy_percent},
        std::pair{"the spread (Prec)", i.precision_percent},
        std::pair{"the largest error (Max)", i.max_percent}, std::pair{"the median", i.median_percent}}) {
    if (percent < kWorthTelling)
      text += fmt::format("{} {} by {:.0f} %", text.empty() ? " Worse:" : ",", name, -percent);
  }
  return text.empty() ? text : text + ".";
}

/// Tells whether a few wild fixes make a mean large, while the others are as their covariances say.
bool few_are_wild(const Innovations& nis) {
  constexpr double kMostInside = 0.9;
  return times_as_large(nis) > kFits && nis.fraction_inside >= kMostInside;
}

drawing::Verdict kind_of(const Innovations& nis) {
  const double factor = times_as_large(nis);
  if (few_are_wild(nis)) return drawing::Verdict::none;
  if (!(factor > 0)) return drawing::Verdict::none;
  if (factor <= kFits && factor >= 1 / kFits) return drawing::Verdict::better;
  return factor > kFarOff ? drawing::Verdict::worse : drawing::Verdict::none;
}

std::string describe_prediction(const ReportedDrive& drive) {
  const evaluation::Evaluation& e = drive.evaluation;
  if (e.withheld_fixes)
    return fmt::format(
        " At {} withheld fixes the fused positions are off by {:.3f} m (RMSE, with the noise of the fixes).",
        e.withheld, e.withheld_fixes->position.rmse_m);
  if (!e.held_out) return {};
  const evaluation::HeldOut& held = *e.held_out;
  std::string text = fmt::format(
      " A second fusion predicts {} fixes, which were kept out for {:g} s each time, to {:.3f} m "
      "(RMSE, with the noise of the fixes",
      held.fused().at_fixes.count, held.run_s, held.fused().at_fixes.rmse_m);
  if (std::isfinite(held.expected_rmse_m))
    text += fmt::format("; {:.3f} m is expected", held.expected_rmse_m);
  text += ").";
  // Odometry predicts the antenna, not the fix with its lasting error.
  for (const evaluation::WithheldMetrics& way : held.predictions) {
    if (held.fused().label == "fused" && way.label == "dead reckoning" && way.at_fixes.count > 0)
      text += fmt::format(" Odometry alone predicts them to {:.3f} m.", way.at_fixes.rmse_m);
  }
  return text;
}

/// Returns the innovations of fixes that are not in the graph if there are any, else the residuals.
const Innovations& judged_innovations(const evaluation::Evaluation& e) {
  if (e.held_out && e.held_out->innovation.count > 0) return e.held_out->innovation;
  return e.prediction.count > 0 ? e.prediction : e.post_fit;
}

std::string describe_sigma(const ReportedDrive& drive) {
  std::vector<double> sigmas;
  const evaluation::EpochResult* weakest = nullptr;
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    const std::optional<double> sigma = epoch.sigma_m();
    if (!sigma || !std::isfinite(*sigma)) continue;
    sigmas.push_back(*sigma);
    if (weakest == nullptr || *sigma > *weakest->sigma_m()) weakest = &epoch;
  }
  if (weakest == nullptr) return {};
  std::sort(sigmas.begin(), sigmas.end());
  return fmt::format(
      " The stated sigma of the positions is {:.3f} m in the median, below {:.3f} m at 95 % of the epochs, "
      "and {:.3f} m at its weakest, {:.0f} s after the start.",
      evaluation::sorted_median(sigmas), evaluation::nearest_rank_quantile(sigmas, 0.95), sigmas.back(),
      drive.seconds(weakest->stamp));
}

/// Returns the sentences about what went wrong.
std::string describe_trouble(const ReportedDrive& drive) {
  std::string text;
  const std::size_t warnings = stated(drive, "warning").size();
  if (warnings > 0) text = fmt::format("{} {}. ", warnings, warnings == 1 ? "warning" : "warnings");
  if (drive.optimization != nullptr && !drive.optimization->summary.converged())
    text += "No minimum was reached: " + drive.optimization->summary.message + ". ";
  return text;
}

DriveVerdict verdict_without_truth(const ReportedDrive& drive) {
  DriveVerdict verdict{.text = describe_trouble(drive) + "There is no truth to compare with."};
  verdict.text += describe_prediction(drive);
  const Innovations& nis = judged_innovations(drive.evaluation);
  if (nis.count > 0 && std::isfinite(nis.mean)) {
    verdict.text += " The mean NIS is " + describe_nis(nis) + ".";
    verdict.kind = kind_of(nis);
  }
  verdict.text += describe_sigma(drive);
  return verdict;
}

}  // namespace

std::vector<std::string> stated(const ReportedDrive& drive, std::string_view key) {
  std::vector<std::string> texts;
  for (const auto& [name, text] : drive.document.provenance) {
    if (name == key) texts.push_back(text);
  }
  return texts;
}

std::string describe_nis(const evaluation::InnovationStatistics& nis) {
  const double factor = times_as_large(nis);
  const std::string words =
      few_are_wild(nis) ? fmt::format("a few fixes are wild, and {:.0f} % are inside their 95 % region",
                                      100 * nis.fraction_inside)
      : factor > kFits  ? fmt::format("the errors are {:.1f} times as large as their covariances say", factor)
      : factor < 1 / kFits
          ? fmt::format("the errors are only {:.2f} times as large as their covariances say", factor)
          : "the stated covariances fit";
  return fmt::format("{:.2f}, and 2 is right: {}", nis.mean, words);
}

DriveVerdict verdict_of(const ReportedDrive& drive) {
  if (!drive.evaluation.truth) return verdict_without_truth(drive);
  const evaluation::TruthEvaluation& truth = *drive.evaluation.truth;
  const double better = truth.improvement.rmse_percent;
  DriveVerdict verdict{.text = describe_trouble(drive)};
  if (truth.gnss.position.count == 0) {  // a drive without a receiver
    verdict.text +=
        fmt::format("Fused positions: RMSE {:.3f} m, largest error {:.3f} m, at {} epochs.",
                    truth.fused.position.rmse_m, truth.fused.position.max_m, truth.fused.position.count);
    return verdict;
  }
  const bool comparable = !truth.gnss.position.are_truth();
  if (comparable) verdict.kind = better >= 0 ? drawing::Verdict::better : drawing::Verdict::worse;
  const std::string how =
      comparable ? fmt::format("{:.0f} % {} than", std::abs(better), better >= 0 ? "better" : "worse")
                 : "not comparable with";
  verdict.text += fmt::format(
      "Fused positions are {} raw GNSS: RMSE {:.3f} m against {:.3f} m, largest error {:.3f} m "
      "against {:.3f} m, at {} epochs.",
      how, truth.fused.position.rmse_m, truth.gnss.position.rmse_m, truth.fused.position.max_m,
      truth.gnss.position.max_m, truth.fused.position.count);
  if (comparable) verdict.text += describe_losses(truth.improvement);
  return verdict;
}

}  // namespace waymark::report

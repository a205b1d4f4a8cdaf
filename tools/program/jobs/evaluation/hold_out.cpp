#include <waymark/tools/program/jobs/evaluation/hold_out.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/left_out/outages.hpp>
#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>
#include <waymark/tools/program/jobs/evaluation/lasting_innovations.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>

namespace waymark::program {
namespace {

constexpr double kRun_s = 5;
constexpr double kEvery_s = 50;
constexpr std::size_t kFewestJudged = 10;
constexpr std::size_t kMostVertices = 300'000;
constexpr const char* kNotJudged = "the result is not judged by fixes that are kept out";

/// Returns the drive without the fixes in the middle of every kEvery_s. Runs begin by the clock, so
/// that all receivers lose the same ones.
drive::PreparedDrive without_runs(const drive::PreparedDrive& drive) {
  drive::PreparedDrive rest = drive;
  const Stamp first = drive.fixes.front().stamp;
  for (Fix& fix : rest.fixes) {
    const double phase = std::fmod(seconds_between(first, fix.stamp), kEvery_s) - 0.5 * kEvery_s;
    if (phase < 0 || phase >= kRun_s) continue;
    fix.status = FixStatus::withheld;
    fix.reason = "withheld";
  }
  return rest;
}

/// Takes the fixes that the first fusion did not accept out of the judgement.
void judge_accepted_only(const formats::GraphDocument& first, formats::GraphDocument& second) {
  std::set<std::pair<std::int64_t, int>> accepted;
  for (const Fix& fix : first.fixes)
    if (fix.status == FixStatus::accepted) accepted.emplace(fix.stamp.nanoseconds, fix.source);
  for (Fix& fix : second.fixes) {
    if (fix.status == FixStatus::withheld && !accepted.contains({fix.stamp.nanoseconds, fix.source}))
      fix.status = FixStatus::rejected;
  }
}

evaluation::HeldOut judged(const formats::GraphDocument& document, const evaluation::Evaluation& evaluated) {
  evaluation::HeldOut held{.run_s = kRun_s, .every_s = kEvery_s, .predictions = evaluated.at_withheld};
  held.innovation = evaluated.prediction;
  double promised = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < document.fixes.size(); ++i) {
    if (document.fixes[i].status != FixStatus::withheld) continue;
    const evaluation::EpochResult& epoch = evaluated.epochs[i];
    held.stamps.push_back(epoch.stamp);
    held.errors_m.push_back(epoch.fix_residual_m->norm());
    if (!epoch.position_covariance) continue;
    promised += epoch.fix_sigma_m.squaredNorm() + epoch.position_covariance->trace();
    ++count;
  }
  if (count > 0 && held.innovation.count > 0)
    held.expected_rmse_m = std::sqrt(promised / static_cast<double>(count));
  return held;
}

/// Tells whether nothing else judges the result: truth, or fixes that the user withholds.
bool needs_hold_out(const drive::PreparedDrive& drive) {
  const auto withheld = [](const Fix& fix) { return fix.status == FixStatus::withheld; };
  return drive.truth.empty() && !drive.fixes.empty() &&
         std::none_of(drive.fixes.begin(), drive.fixes.end(), withheld);
}

}  // namespace

std::optional<evaluation::HeldOut> hold_out(const drive::PreparedDrive& drive,
                                            const drive::ModeledDrive& modeled, const TypeRegistry& registry,
                                            const Console& console) {
  if (!needs_hold_out(drive) || console.cancel()) return std::nullopt;
  if (modeled.document.graph.vertex_count() > kMostVertices) {
    console.note(fmt::format("{}: the graph has more than {} vertices; --withhold N judges it", kNotJudged,
                             kMostVertices));
    return std::nullopt;
  }
  const drive::PreparedDrive rest = without_runs(drive);
  drive::FusionSettings settings = modeled.settings;
  settings.estimates_noise = false;
  settings.minimization.covariances = "fixes";
  console.progress("fusing again without a tenth of the fixes");
  try {
    drive::FusedDrive fused = drive::fuse(rest, settings, registry, {.cancel = &console.cancel()});
    console.end_progress();
    if (!fused.minimum.summary.converged()) {
      console.note(std::string(kNotJudged) + ": the second fusion reached no minimum");
      return std::nullopt;
    }
    formats::GraphDocument& document = fused.model.document;
    judge_accepted_only(modeled.document, document);
    std::vector<evaluation::Prediction> further;
    drive::PosesAtWithheld lasting = drive::with_lasting_errors(document, fused.model.modelings);
    if (!lasting.poses.empty()) further.push_back(as_prediction("with lasting errors", std::move(lasting)));
    const evaluation::Evaluation evaluated = evaluate_document(document, {}, further);
    if (evaluated.withheld < kFewestJudged) {
      console.note(fmt::format("{}: only {} fixes could be kept out, and {} are needed", kNotJudged,
                               evaluated.withheld, kFewestJudged));
      return std::nullopt;
    }
    evaluation::HeldOut held = judged(document, evaluated);
    if (const auto lasting_nis = lasting_innovations(document, fused.model.modelings)) {
      held.innovation = lasting_nis->statistics;
      held.expected_rmse_m = lasting_nis->expected_rmse_m;
    }
    return held;
  } catch (const InputError& error) {
    console.end_progress();
    console.note(std::string(kNotJudged) + ": " + error.what());
    return std::nullopt;
  }
}

}  // namespace waymark::program

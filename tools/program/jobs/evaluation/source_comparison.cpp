#include <waymark/tools/program/jobs/evaluation/source_comparison.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/estimation/noise_spread.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/drive/left_out/without_source.hpp>
#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::program {
namespace {

using Key = std::pair<std::int64_t, int>;
using Covariances = std::map<Key, Eigen::Matrix2d>;

Key key_of(const Fix& fix) {
  return {fix.stamp.nanoseconds, fix.source};
}

Covariances covariances_of(const formats::GraphDocument& document) {
  Covariances covariances;
  const auto at_fixes = drive::evaluated_covariances(document);
  for (std::size_t i = 0; i < at_fixes.size(); ++i)
    if (at_fixes[i]) covariances[key_of(document.fixes[i])] = *at_fixes[i];
  return covariances;
}

double median_sigma(const Covariances& covariances) {
  std::vector<double> sigmas;
  for (const auto& [key, covariance] : covariances) sigmas.push_back(std::sqrt(0.5 * covariance.trace()));
  return sigmas.empty() ? evaluation::kUndefined : upper_median(std::move(sigmas));
}

double share_lost(const Covariances& all, const Covariances& without) {
  double sum = 0;
  double count = 0;
  for (const auto& [key, covariance] : all) {
    const auto same = without.find(key);
    if (same == without.end()) continue;
    sum += 1 - 0.5 * (covariance * same->second.inverse()).trace();
    ++count;
  }
  return count > 0 ? sum / count : evaluation::kUndefined;
}

/// Returns the rms distance of fixes of one source from the fused antenna.
/// @param status only these fixes; empty: all that are not rejected
double residual_rms(const formats::GraphDocument& document, int source, std::optional<FixStatus> status) {
  const std::vector<Eigen::Vector3d> poses = drive::poses_of_fixes(document);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Fix& fix = document.fixes[i];
    if (fix.source != source || (status && fix.status != *status)) continue;
    sum += (fix.position - poses[i].head<2>() - rotate(poses[i][2], fix.antenna_seen_m())).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : evaluation::kUndefined;
}

double rms(const std::vector<double>& squares) {
  double sum = 0;
  for (const double square : squares) sum += square;
  return squares.empty() ? evaluation::kUndefined : std::sqrt(sum / static_cast<double>(squares.size()));
}

/// Returns the share of a time that stamps cover: up to 2.5 usual intervals between two of them.
double availability(std::vector<Stamp> stamps, Stamp from, Stamp to) {
  if (stamps.size() < 2) return 0;
  std::sort(stamps.begin(), stamps.end());
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    intervals.push_back(seconds_between(stamps[i - 1], stamps[i]));
  const double usual = upper_median(intervals);
  double covered = usual;
  for (const double interval : intervals) covered += interval <= 2.5 * usual ? interval : usual;
  return std::min(1.0, covered / std::max(seconds_between(from, to), 1e-9));
}

std::vector<Stamp> stamps_of(const drive::PreparedDrive& drive, const drive::SourceOfDrive& source) {
  std::vector<Stamp> stamps;
  for (const drive::PreparedOdometry& odometry : drive.relative)
    if (odometry.name == source.name)
      for (const OdometrySample& sample : odometry.samples) stamps.push_back(sample.stamp);
  if (drive.relative.empty() && source.kind == "odometry")
    for (const OdometrySample& sample : drive.odometry) stamps.push_back(sample.stamp);
  for (const Fix& fix : drive.fixes)
    if (drive.receivers[static_cast<std::size_t>(fix.source)].name == source.name)
      stamps.push_back(fix.stamp);
  for (const drive::PreparedSensor& sensor : drive.sensors)
    if (sensor.source == source.name)
      stamps.insert(stamps.end(), sensor.readings.stamps.begin(), sensor.readings.stamps.end());
  return stamps;
}

/// Returns Fix::source of a receiver; -1 for another source.
int index_of(const drive::PreparedDrive& drive, const drive::SourceOfDrive& source) {
  for (std::size_t i = 0; i < drive.receivers.size(); ++i)
    if (source.kind == "gnss" && drive.receivers[i].name == source.name) return static_cast<int>(i);
  return -1;
}

/// What a source says with all others in the graph.
evaluation::SourceReport report_with(const drive::PreparedDrive& drive, const drive::SourceOfDrive& source,
                                     const formats::GraphDocument& document,
                                     const evaluation::Evaluation& evaluated) {
  evaluation::SourceReport report{.name = source.name, .kind = source.kind};
  const std::vector<Stamp> stamps = stamps_of(drive, source);
  report.readings = stamps.size();
  report.availability = availability(stamps, drive.odometry.front().stamp, drive.odometry.back().stamp);
  if (source.kind != "gnss") return report;
  std::vector<double> raw;
  for (std::size_t i = 0; i < document.fixes.size(); ++i) {
    const Fix& fix = document.fixes[i];
    if (drive.receivers[static_cast<std::size_t>(fix.source)].name != source.name) continue;
    report.accepted += fix.status == FixStatus::accepted;
    const auto& offset = evaluated.epochs[i].gnss_offset_m;
    if (offset) raw.push_back(offset->squaredNorm());
  }
  report.raw_rmse_m = rms(raw);
  report.residual_rms_m = residual_rms(document, index_of(drive, source), FixStatus::accepted);
  return report;
}

/// Fuses the drive without a source, and adds what differs.
/// @param spread of the noise, which is the same with all sources
void add_result_without(const drive::PreparedDrive& drive, const drive::SourceOfDrive& source,
                        const drive::FusionSettings& settings, const Covariances& all,
                        std::span<const drive::PoseSpread> spread, const TypeRegistry& registry,
                        evaluation::SourceReport& report) {
  const drive::PreparedDrive rest = drive::without_source(drive, source);
  drive::FusedDrive fused = drive::fuse(rest, settings, registry);
  if (!fused.minimum.summary.converged()) throw InputError(fused.minimum.summary.message);
  formats::GraphDocument& document = fused.model.document;
  drive::widen(document.covariances, document.graph, spread);
  const Covariances covariances = covariances_of(document);
  report.without_sigma_m = median_sigma(covariances);
  report.share = share_lost(all, covariances);
  const evaluation::Evaluation evaluated = evaluate_document(document, rest.truth, {});
  if (evaluated.truth) report.without_rmse_m = evaluated.truth->fused.position.rmse_m;
  report.without_residual_rms_m = residual_rms(document, index_of(drive, source), std::nullopt);
}

}  // namespace

evaluation::SourceComparison compare_sources(const drive::PreparedDrive& drive, drive::ModeledDrive& modeled,
                                             const evaluation::Evaluation& evaluated,
                                             const TypeRegistry& registry, const Console& console) {
  evaluation::SourceComparison comparison;
  const std::vector<drive::SourceOfDrive> sources = drive::sources_of(drive);
  if (sources.size() < 3) return comparison;
  const Covariances all = covariances_of(modeled.document);
  comparison.sigma_m = median_sigma(all);
  if (evaluated.truth) comparison.rmse_m = evaluated.truth->fused.position.rmse_m;
  drive::FusionSettings settings = modeled.settings;
  settings.estimates_noise = false;
  settings.minimization.covariances = "fixes";
  for (const drive::SourceOfDrive& source : sources) {
    evaluation::SourceReport& report =
        comparison.sources.emplace_back(report_with(drive, source, modeled.document, evaluated));
    if (!drive::can_do_without(drive, source) || console.cancel()) continue;
    console.progress("without " + source.name);
    try {
      add_result_without(drive, source, settings, all, modeled.noise.spread, registry, report);
    } catch (const InputError& error) {
      warn("there is no result without " + source.name + ": " + error.what(), modeled.document, console);
    }
  }
  console.end_progress();
  return comparison;
}

}  // namespace waymark::program

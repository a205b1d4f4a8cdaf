#include <waymark/tools/reproduction/experiment/drive_result.hpp>

namespace waymark::reproduction {
namespace {

MetricsColumn with_average(std::vector<std::optional<PaperMetrics>> of_drive) {
  MetricsColumn column{std::move(of_drive), std::nullopt};
  PaperMetrics sum;
  double count = 0;
  for (const auto& metrics : column.of_drive) {
    if (!metrics) continue;
    sum.max_m += metrics->max_m;
    sum.accuracy_m += metrics->accuracy_m;
    sum.precision_m += metrics->precision_m;
    ++count;
  }
  if (count > 0) column.average = {sum.max_m / count, sum.accuracy_m / count, sum.precision_m / count};
  return column;
}

}  // namespace

std::string DriveResult::label() const {
  return dataset > 0 ? std::to_string(dataset) : name;
}

DriveResult study_drive(int dataset, StudiedDrive& drive, const std::vector<Setting>& settings,
                        const Laboratory& laboratory) {
  DriveResult result;
  result.dataset = dataset;
  result.name = drive.drive().name;
  result.simulated = dataset > 0 || result.name.starts_with("Simulated");
  for (const drive::OdometryConfig& source : drive.description().odometry)
    for (const drive::LogConfig& log : source.logs)
      result.imitated_odometry = result.imitated_odometry || log.file.find("imitated") != std::string::npos;
  const auto& odometry = drive.drive().odometry;
  result.duration_s = seconds_between(odometry.front().stamp, odometry.back().stamp);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const double dt = seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
    result.distance_m += 0.5 * std::abs(odometry[i - 1].speed_mps + odometry[i].speed_mps) * dt;
  }
  result.fixes = drive.drive().fixes.size();
  result.odometry_samples = odometry.size();
  result.outcomes = run_settings(drive, settings, laboratory);
  return result;
}

std::optional<evaluation::PositionMetrics> metrics_of(const DriveResult& drive, const std::string& system) {
  if (system == "gnss") {  // the same in all settings with the antenna's lever arm
    for (const Outcome& outcome : drive.outcomes) {
      if (outcome.evaluation.truth && outcome.setting.fusion.lever_arm)
        return outcome.evaluation.truth->gnss.position;
    }
    return std::nullopt;
  }
  const Outcome* outcome = find_outcome(drive.outcomes, system);
  if (outcome == nullptr || !outcome->evaluation.truth) return std::nullopt;
  return outcome->evaluation.truth->fused.position;
}

std::optional<evaluation::ConsistencyStatistics> consistency_of(const DriveResult& drive,
                                                                const std::string& setting) {
  const Outcome* outcome = find_outcome(drive.outcomes, setting);
  if (outcome == nullptr || !outcome->evaluation.truth) return std::nullopt;
  return outcome->evaluation.truth->consistency;
}

std::string labelled(const DriveResult& drive) {
  std::string label = drive.label();
  if (drive.simulated && !label.starts_with("Simulated")) label += " (simulated)";
  if (drive.imitated_odometry) label += " (imitated odometry)";
  return label;
}

MetricsColumn metrics_column(const std::vector<DriveResult>& drives, const std::string& system) {
  std::vector<std::optional<PaperMetrics>> of_drive;
  for (const DriveResult& drive : drives) {
    const auto metrics = metrics_of(drive, system);
    of_drive.push_back(
        metrics ? std::optional(PaperMetrics{metrics->max_m, metrics->accuracy_m, metrics->precision_m})
                : std::nullopt);
  }
  return with_average(std::move(of_drive));
}

MetricsColumn paper_column(const std::vector<DriveResult>& drives, const std::string& system) {
  std::vector<std::optional<PaperMetrics>> of_drive;
  for (const DriveResult& drive : drives)
    of_drive.push_back(drive.dataset > 0 ? paper_metrics(drive.dataset, system) : std::nullopt);
  return with_average(std::move(of_drive));
}

PaperMetrics average_improvement(const MetricsColumn& gnss, const MetricsColumn& fused) {
  const PaperMetrics undefined{evaluation::kUndefined, evaluation::kUndefined, evaluation::kUndefined};
  const PaperMetrics raw = gnss.average.value_or(undefined);
  const PaperMetrics after = fused.average.value_or(undefined);
  return {evaluation::improvement_percent(raw.max_m, after.max_m),
          evaluation::improvement_percent(raw.accuracy_m, after.accuracy_m),
          evaluation::improvement_percent(raw.precision_m, after.precision_m)};
}

}  // namespace waymark::reproduction

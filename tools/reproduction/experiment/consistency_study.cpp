#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/reproduction/experiment/consistency_study.hpp>
#include <waymark/tools/reproduction/tables/convergence_tables.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::reproduction {
namespace {

constexpr const char* kTogether = "together";

using Drives = std::vector<DriveResult>;

/// The results of a setting on the drives of one preset, or on all drives.
struct Pool {
  std::vector<double> nees;
  std::vector<double> coverage_percent;
  std::vector<double> squared_error;  ///< m^2, one per drive
  int drives = 0;                     ///< with or without a result
};

Pool pool(const Drives& drives, const std::string& group, const std::string& setting) {
  Pool pool;
  for (const DriveResult& drive : drives) {
    if (group != kTogether && drive.group != group) continue;
    ++pool.drives;
    const auto stated = consistency_of(drive, setting);
    const auto position = metrics_of(drive, setting);
    if (!stated || !position) continue;
    pool.nees.push_back(stated->nees_mean);
    pool.coverage_percent.push_back(100 * stated->coverage);
    pool.squared_error.push_back(position->rmse_m * position->rmse_m);
  }
  return pool;
}

const char* model_name(const Setting& setting) {
  return setting.name == kDefaultModel ? "default" : "white noise with gate";
}

/// Returns the presets in the order of their first drives, and kTogether.
std::vector<std::string> groups_of(const Drives& drives) {
  std::vector<std::string> groups;
  for (const DriveResult& drive : drives) {
    if (std::find(groups.begin(), groups.end(), drive.group) == groups.end()) groups.push_back(drive.group);
  }
  groups.emplace_back(kTogether);
  return groups;
}

text::Table pooled_table(const Drives& drives) {
  text::Table table;
  table.file = "consistency";
  table.title = "Stated against actual errors, pooled over simulated drives";
  table.columns = {"preset",    "model",          "drives",        "judged",
                   "mean NEES", "standard error", "95 % coverage", "coverage standard error",
                   "RMSE"};
  for (const std::string& group : groups_of(drives)) {
    for (const Setting& setting : consistency_settings()) {
      const Pool of = pool(drives, group, setting.name);
      if (of.drives == 0) continue;
      const PooledMean nees = pooled_mean(of.nees);
      const PooledMean coverage = pooled_mean(of.coverage_percent);
      table.rows.push_back({group, model_name(setting), std::to_string(of.drives),
                            std::to_string(of.nees.size()), text::decimals(nees.mean, 2),
                            text::decimals(nees.standard_error, 2), text::decimals(coverage.mean, 1),
                            text::decimals(coverage.standard_error, 1),
                            text::decimals(std::sqrt(pooled_mean(of.squared_error).mean), 2)});
    }
  }
  table.notes = {
      "Every drive counts once. NEES: error against truth in units of the stated covariance, 2 if "
      "the covariances are consistent. Standard errors are over the drives, because the epochs of "
      "one drive have common errors.",
      "judged: number of drives with a minimum and covariances."};
  for (const DriveResult& drive : drives) {
    for (const Outcome& outcome : drive.outcomes) {
      const std::string& why = outcome.failure.empty() ? outcome.ending.message : outcome.failure;
      if (!outcome.failure.empty() || !outcome.ending.converged)
        table.notes.push_back(drive.name + ", " + outcome.setting.name + ": " + why);
    }
  }
  return table;
}

text::Table drive_table(const Drives& drives) {
  text::Table table;
  table.file = "consistency_drives";
  table.title = "Each of the simulated drives";
  table.columns = {"drive", "RMSE raw"};
  for (const Setting& setting : consistency_settings()) {
    for (const char* figure : {"NEES", "95 % coverage", "RMSE"})
      table.columns.push_back(fmt::format("{} {}", figure, model_name(setting)));
  }
  for (const DriveResult& drive : drives) {
    const auto rmse = [&](const std::string& system) {
      const auto metrics = metrics_of(drive, system);
      return text::decimals(metrics ? metrics->rmse_m : evaluation::kUndefined, 2);
    };
    text::Row row{drive.name, rmse("gnss")};
    for (const Setting& setting : consistency_settings()) {
      const auto stated = consistency_of(drive, setting.name);
      row.push_back(text::decimals(stated ? stated->nees_mean : evaluation::kUndefined, 2));
      row.push_back(text::decimals(stated ? 100 * stated->coverage : evaluation::kUndefined, 0));
      row.push_back(rmse(setting.name));
    }
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace

std::vector<Draw> consistency_draws(std::span<const std::string> presets, int count) {
  std::vector<Draw> draws;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    draws.push_back({presets[i % presets.size()], kFirstStudySeed + i});
  return draws;
}

std::vector<Setting> consistency_settings() {
  Setting white = our_settings().front();
  white.objective.clear();  // their ends are not compared
  return {default_setting(), white};
}

PooledMean pooled_mean(const std::vector<double>& of_drives) {
  const evaluation::ScalarStatistics statistics = evaluation::scalar_statistics(of_drives);
  return {statistics.mean, statistics.deviation / std::sqrt(static_cast<double>(statistics.count))};
}

ReproductionReport consistency_report(const Drives& drives, const std::string& introduction) {
  ReproductionReport report;
  report.name = "consistency";
  report.title = "Consistency of the covariances (NEES)";
  report.introduction = introduction;
  report.tables = {pooled_table(drives), drive_table(drives)};
  report.runs = run_table(drives);
  return report;
}

}  // namespace waymark::reproduction

#include <waymark/tools/reproduction/experiment/ablation.hpp>
#include <waymark/tools/reproduction/experiment/consistency_study.hpp>
#include <waymark/tools/reproduction/experiment/experiment.hpp>

namespace waymark::reproduction {
namespace {

std::vector<Setting> joined(std::initializer_list<std::vector<Setting>> lists) {
  std::vector<Setting> all;
  for (const std::vector<Setting>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

const Way kEveryTenth{"every 10th fix", 10};
const Way kShortOutages{"outages of 30 s every 240 s", 0, {30, 240}};
const Way kLongOutages{"outages of 60 s every 240 s", 0, {60, 240}};

}  // namespace

Experiment paper_experiment() {
  const std::vector<Setting> evaluated = joined({paper_settings(), our_settings(), {default_setting()}});
  return {.settings = joined({evaluated, cause_settings(), minimum_settings(), convergence_settings()}),
          .withheld_settings = joined({evaluated, minimum_settings()}),
          .ways = {kEveryTenth, kShortOutages, kLongOutages},
          .report = make_report};
}

Experiment ablation_experiment() {
  return {.settings = ablation_settings(),
          .truth_only = true,
          .withheld_settings = ablation_settings(),
          .ways = {kLongOutages},
          .report = ablation_report};
}

Experiment consistency_experiment() {
  return {.settings = consistency_settings(), .report = consistency_report};
}

std::size_t run_count(const Experiment& experiment, bool has_truth) {
  const std::size_t whole = has_truth || !experiment.truth_only ? experiment.settings.size() : 0;
  return has_truth ? whole : whole + experiment.ways.size() * experiment.withheld_settings.size();
}

DriveResult run_experiment(const Experiment& experiment, int dataset, drive::DriveDescription description,
                           const drive::DriveLogs& logs, const Laboratory& laboratory) {
  for (drive::GnssConfig& source : description.gnss) source.withhold_every = 0;
  description.outage = {};
  StudiedDrive drive(description, logs, laboratory.registry);
  const bool has_truth = !drive.drive().truth.empty();
  const bool whole = has_truth || !experiment.truth_only;
  DriveResult result =
      study_drive(dataset, drive, whole ? experiment.settings : std::vector<Setting>(), laboratory);
  if (has_truth) return result;
  for (const Way& way : experiment.ways) {
    for (drive::GnssConfig& source : description.gnss) source.withhold_every = way.withhold_every;
    description.outage = way.outage;
    StudiedDrive gapped(description, logs, laboratory.registry);
    Laboratory told = laboratory;
    if (laboratory.progress)
      told.progress = [&](const std::string& setting) { laboratory.progress(way.name + ", " + setting); };
    result.withheld.push_back({way.name, run_settings(gapped, experiment.withheld_settings, told)});
  }
  return result;
}

}  // namespace waymark::reproduction

#include <waymark/tools/program/fleet/fleet_results.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/fleet/page/fleet_page.hpp>
#include <waymark/tools/fleet/page/groups.hpp>
#include <waymark/tools/fleet/table/sqlite_file.hpp>
#include <waymark/tools/program/terminal/progress.hpp>
#include <waymark/tools/text/json_number.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

using fleet::DriveRecord;
using fleet::DriveState;
using fleet::Fleet;

constexpr std::size_t kRecent = 100;  // drives that the rate is taken of

/// Returns drives per minute, from the drives that ended last; nothing if too few have.
std::optional<double> drives_per_minute(const Fleet& fleet) {
  std::vector<double> ends;
  for (const DriveRecord& record : fleet.records) ends.push_back(record.cost.ended_s);
  std::sort(ends.begin(), ends.end());
  if (ends.size() > kRecent) ends.erase(ends.begin(), ends.end() - kRecent);
  if (ends.size() < 2 || ends.back() <= ends.front()) return std::nullopt;
  return 60 * static_cast<double>(ends.size() - 1) / (ends.back() - ends.front());
}

std::optional<double> remaining_s(const Fleet& fleet) {
  const std::optional<double> rate = drives_per_minute(fleet);
  if (!rate || fleet.waiting() == 0) return std::nullopt;
  return 60 * static_cast<double>(fleet.waiting()) / *rate;
}

text::Table failures(const Fleet& fleet) {
  text::Table table{
      .columns = {"drive", "state", "reason"}, .rows = {}, .notes = {}, .file = {}, .words = true};
  for (const DriveRecord& record : fleet.records)
    if (record.state != DriveState::done)
      table.rows.push_back({record.drive, fleet::to_string(record.state), record.reason});
  return table;
}

nlohmann::ordered_json optional_json(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::string change_word(fleet::FleetChange change) {
  if (change == fleet::FleetChange::none) return "none";
  return change == fleet::FleetChange::worse ? "worse" : "better";
}

nlohmann::ordered_json change_json(const fleet::ChangeOfGroup& change) {
  return {{"worse", change.worse},
          {"better", change.better},
          {"same", change.same},
          {"unjudged", change.unjudged},
          {"grew", change.grew},
          {"shrank", change.shrank},
          {"chance", change.chance},
          {"median_ratio", text::number_or_null(change.median_ratio)},
          {"ratio_low", text::number_or_null(change.ratio_low)},
          {"ratio_high", text::number_or_null(change.ratio_high)}};
}

}  // namespace

std::vector<std::string> write_merged(const Fleet& fleet, const std::string& path, const Console& console) {
  const fleet::FleetFolder folder(path);
  console.progress("merging");
  formats::write_file_atomically(folder.csv(), text::table_csv(fleet::merged_table(fleet)));
  formats::write_file_atomically(folder.sqlite(), fleet::sqlite_bytes(fleet));
  formats::write_file_atomically(folder.costs(), text::table_csv(fleet::cost_table(fleet)));
  const std::vector<std::string> page =
      drawing::write_page(fleet::fleet_page(fleet, WAYMARK_VERSION), path, fleet::FleetFolder::kPage);
  console.end_progress();
  return {page.front(), folder.csv(), folder.sqlite(), folder.costs()};
}

std::string status_text(const Fleet& fleet, const std::string& folder, const text::TextLook& look) {
  std::string text = fmt::format("fleet       {}: {} drives, label {}\n", folder, fleet.plan.drives.size(),
                                 fleet.plan.label);
  const auto line = [&](const char* name, std::size_t count) {
    if (count > 0) text += fmt::format("{:<11} {}\n", name, count);
  };
  line("done", fleet.count(DriveState::done));
  line("no minimum", fleet.count(DriveState::not_converged));
  line("failed", fleet.count(DriveState::failed));
  line("begun", fleet.running);
  line("not ended", fleet.waiting());
  if (const auto rate = drives_per_minute(fleet))
    text += fmt::format("rate        {:.1f} drives per minute\n", *rate);
  if (const auto left = remaining_s(fleet))
    text += fmt::format("left        {} at this rate\n", duration_text(*left));
  if (const text::Table table = failures(fleet); !table.rows.empty())
    text += "\n" + text::table_text(table, look);
  if (const auto groups = fleet::groups_by_modeling(fleet); !groups.empty())
    text += "\n" + text::table_text(fleet::group_table("Errors of the drives", "modeling", groups), look);
  return text;
}

nlohmann::ordered_json status_json(const Fleet& fleet, const std::string& folder,
                                   const std::vector<std::string>& files) {
  nlohmann::ordered_json failed = nlohmann::ordered_json::array();
  for (const DriveRecord& record : fleet.records)
    if (record.state != DriveState::done)
      failed.push_back({{"drive", record.drive},
                        {"state", fleet::to_string(record.state)},
                        {"exit_code", record.exit_code},
                        {"reason", record.reason}});
  return {{"folder", folder},
          {"label", fleet.plan.label},
          {"drives", fleet.plan.drives.size()},
          {"done", fleet.count(DriveState::done)},
          {"not_converged", fleet.count(DriveState::not_converged)},
          {"failed", fleet.count(DriveState::failed)},
          {"begun", fleet.running},
          {"not_ended", fleet.waiting()},
          {"drives_per_minute", optional_json(drives_per_minute(fleet))},
          {"remaining_s", optional_json(remaining_s(fleet))},
          {"failures", std::move(failed)},
          {"files", files}};
}

std::vector<std::string> write_regression(const fleet::Regression& regression, const std::string& folder) {
  formats::make_folder(folder);
  const std::string csv = folder + "/regression.csv";
  formats::write_file_atomically(csv, text::table_csv(fleet::regression_table(regression)));
  const std::vector<std::string> page =
      drawing::write_page(fleet::regression_page(regression, WAYMARK_VERSION), folder, "regression");
  return {page.front(), csv};
}

std::string regression_text(const fleet::Regression& regression, const text::TextLook& look) {
  text::Table table{.title = "Drives that got worse",
                    .columns = {"drive", "modeling", "environment", "change", "old [m]", "new [m]", "reason"},
                    .rows = {}};
  for (const fleet::PairedDrive* pair :
       fleet::pairs_of(regression, {fleet::Change::lost, fleet::Change::worse}))
    table.rows.push_back({pair->drive, pair->modeling, pair->environment, fleet::to_string(pair->change),
                          fmt::format("{:.3f}", pair->old_error_m), fmt::format("{:.3f}", pair->new_error_m),
                          pair->reason});
  std::string text = table.rows.empty() ? "" : text::table_text(table, look) + "\n";
  text += regression.rule.in_words() + "\n\n" + fleet::verdict_sentence(regression) + "\n";
  if (std::isfinite(regression.all.ratio_low))
    text += fmt::format("Median of new error over old error: {:.4f}, with 95 % within {:.4f} and {:.4f}.\n",
                        regression.all.median_ratio, regression.all.ratio_low, regression.all.ratio_high);
  return text;
}

nlohmann::ordered_json regression_json(const fleet::Regression& regression,
                                       const std::vector<std::string>& files) {
  nlohmann::ordered_json drives = nlohmann::ordered_json::array();
  for (const fleet::PairedDrive& pair : regression.pairs)
    drives.push_back({{"drive", pair.drive},
                      {"modeling", pair.modeling},
                      {"environment", pair.environment},
                      {"change", fleet::to_string(pair.change)},
                      {"measure", pair.measure},
                      {"old_error_m", text::number_or_null(pair.old_error_m)},
                      {"new_error_m", text::number_or_null(pair.new_error_m)},
                      {"reason", pair.reason}});
  nlohmann::ordered_json environments = nlohmann::ordered_json::object();
  for (const auto& [name, change] : regression.environments) environments[name] = change_json(change);
  return {{"old", regression.old_label},
          {"new", regression.new_label},
          {"fleet", change_word(regression.fleet())},
          {"rule", regression.rule.in_words()},
          {"all", change_json(regression.all)},
          {"environments", std::move(environments)},
          {"only_old", regression.only_old},
          {"only_new", regression.only_new},
          {"drives", std::move(drives)},
          {"files", files}};
}

ExitCode exit_code_of(const Fleet& fleet) {
  if (fleet.count(DriveState::failed) > 0) return kInputError;
  return fleet.count(DriveState::not_converged) > 0 ? kNotConverged : kSuccess;
}

}  // namespace waymark::program

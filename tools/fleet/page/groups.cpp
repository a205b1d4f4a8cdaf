#include <waymark/tools/fleet/page/groups.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::fleet {
namespace {

bool has_several_modelings(const Fleet& fleet) {
  std::set<std::string> modelings;
  for (const DriveRecord& record : fleet.records)
    for (const ModelingRow& row : record.rows) modelings.insert(row.modeling);
  return modelings.size() > 1;
}

text::Row row_of(const Group& group) {
  const std::vector<double> errors = group.errors();
  const auto quantile = [&](double share) {
    return text::decimals(evaluation::nearest_rank_quantile(errors, share), 3);
  };
  const auto median = [&](const char* column, int digits) {
    return text::decimals(evaluation::sorted_median(group.sorted(column)), digits);
  };
  return {group.name,
          std::to_string(group.members.size()),
          std::to_string(group.count(DriveState::not_converged)),
          text::decimals(evaluation::sorted_median(errors), 3),
          quantile(0.9),
          quantile(1),
          median("gnss_rmse_m", 3),
          median("improvement_percent", 1),
          median("nees_mean", 2),
          median("coverage_95", 3)};
}

}  // namespace

std::size_t Group::count(DriveState state) const {
  return static_cast<std::size_t>(std::count_if(
      members.begin(), members.end(), [&](const Member& member) { return member.record->state == state; }));
}

std::vector<double> Group::sorted(std::string_view column) const {
  std::vector<double> values;
  for (const Member& member : members)
    if (std::isfinite(member.row->number(column))) values.push_back(member.row->number(column));
  std::sort(values.begin(), values.end());
  return values;
}

std::vector<double> Group::errors() const {
  std::vector<double> values;
  for (const Member& member : members)
    if (std::isfinite(member.row->error_m())) values.push_back(member.row->error_m());
  std::sort(values.begin(), values.end());
  return values;
}

std::vector<Group> groups_by(const Fleet& fleet,
                             const std::function<std::string(const DriveRecord&)>& name_of) {
  const bool tells_modeling = has_several_modelings(fleet);
  std::map<std::string, Group> groups;
  for (const DriveRecord& record : fleet.records) {
    for (const ModelingRow& row : record.rows) {
      std::string name = name_of(record);
      if (name.empty()) name = "not stated";
      if (tells_modeling) name += ", " + row.modeling;
      groups[name].members.push_back({&record, &row});
    }
  }
  std::vector<Group> all;
  for (auto& [name, group] : groups) {
    group.name = name;
    all.push_back(std::move(group));
  }
  return all;
}

std::vector<Group> groups_by_modeling(const Fleet& fleet) {
  std::map<std::string, Group> groups;
  for (const DriveRecord& record : fleet.records)
    for (const ModelingRow& row : record.rows) groups[row.modeling].members.push_back({&record, &row});
  std::vector<Group> all;
  for (auto& [name, group] : groups) {
    group.name = name;
    all.push_back(std::move(group));
  }
  return all;
}

text::Table group_table(const std::string& title, const std::string& heading,
                        const std::vector<Group>& groups) {
  text::Table table{
      .title = title,
      .columns = {heading, "drives", "no minimum", "median [m]", "90 % [m]", "worst [m]", "raw GNSS [m]",
                  "better by [%]", "NEES", "inside 95 %"},
      .rows = {},
      .notes = {"Errors are the root mean square of each drive; without truth, at fixes that a second "
                "fusion did not know. The last four columns are medians over drives. The NEES of a "
                "consistent estimate is 2."}};
  for (const Group& group : groups) table.rows.push_back(row_of(group));
  return table;
}

drawing::Series distribution(const std::string& name, const std::vector<double>& ascending,
                             drawing::Look look) {
  drawing::Series series{.name = name, .mark = drawing::Mark::line, .look = look, .x = ascending};
  for (std::size_t i = 0; i < ascending.size(); ++i)
    series.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(ascending.size()));
  return series;
}

}  // namespace waymark::fleet

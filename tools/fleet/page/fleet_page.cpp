#include <waymark/tools/fleet/page/fleet_page.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>
#include <waymark/tools/fleet/page/groups.hpp>
#include <waymark/tools/report/words.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::fleet {
namespace {

constexpr std::size_t kLooks = 7;   // of systems in one figure
constexpr std::size_t kLinks = 10;  // to reports of the worst drives
constexpr std::size_t kWorst = 20;  // drives in the table of the worst
constexpr int kHalfWidth = 460;
constexpr double kMostOfTail = 0.98;  // share of the drives that an axis holds

std::string drives_in_words(std::size_t count) {
  return fmt::format("{} drive{}", count, count == 1 ? "" : "s");
}

std::string subtitle_of(const Fleet& fleet) {
  std::string text =
      fmt::format("{}: {} done", drives_in_words(fleet.plan.drives.size()), fleet.count(DriveState::done));
  const auto add = [&](std::size_t count, const char* words) {
    if (count > 0) text += fmt::format(", {} {}", count, words);
  };
  add(fleet.count(DriveState::not_converged), "without a minimum");
  add(fleet.count(DriveState::failed), "failed");
  add(fleet.waiting(), "not run yet");
  return text;
}

void add_summary(const std::vector<Group>& modelings, drawing::Page& page) {
  for (const Group& group : modelings) {
    const std::vector<double> errors = group.errors();
    const std::vector<double> raw = group.sorted("gnss_rmse_m");
    if (errors.empty()) continue;
    const double median = evaluation::sorted_median(errors);
    page.summary +=
        fmt::format("{}{}: the median error of {} is {:.3f} m, that of nine in ten is below {:.3f} m.",
                    page.summary.empty() ? "" : " ", group.name, drives_in_words(errors.size()), median,
                    evaluation::nearest_rank_quantile(errors, 0.9));
    if (raw.empty()) continue;
    page.summary += fmt::format(" Raw GNSS has {:.3f} m.", evaluation::sorted_median(raw));
    page.verdict =
        median < evaluation::sorted_median(raw) ? drawing::Verdict::better : drawing::Verdict::worse;
  }
  if (page.summary.empty())
    page.summary = "No drive has an error: there is no truth, and no fix was held out.";
}

/// Most of the tail of each line has to be seen; the rest is in the table of the worst drives.
double common_end(const drawing::Figure& figure) {
  double end = 0;
  for (const drawing::Series& series : figure.series)
    if (!series.x.empty()) end = std::max(end, evaluation::nearest_rank_quantile(series.x, kMostOfTail));
  return 1.05 * end;
}

drawing::Figure error_distribution(const std::string& id, const std::string& title,
                                   const std::vector<Group>& groups, bool with_raw) {
  drawing::Figure figure{.id = id,
                         .title = title,
                         .description =
                             "Share of the drives whose root mean square error is at most this large. "
                             "The axis holds 98 % of the drives of each line.",
                         .x = {.title = "error of a drive", .unit = "m", .low = 0},
                         .y = {.title = "drives", .unit = "%", .low = 0, .high = 100},
                         .series = {}};
  if (with_raw && !groups.empty())
    figure.series.push_back(
        distribution("raw GNSS", groups.front().sorted("gnss_rmse_m"), drawing::Look::raw));
  for (std::size_t g = 0; g < std::min(groups.size(), kLooks); ++g)
    figure.series.push_back(distribution(groups[g].name, groups[g].errors(), drawing::look_of_system(g)));
  std::erase_if(figure.series, [](const drawing::Series& series) { return series.x.empty(); });
  figure.x.high = common_end(figure);
  return figure;
}

drawing::Series points_of(const Group& group, const char* x, const char* y, drawing::Look look) {
  drawing::Series points{.name = group.name, .mark = drawing::Mark::points, .look = look};
  for (const Member& member : group.members) {
    if (!std::isfinite(member.row->number(x)) || !std::isfinite(member.row->number(y))) continue;
    points.x.push_back(member.row->number(x));
    points.y.push_back(member.row->number(y));
    points.note.push_back(static_cast<int>(points.notes.size()));
    points.notes.push_back(member.record->drive);
  }
  return points;
}

drawing::Series diagonal(const drawing::Figure& figure) {
  double low = 0;
  double high = 0;
  for (const drawing::Series& series : figure.series) {
    for (const double x : series.x) {
      low = low == 0 ? x : std::min(low, x);
      high = std::max(high, x);
    }
  }
  return {.name = "equal",
          .mark = drawing::Mark::line,
          .look = drawing::Look::reference,
          .x = {low, high},
          .y = {low, high}};
}

drawing::Figure against_raw(const std::vector<Group>& modelings) {
  drawing::Figure figure{
      .id = "against-raw",
      .title = "Fused against raw",
      .description = "A point is a drive. Below the line the fusion is better than the receiver.",
      .x = {.title = "error of raw GNSS", .unit = "m", .logarithmic = true},
      .y = {.title = "fused error", .unit = "m", .logarithmic = true},
      .series = {},
      .width = kHalfWidth};
  for (std::size_t g = 0; g < std::min(modelings.size(), kLooks); ++g)
    figure.series.push_back(points_of(modelings[g], "gnss_rmse_m", "rmse_m", drawing::look_of_system(g)));
  figure.series.push_back(diagonal(figure));
  return figure;
}

drawing::Figure nees_distribution(const std::vector<Group>& modelings) {
  drawing::Figure figure{.id = "nees",
                         .title = "Mean NEES of the drives",
                         .description =
                             "Share of the drives whose mean NEES is at most this large. Over many drives "
                             "the mean of a consistent estimate is 2. To the right of it the stated "
                             "covariances are too small.",
                         .x = {.title = "mean NEES", .unit = "", .logarithmic = true},
                         .y = {.title = "drives", .unit = "%", .low = 0, .high = 100},
                         .series = {},
                         .width = kHalfWidth};
  for (std::size_t g = 0; g < std::min(modelings.size(), kLooks); ++g)
    figure.series.push_back(
        distribution(modelings[g].name, modelings[g].sorted("nees_mean"), drawing::look_of_system(g)));
  figure.series.push_back({.name = "consistent",
                           .mark = drawing::Mark::line,
                           .look = drawing::Look::reference,
                           .x = {2, 2},
                           .y = {0, 100}});
  return figure;
}

bool has_points(const drawing::Figure& figure) {
  return std::any_of(figure.series.begin(), figure.series.end(), [](const drawing::Series& series) {
    return series.look != drawing::Look::reference && !series.x.empty();
  });
}

drawing::Section distribution_section(const std::vector<Group>& modelings) {
  drawing::Section section{"distribution", "Distribution", {}};
  if (!modelings.empty()) section.blocks.emplace_back(group_table("All drives", "modeling", modelings));
  std::vector<drawing::Figure> figures = {
      error_distribution("errors", "Errors of the drives", modelings, true), against_raw(modelings),
      nees_distribution(modelings)};
  std::erase_if(figures, [](const drawing::Figure& figure) { return !has_points(figure); });
  drawing::add_figures(std::move(figures), section);
  return section;
}

std::vector<Member> worst_of(const std::vector<Group>& modelings) {
  std::vector<Member> members;
  for (const Group& group : modelings)
    for (const Member& member : group.members)
      if (std::isfinite(member.row->error_m())) members.push_back(member);
  std::stable_sort(members.begin(), members.end(),
                   [](const Member& a, const Member& b) { return a.row->error_m() > b.row->error_m(); });
  members.resize(std::min(members.size(), kWorst));
  return members;
}

/// Returns a path as a link takes it: a name may have characters with a meaning there.
std::string as_link(const std::string& path) {
  std::string link;
  for (const char c : path)
    link += std::string_view("%#?\\ ").find(c) == std::string_view::npos
                ? std::string(1, c)
                : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return link;
}

/// A link to each of the first reports that were kept. A kept page is named after its modeling if there are several.
void add_report_links(const std::vector<Member>& worst, const Fleet& fleet, drawing::Section& section) {
  if (fleet.plan.keep == Keep::metrics) return;
  for (std::size_t i = 0; i < std::min(worst.size(), kLinks); ++i) {
    const Member& member = worst[i];
    const std::string page =
        evaluation::ResultFolder::page_name(member.row->modeling, member.record->rows.size());
    section.blocks.emplace_back(
        drawing::PageLink{as_link(evaluation::ResultFolder("drives/" + member.record->drive).page(page)),
                          fmt::format("Report of {}, {}", member.record->drive, member.row->modeling)});
  }
}

drawing::Section worst_section(const Fleet& fleet, const std::vector<Group>& modelings) {
  drawing::Section section{"worst", "Worst drives", {}};
  const std::vector<Member> worst = worst_of(modelings);
  if (worst.empty()) return section;
  text::Table table{.title = "The drives with the largest errors",
                    .columns = {"drive", "modeling", "environment", "error [m]", "measured by",
                                "raw GNSS [m]", "max [m]", "NEES", "inside 95 %", "rejected"},
                    .rows = {}};
  for (const Member& member : worst) {
    const auto number = [&](const char* column, int digits) {
      return text::decimals(member.row->number(column), digits);
    };
    table.rows.push_back({member.record->drive, member.row->modeling, member.record->environment,
                          text::decimals(member.row->error_m(), 3), member.row->error_measure(),
                          number("gnss_rmse_m", 3), number("max_m", 3), number("nees_mean", 2),
                          number("coverage_95", 3), number("rejected", 0)});
  }
  section.blocks.emplace_back(std::move(table));
  add_report_links(worst, fleet, section);
  return section;
}

drawing::Section environment_section(const Fleet& fleet) {
  drawing::Section section{"environment", "By environment", {}};
  const std::vector<Group> groups =
      groups_by(fleet, [](const DriveRecord& record) { return record.environment; });
  if (groups.empty()) return section;
  section.blocks.emplace_back(group_table("Drives by environment", "environment", groups));
  drawing::Figure figure = error_distribution("environments", "Errors by environment", groups, false);
  if (groups.size() > kLooks)
    figure.description += fmt::format(" The first {} of {} groups are drawn.", kLooks, groups.size());
  if (has_points(figure)) drawing::add_figures({std::move(figure)}, section);
  return section;
}

drawing::Section version_section(const Fleet& fleet) {
  drawing::Section section{"version", "By version", {}};
  const std::vector<Group> groups =
      groups_by(fleet, [](const DriveRecord& record) { return record.label + " (" + record.program + ")"; });
  if (groups.empty()) return section;
  section.blocks.emplace_back(group_table("Drives by label and program", "version", groups));
  return section;
}

drawing::Section failure_section(const Fleet& fleet) {
  drawing::Section section{"failures", "Drives that failed or have no minimum", {}};
  text::Table table{.title = "Reasons",
                    .columns = {"drive", "state", "exit code", "reason"},
                    .rows = {},
                    .notes = {},
                    .file = {},
                    .words = true};
  for (const DriveRecord& record : fleet.records)
    if (record.state != DriveState::done)
      table.rows.push_back(
          {record.drive, to_string(record.state), std::to_string(record.exit_code), record.reason});
  if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
  return section;
}

}  // namespace

drawing::Page fleet_page(const Fleet& fleet, const std::string& version) {
  const std::vector<Group> modelings = groups_by_modeling(fleet);
  drawing::Page page;
  page.title = "Fleet " + fleet.plan.label;
  page.subtitle = subtitle_of(fleet);
  page.footer = "Made by waymark " + version + ".";
  page.glossary = report::glossary();
  add_summary(modelings, page);
  for (drawing::Section section :
       {distribution_section(modelings), worst_section(fleet, modelings), environment_section(fleet),
        version_section(fleet), failure_section(fleet)}) {
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));
  }
  return page;
}

}  // namespace waymark::fleet

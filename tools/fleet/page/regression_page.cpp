#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/registry/options.hpp>
#include <waymark/tools/fleet/page/fleet_page.hpp>
#include <waymark/tools/fleet/page/groups.hpp>
#include <waymark/tools/report/words.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::fleet {
namespace {

constexpr std::size_t kInSight = 30;  // rows of a table that is not folded

bool is_finite_pair(const PairedDrive& pair) {
  return std::isfinite(pair.old_error_m) && std::isfinite(pair.new_error_m) && pair.old_error_m > 0 &&
         pair.new_error_m > 0;
}

text::Row group_row(const std::string& name, const ChangeOfGroup& change) {
  return {name,
          std::to_string(change.worse + change.better + change.same + change.unjudged),
          std::to_string(change.worse),
          std::to_string(change.better),
          std::to_string(change.same),
          std::to_string(change.unjudged),
          std::to_string(change.grew),
          std::to_string(change.shrank),
          fmt::format("{:.2g}", change.chance),
          text::decimals(change.median_ratio, 4),
          std::isfinite(change.ratio_low)
              ? fmt::format("{:.4f} to {:.4f}", change.ratio_low, change.ratio_high)
              : "-"};
}

drawing::Section verdict_section(const Regression& regression) {
  text::Table table{
      .title = "Changes",
      .columns = {"drives", "pairs", "worse", "better", "same", "unjudged", "grew", "shrank", "chance",
                  "median ratio", "its 95 % interval"},
      .rows = {group_row("all", regression.all)},
      .notes = {"The ratio is new error over old error. Its interval holds for any distribution."}};
  for (const auto& [name, change] : regression.environments)
    table.rows.push_back(group_row(name.empty() ? "not stated" : name, change));
  return {"changes", "Changes", {drawing::Paragraph{regression.rule.in_words()}, std::move(table)}};
}

text::Table pairs_table(const std::string& title, const std::vector<const PairedDrive*>& pairs) {
  text::Table table{.title = title,
                    .columns = {"drive", "modeling", "environment", "change", "old [m]", "new [m]", "ratio",
                                "measured by", "reason"},
                    .rows = {}};
  for (const PairedDrive* pair : pairs)
    table.rows.push_back({pair->drive, pair->modeling, pair->environment, to_string(pair->change),
                          text::decimals(pair->old_error_m, 3), text::decimals(pair->new_error_m, 3),
                          text::decimals(pair->ratio(), 3), pair->measure, pair->reason});
  return table;
}

/// The first rows are in sight, all of them one click away.
void add_pairs(const std::string& title, const std::vector<const PairedDrive*>& pairs,
               drawing::Section& section) {
  if (pairs.empty()) {
    section.blocks.emplace_back(drawing::Paragraph{title + ": none."});
    return;
  }
  const std::size_t shown = std::min(pairs.size(), kInSight);
  section.blocks.emplace_back(
      pairs_table(title, {pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(shown)}));
  if (shown < pairs.size())
    section.blocks.emplace_back(
        drawing::FoldedTable{fmt::format("All {}", pairs.size()), pairs_table(title + ", all", pairs)});
}

drawing::Series points_of_pairs(const std::string& name, const std::vector<const PairedDrive*>& pairs,
                                drawing::Look look) {
  drawing::Series points{.name = name, .mark = drawing::Mark::points, .look = look};
  for (const PairedDrive* pair : pairs) {
    if (!is_finite_pair(*pair)) continue;
    points.x.push_back(pair->old_error_m);
    points.y.push_back(pair->new_error_m);
    points.note.push_back(static_cast<int>(points.notes.size()));
    points.notes.push_back(pair->drive + " " + pair->modeling);
  }
  return points;
}

/// A line of the rule from the smallest to the largest old error; `sign` 1: got worse, -1: got better, 0: equal.
drawing::Series limit_line(const std::string& name, const RegressionRule& rule, int sign, double low,
                           double high) {
  constexpr int kPoints = 60;
  drawing::Series line{.name = name, .mark = drawing::Mark::line, .look = drawing::Look::reference};
  for (int i = 0; i <= kPoints; ++i) {
    const double x = low * std::pow(high / low, static_cast<double>(i) / kPoints);
    const double y = x + sign * std::max(rule.length_m, rule.percent / 100 * x);
    line.x.push_back(x);
    line.y.push_back(y > 0 ? y : std::nan(""));
  }
  return line;
}

drawing::Figure old_against_new(const Regression& regression) {
  drawing::Figure figure{
      .id = "old-new",
      .title = "Errors of both fleets",
      .description = "A point is a drive. Above the upper line it got worse, below the lower line better.",
      .x = {.title = "old error", .unit = "m", .logarithmic = true},
      .y = {.title = "new error", .unit = "m", .logarithmic = true},
      .series = {},
      .height = 420};
  figure.series = {points_of_pairs("same", pairs_of(regression, {Change::same}), drawing::Look::raw),
                   points_of_pairs("better", pairs_of(regression, {Change::better}), drawing::Look::fused),
                   points_of_pairs("worse", pairs_of(regression, {Change::worse}), drawing::Look::rejected)};
  std::vector<double> old_errors;
  for (const drawing::Series& series : figure.series)
    old_errors.insert(old_errors.end(), series.x.begin(), series.x.end());
  std::erase_if(figure.series, [](const drawing::Series& series) { return series.x.empty(); });
  if (old_errors.empty()) return figure;
  const auto [low, high] = std::minmax_element(old_errors.begin(), old_errors.end());
  figure.series.push_back(limit_line("limits of the rule", regression.rule, 1, *low, *high));
  figure.series.push_back(limit_line("", regression.rule, -1, *low, *high));
  return figure;
}

drawing::Figure ratios(const Regression& regression) {
  std::vector<double> values;
  for (const PairedDrive& pair : regression.pairs)
    if (is_finite_pair(pair)) values.push_back(pair.ratio());
  std::sort(values.begin(), values.end());
  drawing::Figure figure{.id = "ratios",
                         .title = "New error over old error",
                         .description = "Share of the drives whose ratio is at most this large.",
                         .x = {.title = "ratio", .unit = ""},
                         .y = {.title = "drives", .unit = "%", .low = 0, .high = 100},
                         .series = {}};
  if (values.empty()) return figure;
  figure.series = {distribution("drives", values, drawing::Look::fused),
                   {.name = "equal",
                    .mark = drawing::Mark::line,
                    .look = drawing::Look::reference,
                    .x = {1, 1},
                    .y = {0, 100}}};
  return figure;
}

drawing::Section figure_section(const Regression& regression) {
  drawing::Section section{"figures", "Old against new", {}};
  std::vector<drawing::Figure> figures = {old_against_new(regression), ratios(regression)};
  std::erase_if(figures, [](const drawing::Figure& figure) { return figure.series.empty(); });
  drawing::add_figures(std::move(figures), section);
  return section;
}

drawing::Section alone_section(const Regression& regression) {
  drawing::Section section{"alone", "Drives of one fleet only", {}};
  for (const auto& [label, names] : {std::pair(regression.old_label, regression.only_old),
                                     std::pair(regression.new_label, regression.only_new)}) {
    if (names.empty()) continue;
    text::Table table{.title = "Only in " + label, .columns = {"drive"}, .rows = {}};
    for (const std::string& name : names) table.rows.push_back({name});
    section.blocks.emplace_back(
        drawing::FoldedTable{fmt::format("{}: {}", label, names.size()), std::move(table)});
  }
  return section;
}

/// How much a pair changed; one that was lost or gained changed most.
double change_size(const PairedDrive& pair) {
  return is_finite_pair(pair) ? std::abs(std::log(pair.ratio())) : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<const PairedDrive*> pairs_of(const Regression& regression, const std::vector<Change>& kinds) {
  std::vector<const PairedDrive*> found;
  for (const PairedDrive& pair : regression.pairs)
    if (std::find(kinds.begin(), kinds.end(), pair.change) != kinds.end()) found.push_back(&pair);
  std::stable_sort(found.begin(), found.end(), [](const PairedDrive* a, const PairedDrive* b) {
    return change_size(*a) > change_size(*b);
  });
  return found;
}

std::string verdict_sentence(const Regression& regression) {
  const ChangeOfGroup& all = regression.all;
  std::string text = fmt::format("{} against {}: ", regression.new_label, regression.old_label);
  switch (regression.fleet()) {
    case FleetChange::worse:
      text += "the fleet got worse";
      break;
    case FleetChange::better:
      text += "the fleet got better";
      break;
    case FleetChange::none:
      text += "the fleet did not change beyond chance";
      break;
  }
  text += fmt::format(". Of {} pairs {} got worse, {} better, {} stayed the same", regression.pairs.size(),
                      all.worse, all.better, all.same);
  if (all.unjudged > 0) text += fmt::format(", {} cannot be judged", all.unjudged);
  return text + ".";
}

text::Table regression_table(const Regression& regression) {
  const auto exact = [](double value) { return std::isfinite(value) ? shortest(value) : ""; };
  text::Table table{.columns = {"drive", "modeling", "environment", "change", "measure", "old_error_m",
                                "new_error_m", "reason"},
                    .rows = {}};
  for (const PairedDrive& pair : regression.pairs)
    table.rows.push_back({pair.drive, pair.modeling, pair.environment, to_string(pair.change), pair.measure,
                          exact(pair.old_error_m), exact(pair.new_error_m), pair.reason});
  return table;
}

drawing::Page regression_page(const Regression& regression, const std::string& version) {
  drawing::Page page;
  page.title = "Fleets compared";
  page.subtitle = fmt::format("{} (new) against {} (old)", regression.new_label, regression.old_label);
  page.summary = verdict_sentence(regression);
  page.footer = "Made by waymark " + version + ".";
  page.glossary = report::glossary();
  const FleetChange change = regression.fleet();
  if (change != FleetChange::none)
    page.verdict = change == FleetChange::worse ? drawing::Verdict::worse : drawing::Verdict::better;
  drawing::Section worse{"worse", "Drives that got worse", {}};
  add_pairs("Got worse", pairs_of(regression, {Change::lost, Change::worse}), worse);
  drawing::Section better{"better", "Drives that got better", {}};
  add_pairs("Got better", pairs_of(regression, {Change::gained, Change::better}), better);
  for (drawing::Section section : {verdict_section(regression), std::move(worse), std::move(better),
                                   figure_section(regression), alone_section(regression)}) {
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));
  }
  return page;
}

}  // namespace waymark::fleet

#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/report/comparison/comparison_page.hpp>
#include <waymark/tools/report/comparison/comparison_parts.hpp>
#include <waymark/tools/report/consistency_bars.hpp>
#include <waymark/tools/report/words.hpp>

namespace waymark::report {
namespace {

using Groups = std::vector<DriveGroup>;
using Runs = std::vector<ComparedRun>;

void add_table(text::Table table, drawing::Section& section) {
  if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
}

/// Returns the run with the smallest RMSE of these rows; null if there is none.
const SystemRow* best_row(const std::vector<SystemRow>& rows) {
  const SystemRow* best = nullptr;
  for (const SystemRow& row : rows) {
    const double rmse = row.metrics.position.rmse_m;
    if (row.run == nullptr || !std::isfinite(rmse)) continue;
    if (best == nullptr || rmse < best->metrics.position.rmse_m) best = &row;
  }
  return best;
}

std::string against_raw(const SystemRow& best) {
  const evaluation::TruthEvaluation& truth = *best.run->evaluation.truth;
  const double percent = truth.improvement.rmse_percent;
  std::string text = fmt::format(" (raw GNSS {:.3f} m", truth.gnss.position.rmse_m);
  if (std::isfinite(percent))
    text += fmt::format(", {:.1f} % {}", std::abs(percent), percent < 0 ? "worse" : "better");
  return text + ")";
}

std::string name_of_drive(const DriveGroup& group) {
  return group.drive.empty() ? "The drive" : group.drive;
}

/// Returns the counts of failures in words; empty if there are none.
std::string failures_sentence(const Runs& runs) {
  std::string names;
  for (const ComparedRun& run : runs) {
    if (run.ending && !run.ending->converged) names.append(names.empty() ? "" : ", ").append(run.label);
  }
  return names.empty() ? "" : " Not converged: " + names + ".";
}

void add_summary(const Runs& runs, const Groups& groups, drawing::Page& page) {
  std::string text;
  bool all_better = true;
  bool all_worse = true;
  bool any = false;
  for (const DriveGroup& group : groups) {
    const std::vector<SystemRow> rows = rows_against_truth(group);
    const std::vector<SystemRow> withheld = rows_at_withheld(group);
    const SystemRow* by_truth = best_row(rows);
    const SystemRow* best = by_truth != nullptr ? by_truth : best_row(withheld);
    if (best == nullptr) continue;
    text += fmt::format("{}{}: {} has the smallest RMSE{}, {:.3f} m{}.", text.empty() ? "" : " ",
                        name_of_drive(group), best->label, by_truth != nullptr ? "" : " at withheld fixes",
                        best->metrics.position.rmse_m, by_truth != nullptr ? against_raw(*best) : "");
    if (by_truth == nullptr) continue;
    any = true;
    const bool better = best->run->evaluation.truth->improvement.rmse_percent > 0;
    all_better = all_better && better;
    all_worse = all_worse && !better;
  }
  if (text.empty())
    text = "No run has a truth or withheld fixes to be compared with.";
  else if (any && (all_better || all_worse))
    page.verdict = all_better ? drawing::Verdict::better : drawing::Verdict::worse;
  page.summary = text + failures_sentence(runs);
}

drawing::Section errors_section(const Groups& groups) {
  drawing::Section section{"errors", "Errors", {}};
  if (groups.size() > 1)
    section.blocks.emplace_back(drawing::Paragraph{
        "The runs are of several drives. Errors are comparable only within one drive, because each "
        "drive has its own fixes."});
  add_table(error_table(groups), section);
  drawing::add_figures(error_bars(groups), section);
  add_table(improvement_table(groups), section);
  add_table(track_table(groups), section);
  add_table(withheld_error_table(groups), section);
  drawing::add_figures(withheld_bars(groups), section);
  return section;
}

drawing::Section trajectories_section(const Groups& groups) {
  drawing::Section section{"trajectories", "Trajectories", {}};
  drawing::add_figures(run_trajectories(groups), section);
  return section;
}

drawing::Section course_section(const Groups& groups) {
  drawing::Section section{"course", "Distribution and course", {}};
  drawing::add_figures(distribution_figures(groups), section);
  drawing::add_figures(course_figures(groups), section);
  return section;
}

drawing::Section consistency_section(const Groups& groups) {
  drawing::Section section{"consistency", "Stated against actual errors", {}};
  std::vector<StatedErrors> rows;
  for (const DriveGroup& group : groups) {
    for (const ComparedRun* run : group.runs) {
      if (run->evaluation.truth && run->evaluation.truth->consistency)
        rows.push_back({row_name(groups, group, run->label), *run->evaluation.truth->consistency});
    }
  }
  add_table(stated_error_table(groups), section);
  drawing::add_figures(consistency_bars("stated", rows), section);
  return section;
}

drawing::Section ending_section(const Runs& runs) {
  drawing::Section section{"convergence", "Convergence", {}};
  add_table(ending_table(runs), section);
  drawing::add_figures(ending_figures(runs), section);
  drawing::add_figures(chi2_figures(runs), section);
  return section;
}

drawing::Section differences_section(const Runs& runs, const Groups& groups) {
  drawing::Section section{"differences", "Differences", {}};
  text::Table differences = provenance_differences(runs);
  if (differences.rows.empty())
    section.blocks.emplace_back(drawing::Paragraph{"Program, inputs and options are the same in all runs."});
  add_table(std::move(differences), section);
  add_table(fixes_table(groups), section);
  return section;
}

std::string subtitle(const Runs& runs, const Groups& groups) {
  std::string text = fmt::format("{} run{} of ", runs.size(), runs.size() == 1 ? "" : "s");
  if (groups.size() > 1) text += fmt::format("{} drives: ", groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    text.append(g == 0 ? "" : ", ").append(groups[g].drive.empty() ? "an unnamed drive" : groups[g].drive);
  return text;
}

}  // namespace

drawing::Page comparison_page(const Runs& runs, const std::string& version) {
  if (runs.empty()) throw UsageError("a comparison needs at least one run");
  const Groups groups = groups_by_drive(runs);
  drawing::Page page;
  page.title = "Comparison of runs";
  page.subtitle = subtitle(runs, groups);
  page.footer = "Made by waymark " + version + ".";
  add_summary(runs, groups, page);
  page.glossary = glossary();
  for (drawing::Section section :
       {errors_section(groups), trajectories_section(groups), course_section(groups),
        consistency_section(groups), ending_section(runs), differences_section(runs, groups)}) {
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));
  }
  return page;
}

}  // namespace waymark::report

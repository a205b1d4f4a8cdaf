#include <fmt/format.h>

#include <waymark/tools/reproduction/experiment/ablation.hpp>
#include <waymark/tools/reproduction/experiment/consistency_study.hpp>
#include <waymark/tools/reproduction/page/reproduction_page.hpp>
#include <waymark/tools/reproduction/page/reproduction_parts.hpp>

namespace waymark::reproduction {
namespace {

using Drives = std::vector<DriveResult>;

std::string in_words(const std::optional<bool>& holds) {
  if (!holds) return "-";
  return *holds ? "holds" : "does\u00a0not\u00a0hold";
}

/// Allows line breaks between the parts of "ours/east/default".
std::string spaced(const std::string& source) {
  std::string text;
  for (const char c : source) text += c == '/' ? std::string(" / ") : std::string(1, c);
  return text;
}

drawing::Section findings_section(const std::vector<Finding>& findings) {
  text::Table table{.title = "Findings of the paper, checked on these drives",
                    .columns = {"finding", "source", "verdict", "figures"}};
  for (const Finding& finding : findings) {
    std::string statement = finding.statement;
    for (const Evidence& evidence : finding.evidence) {
      table.rows.push_back({statement, spaced(evidence.source), in_words(evidence.holds), evidence.figures});
      statement.clear();
    }
  }
  table.notes = {
      "paper: the figures that it prints. literal: its settings on these drives. minimum: the same "
      "model at its minimum. ours: our settings. -: the source cannot judge the finding."};
  return {"findings", "Findings", {std::move(table)}};
}

/// Returns "Findings that hold: paper 4 of 5, literal 2 of 5, ...".
std::string summary_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const std::string source : {"paper", "literal", "minimum", "ours", "default model"}) {
    int judged = 0;
    int held = 0;
    for (const Finding& finding : findings) {
      for (const Evidence& evidence : finding.evidence) {
        if (evidence.source != source || !evidence.holds) continue;
        ++judged;
        held += *evidence.holds ? 1 : 0;
      }
    }
    if (judged > 0) text += fmt::format("{} {} {} of {}", text.empty() ? "" : ",", source, held, judged);
  }
  return text.empty() ? "" : "Findings that hold, by source:" + text + ".";
}

/// Returns mean NEES and coverage of each setting, pooled over the drives.
std::string summary_of_study(const Drives& drives) {
  std::string text;
  for (const Setting& setting : consistency_settings()) {
    std::vector<double> nees;
    std::vector<double> coverage;
    for (const DriveResult& drive : drives) {
      const auto stated = consistency_of(drive, setting.name);
      if (!stated) continue;
      nees.push_back(stated->nees_mean);
      coverage.push_back(100 * stated->coverage);
    }
    if (nees.empty()) continue;
    text +=
        fmt::format("{}{}: mean NEES {:.2f} (2 is consistent), coverage {:.1f} % (95), {} drives.",
                    text.empty() ? "" : " ", setting.name == kDefaultModel ? "Default model" : "White noise",
                    pooled_mean(nees).mean, pooled_mean(coverage).mean, nees.size());
  }
  return text;
}

/// Returns the changes of the default model that cost most, and those that gain most.
std::string summary_of_ablation(const Drives& drives) {
  const auto errors_of = [&](const std::string& setting) {
    std::vector<double> errors;
    for (const DriveResult& drive : drives) errors.push_back(judged_errors(drive, setting).rmse_m);
    return errors;
  };
  const std::vector<double> reference = errors_of(kDefaultModel);
  std::string worst;
  double most = 0;
  int better = 0;
  for (const Ablation& ablation : ablations()) {
    const double change = mean_change_percent(errors_of(ablation.setting.name), reference);
    if (change < 0) ++better;
    if (!(change > most)) continue;
    most = change;
    worst = ablation.title;
  }
  if (worst.empty()) return "";
  return fmt::format(
      "The largest RMS errors come with: {} ({:+.1f} % on the mean). {} of {} settings are better than the "
      "default.",
      worst, most, better, ablations().size() - 1);
}

drawing::Section tables_section(const ReproductionReport& report) {
  drawing::Section section{"tables", "Tables", {}};
  for (const text::Table& table : report.tables) section.blocks.emplace_back(table);
  return section;
}

/// Returns the figures of the main results. The name of a report decides which they are.
std::vector<drawing::Section> figure_sections(const ReproductionReport& report, const Drives& drives) {
  std::vector<drawing::Section> sections;
  const auto add = [&](const std::string& id, const std::string& title,
                       std::vector<drawing::Figure> figures) {
    if (figures.empty()) return;
    sections.push_back({id, title, {}});
    drawing::add_figures(std::move(figures), sections.back());
  };
  if (report.name == "ablation") {
    add("settings", "Settings", ablation_figures(drives));
  } else if (report.name == "consistency") {
    add("drives", "Drives", consistency_figures(drives));
  } else {
    add("errors", "Errors", paper_error_figures(drives));
    add("withheld-fixes", "Withheld fixes", withheld_figures(drives));
    add("stated", "Stated against actual errors", stated_error_figures(drives));
  }
  return sections;
}

}  // namespace

drawing::Page reproduction_page(const ReproductionReport& report, const Drives& drives,
                                const std::string& version) {
  drawing::Page page;
  page.title = report.title;
  page.subtitle = report.introduction;
  page.footer = "Made by waymark " + version + ".";
  if (!report.findings.empty()) {
    page.summary = summary_of(report.findings);
    page.sections.push_back(findings_section(report.findings));
  }
  if (report.name == "ablation") page.summary = summary_of_ablation(drives);
  if (report.name == "consistency") page.summary = summary_of_study(drives);
  for (drawing::Section& section : figure_sections(report, drives))
    page.sections.push_back(std::move(section));
  page.sections.push_back(tables_section(report));
  return page;
}

}  // namespace waymark::reproduction

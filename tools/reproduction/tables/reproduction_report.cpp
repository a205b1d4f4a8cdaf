#include <algorithm>

#include <waymark/tools/reproduction/tables/convergence_tables.hpp>
#include <waymark/tools/reproduction/tables/drive_tables.hpp>
#include <waymark/tools/reproduction/tables/paper_tables.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {
namespace {

std::vector<DriveResult> other_drives(const std::vector<DriveResult>& drives) {
  std::vector<DriveResult> others;
  std::copy_if(drives.begin(), drives.end(), std::back_inserter(others),
               [](const DriveResult& drive) { return drive.dataset == 0; });
  return others;
}

}  // namespace

ReproductionReport make_report(const std::vector<DriveResult>& drives, const std::string& introduction) {
  ReproductionReport report;
  report.introduction = introduction;
  report.tables = paper_tables(drives);
  const std::vector<DriveResult> others = other_drives(drives);
  if (!others.empty()) {
    for (text::Table& table :
         std::vector{overview_table(others), truth_table(others), withheld_table(others)}) {
      if (!table.rows.empty()) report.tables.push_back(std::move(table));
    }
  }
  report.tables.push_back(cause_table(drives));
  report.tables.push_back(common_minimum_table(drives));
  report.findings = findings(drives);
  report.runs = run_table(drives);
  return report;
}

std::string report_text(const ReproductionReport& report, const text::TextLook& look) {
  std::string text = report.introduction;
  text += "\n";
  for (const text::Table& table : report.tables) text.append("\n").append(text::table_text(table, look));
  if (!report.findings.empty())
    text.append("\nFindings of the paper, checked on these drives\n").append(findings_text(report.findings));
  return text;
}

std::string report_markdown(const ReproductionReport& report) {
  std::string text = "# " + report.title + "\n\n";
  text.append(report.introduction).append("\n");
  if (!report.findings.empty())
    text.append("\n## Findings of the paper, checked on these drives\n\n")
        .append(findings_text(report.findings));
  for (const text::Table& table : report.tables) text.append("\n").append(text::table_markdown(table));
  return text;
}

}  // namespace waymark::reproduction

/// The whole result: all tables, the findings, and files.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/findings.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::reproduction {

struct ReproductionReport {
  std::string name = "reproduction";  ///< for its files and, after "waymark-", for its schema
  std::string title = "The paper's experiment, reproduced";
  std::string introduction;  ///< a paragraph: program, version, what is simulated
  std::vector<text::Table> tables;
  std::vector<Finding> findings;
  text::Table runs;  ///< every run; only in files
};

/// Returns the tables for which the drives have data: the six of the paper, convergence, and those
/// of other drives.
[[nodiscard]] ReproductionReport make_report(const std::vector<DriveResult>& drives,
                                             const std::string& introduction);

/// Returns the report for the terminal.
[[nodiscard]] std::string report_text(const ReproductionReport& report, const text::TextLook& look = {});
/// Returns NAME.md, with the name in capitals.
[[nodiscard]] std::string report_markdown(const ReproductionReport& report);
/// Returns NAME.json, schema "waymark-NAME" version 1 (tools/program/JSON.md), with all
/// numbers in full.
[[nodiscard]] std::string report_json(const ReproductionReport& report,
                                      const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction

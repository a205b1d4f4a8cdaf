/// The verdict on a drive: the sentences at the top of its page, and at the end of a run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// The verdict in words, and whether it is good.
struct DriveVerdict {
  std::string text;
  drawing::Verdict kind = drawing::Verdict::none;
};

/// Returns the verdict. With truth it says whether the fused positions are better or worse than raw
/// GNSS, unless the fixes are the truth. Without, it says how well they predict fixes that were kept out,
/// whether the stated covariances fit the residuals of the fixes, and where the stated sigma is largest.
[[nodiscard]] DriveVerdict verdict_of(const ReportedDrive& drive);

/// Describes whether a mean NIS is as it should be: "1.92, and 2 is right: ...".
[[nodiscard]] std::string describe_nis(const evaluation::InnovationStatistics& nis);

/// Returns the texts of a key of the provenance, in order.
[[nodiscard]] std::vector<std::string> stated(const ReportedDrive& drive, std::string_view key);

}  // namespace waymark::report

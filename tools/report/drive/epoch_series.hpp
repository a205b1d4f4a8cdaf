/// Series and figures over the epochs of a drive. The figures of its errors are built from them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::report {

/// One of the two offsets of an epoch from the truth: raw or fused.
using Offset = std::optional<Eigen::Vector2d> evaluation::EpochResult::*;

/// Returns the offsets of all epochs that have one.
[[nodiscard]] std::vector<Eigen::Vector2d> offsets(const ReportedDrive& drive, Offset which);

/// Returns a line over time through every epoch that has a value.
[[nodiscard]] drawing::Series over_time(
    const ReportedDrive& drive, const std::string& name, drawing::Look look,
    const std::function<std::optional<double>(const evaluation::EpochResult&)>& value);

/// Returns an empty figure over time, from the first fix to the last, linked with all others of its
/// kind. It marks spans of rejected and of withheld fixes.
[[nodiscard]] drawing::Figure time_figure(const ReportedDrive& drive, const std::string& id,
                                          const std::string& title, const std::string& description,
                                          const drawing::Axis& y);

}  // namespace waymark::report

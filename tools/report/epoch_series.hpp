/// Series and figures over the epochs of a drive: what the figures of its errors are made of.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/tools/report/drive_report.hpp>
#include <waymark/tools/report/figure.hpp>

namespace waymark {

/// Which of an epoch's two offsets from the truth: raw or fused.
using Offset = std::optional<Eigen::Vector2d> EpochResult::*;

/// The offsets of all epochs that have one.
[[nodiscard]] std::vector<Eigen::Vector2d> offsets(const ReportedDrive& drive, Offset which);

/// A line over time through every epoch that has a value.
[[nodiscard]] Series over_time(const ReportedDrive& drive, const std::string& name, Look look,
                               const std::function<std::optional<double>(const EpochResult&)>& value);

/// An empty figure over time from the first fix to the last, linked with all of its kind. Spans of rejected
/// and of withheld fixes are marked.
[[nodiscard]] Figure time_figure(const ReportedDrive& drive, const std::string& id, const std::string& title,
                                 const std::string& description, const Axis& y);

}  // namespace waymark

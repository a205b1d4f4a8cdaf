#include <algorithm>

#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/epoch_series.hpp>

namespace waymark::report {
namespace {

/// Returns the runs of rejected or withheld fixes, each from its first to its last fix.
drawing::Series spans(const ReportedDrive& drive, FixStatus status, const std::string& name,
                      drawing::Look look) {
  drawing::Series series{.name = name, .mark = drawing::Mark::spans, .look = look};
  bool goes_on = false;
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    const double seconds = drive.seconds(epoch.stamp);
    if (epoch.status != status) {
      goes_on = false;
    } else if (goes_on) {
      series.high.back() = seconds;
    } else {
      series.low.push_back(seconds);
      series.high.push_back(seconds);
      goes_on = true;
    }
  }
  return series;
}

}  // namespace

drawing::Range epochs_extent(const ReportedDrive& drive) {
  const auto& epochs = drive.evaluation.epochs;
  if (epochs.empty()) return {0, 1};
  const double first = drive.seconds(epochs.front().stamp);
  return {first, std::max(drive.seconds(epochs.back().stamp), first + 1e-3)};
}

std::vector<Eigen::Vector2d> offsets(const ReportedDrive& drive, Offset which) {
  std::vector<Eigen::Vector2d> result;
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    if (epoch.*which) result.push_back(*(epoch.*which));
  }
  return result;
}

drawing::Series over_time(const ReportedDrive& drive, const std::string& name, drawing::Look look,
                          const std::function<std::optional<double>(const evaluation::EpochResult&)>& value) {
  drawing::Series series{.name = name, .mark = drawing::Mark::line, .look = look};
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    const std::optional<double> y = value(epoch);
    if (!y) continue;
    const double seconds = drive.seconds(epoch.stamp);
    series.x.push_back(seconds);
    series.y.push_back(*y);
    series.time.push_back(seconds);
  }
  return series;
}

drawing::Figure time_figure(const ReportedDrive& drive, const std::string& id, const std::string& title,
                            const std::string& description, const drawing::Axis& y) {
  drawing::Figure figure;
  figure.id = id;
  figure.title = title;
  figure.description = description;
  figure.x = {.title = "time since start", .unit = "s"};
  figure.y = y;
  figure.motion = drawing::Motion::x;
  figure.link = "time";
  figure.height = 240;
  for (drawing::Series& series :
       std::vector{spans(drive, FixStatus::rejected, "fixes rejected", drawing::Look::rejected),
                   spans(drive, FixStatus::withheld, "fixes withheld", drawing::Look::withheld)}) {
    if (!series.low.empty()) figure.series.push_back(std::move(series));
  }
  const drawing::Range extent = epochs_extent(drive);
  figure.x.low = extent.low;
  figure.x.high = extent.high;
  return figure;
}

}  // namespace waymark::report

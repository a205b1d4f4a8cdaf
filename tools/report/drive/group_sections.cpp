#include <waymark/tools/report/drive/group_sections.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/page/page_size.hpp>
#include <waymark/tools/report/drive/drive_figures.hpp>

namespace waymark::report {
namespace {

using evaluation::GroupedMeasurement;
using evaluation::GroupedResiduals;

/// Of a group over time; below, stretches are too long to show more than an envelope.
constexpr std::size_t kLeastOfGroup = 40;
constexpr std::size_t kMostOfGroup = 600;
/// A line is interrupted if its measurements pause for longer.
constexpr double kLongestPause_s = 2;
/// A group has one point in the sky for each part of the drive.
constexpr double kShortestPart_s = 60;
constexpr double kMostParts = 60;

/// Returns the text as part of the id of a figure.
std::string for_id(const std::string& text) {
  std::string id;
  for (const char c : text) {
    const char low = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool plain = (low >= 'a' && low <= 'z') || (low >= '0' && low <= '9');
    id += plain ? low : '-';
  }
  return id;
}

std::string of_family(const std::string& title, const std::string& family) {
  return family.empty() ? title : title + ", " + family;
}

/// Interrupts a line where its measurements pause, and thins it.
drawing::Series line_with_pauses(const drawing::Series& all, std::size_t most) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < all.x.size(); ++i) steps.push_back(all.x[i] - all.x[i - 1]);
  constexpr double kUsualSteps = 5;
  const double pause =
      steps.empty() ? kLongestPause_s : std::max(kLongestPause_s, kUsualSteps * upper_median(steps));
  drawing::Series line{.name = all.name, .mark = drawing::Mark::line, .look = all.look};
  const auto add = [&](double x, double y) {
    line.x.push_back(x);
    line.y.push_back(y);
  };
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= all.x.size(); ++i) {
    if (i < all.x.size() && steps[i - 1] <= pause) continue;
    std::vector<std::size_t> part(i - begin);
    std::iota(part.begin(), part.end(), begin);
    const std::size_t share = std::max<std::size_t>(1, most * part.size() / all.x.size());
    if (part.size() > share) {
      const auto kept = drawing::points_that_keep_shape(drawing::with_points(all, part), false, share);
      part.clear();
      for (const std::size_t k : kept) part.push_back(begin + k);
    }
    for (const std::size_t k : part) add(all.x[k], all.y[k]);
    if (i < all.x.size()) add(all.x[i - 1], std::numeric_limits<double>::quiet_NaN());
    begin = i;
  }
  line.time = line.x;
  return line;
}

/// Makes the figures of one source.
class GroupFigures {
 public:
  GroupFigures(const ReportedDrive& drive, const GroupedResiduals& groups)
      : drive_(drive),
        groups_(groups),
        prefix_(drive.groups.size() > 1 ? for_id(groups.source) + "-" : ""),
        most_(std::clamp(kMostGroupPoints / std::max<std::size_t>(1, groups.groups.size() * quantities()),
                         kLeastOfGroup, kMostOfGroup)) {}

  /// Shows where the measurements of a quantity come from, and how much the loss leaves of them.
  [[nodiscard]] drawing::Figure sky(std::size_t quantity) const {
    drawing::Figure figure;
    figure.id = prefix_ + "sky-" + for_id(groups_.quantities[quantity].name);
    figure.title = fmt::format("The sky: {}s", groups_.quantities[quantity].name);
    figure.description = fmt::format(
        "Where the {} are: the zenith in the middle, the horizon outside, grid north at the top. A point is the "
        "mean weight that the loss leaves to the {}s of a {} in {:.0f} s.",
        groups_.many, groups_.quantities[quantity].name, groups_.one, part_s());
    figure.x = {.title = "from the zenith to the east", .unit = "deg"};
    figure.y = {.title = "to the north", .unit = "deg"};
    figure.motion = drawing::Motion::map;
    figure.width = 430;
    figure.height = 430;
    figure.series.push_back(rings());
    for (drawing::Series& series : points_in_the_sky(quantity)) figure.series.push_back(std::move(series));
    return figure;
  }

  /// Shows the residuals of a quantity over time, a figure for each family.
  [[nodiscard]] std::vector<drawing::Figure> residuals(std::size_t quantity) const {
    const auto& [name, unit] = groups_.quantities[quantity];
    return over_time(for_id(name), fmt::format("Residuals of {}s", name),
                     fmt::format("Error of each {} after the fit.", name),
                     {.title = "residual", .unit = unit}, [quantity](const GroupedMeasurement& m) {
                       return m.quantity == quantity ? m.residual : std::numeric_limits<double>::quiet_NaN();
                     });
  }

  /// Shows the strength of the signals over time, a figure for each family.
  [[nodiscard]] std::vector<drawing::Figure> signals() const {
    // Both quantities of a satellite have the same signal. One of them is enough.
    std::map<std::size_t, std::size_t> quantity_of;
    for (const GroupedMeasurement& m : groups_.measurements) quantity_of.try_emplace(m.group, m.quantity);
    return over_time(
        for_id(groups_.signal_name), groups_.signal_name,
        fmt::format("As the receiver tells it for each {}.", groups_.one),
        {.title = groups_.signal_name, .unit = groups_.signal_unit}, [&](const GroupedMeasurement& m) {
          return m.quantity == quantity_of[m.group] ? m.signal : std::numeric_limits<double>::quiet_NaN();
        });
  }

  [[nodiscard]] bool has_sky(std::size_t quantity) const {
    return std::any_of(groups_.measurements.begin(), groups_.measurements.end(),
                       [&](const GroupedMeasurement& m) { return m.quantity == quantity && is_placed(m); });
  }
  [[nodiscard]] std::size_t quantities() const { return groups_.quantities.size() + 1; }  // and the signal

 private:
  static bool is_placed(const GroupedMeasurement& m) {
    return m.stamp && std::isfinite(m.bearing_rad) && std::isfinite(m.elevation_rad) && m.elevation_rad >= 0;
  }

  [[nodiscard]] double part_s() const {
    const drawing::Range extent = epochs_extent(drive_);
    return std::max(kShortestPart_s, (extent.high - extent.low) / kMostParts);
  }

  static drawing::Series rings() {
    drawing::Series rings{
        .name = "elevation 0, 30, 60 deg", .mark = drawing::Mark::line, .look = drawing::Look::reference};
    constexpr int kCorners = 72;
    for (const double radius_deg : {90.0, 60.0, 30.0}) {
      for (int k = 0; k <= kCorners; ++k) {
        const double angle = 2 * std::numbers::pi * k / kCorners;
        rings.x.push_back(radius_deg * std::sin(angle));
        rings.y.push_back(radius_deg * std::cos(angle));
      }
      rings.x.push_back(0);
      rings.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    return rings;
  }

  /// The mean of the measurements of a group in a part of the drive.
  struct SkyPoint {
    double seconds = 0, east = 0, north = 0, weight = 0;
    double count = 0;
    std::size_t group = 0;
  };

  [[nodiscard]] std::vector<SkyPoint> sky_points(std::size_t quantity) const {
    const double begin = epochs_extent(drive_).low;
    std::map<std::pair<std::size_t, int>, SkyPoint> parts;
    for (const GroupedMeasurement& m : groups_.measurements) {
      if (m.quantity != quantity || !is_placed(m)) continue;
      const double seconds = drive_.seconds(*m.stamp);
      const int part = static_cast<int>(std::max(0.0, (seconds - begin) / part_s()));
      const double from_zenith_deg = 90 - m.elevation_rad * 180 / std::numbers::pi;
      SkyPoint& point = parts[{m.group, part}];
      point.seconds += seconds;
      point.east += from_zenith_deg * std::sin(m.bearing_rad);
      point.north += from_zenith_deg * std::cos(m.bearing_rad);
      point.weight += m.weight;
      point.count += 1;
      point.group = m.group;
    }
    std::vector<SkyPoint> points;
    for (auto& [place, point] : parts) {
      for (double* sum : {&point.seconds, &point.east, &point.north, &point.weight}) *sum /= point.count;
      points.push_back(point);
    }
    std::stable_sort(points.begin(), points.end(),
                     [](const SkyPoint& a, const SkyPoint& b) { return a.seconds < b.seconds; });
    return points;
  }

  [[nodiscard]] std::vector<drawing::Series> points_in_the_sky(std::size_t quantity) const {
    struct Class {
      const char* name;
      double below;
      drawing::Look look;
    };
    constexpr std::array kClasses = {Class{"mean weight above 0.5", 2, drawing::Look::fused},
                                     Class{"0.2 to 0.5", 0.5, drawing::Look::third},
                                     Class{"below 0.2", 0.2, drawing::Look::raw}};
    std::vector<drawing::Series> all;
    for (const Class& of : kClasses)
      all.push_back({.name = of.name, .mark = drawing::Mark::points, .look = of.look});
    for (const SkyPoint& point : sky_points(quantity)) {
      std::size_t which = 0;
      while (which + 1 < kClasses.size() && point.weight < kClasses[which + 1].below) ++which;
      drawing::Series& series = all[which];
      series.x.push_back(point.east);
      series.y.push_back(point.north);
      series.time.push_back(point.seconds);
      series.note.push_back(static_cast<int>(series.notes.size()));
      series.notes.push_back(
          fmt::format("{}, weight {:.2f}", groups_.groups[point.group].name, point.weight));
    }
    std::erase_if(all, [](const drawing::Series& series) { return series.x.empty(); });
    return all;
  }

  /// @param value of a measurement; NaN: it is not in the figure
  [[nodiscard]] std::vector<drawing::Figure> over_time(
      const std::string& id, const std::string& title, const std::string& description, const drawing::Axis& y,
      const std::function<double(const GroupedMeasurement&)>& value) const {
    const drawing::Range extent = epochs_extent(drive_);
    std::vector<drawing::Series> lines(groups_.groups.size());
    for (const GroupedMeasurement& m : groups_.measurements) {
      const double v = m.stamp ? value(m) : std::numeric_limits<double>::quiet_NaN();
      if (std::isnan(v)) continue;
      lines[m.group].x.push_back(drive_.seconds(*m.stamp));
      lines[m.group].y.push_back(v);
    }
    std::vector<drawing::Figure> figures;
    for (const std::string& family : groups_.families()) {
      drawing::Figure figure;
      figure.id = prefix_ + id + (family.empty() ? "" : "-" + for_id(family));
      figure.title = of_family(title, family);
      figure.description =
          description + fmt::format(
                            " At most about {} points of a {}: of every stretch the first, the lowest, the "
                            "highest and the last.",
                            most_, groups_.one);
      figure.x = {.title = "time since start", .unit = "s", .low = extent.low, .high = extent.high};
      figure.y = y;
      figure.motion = drawing::Motion::x;
      figure.link = "time";
      figure.height = 260;
      for (std::size_t g = 0; g < lines.size(); ++g) {
        if (groups_.groups[g].family != family || lines[g].x.empty()) continue;
        lines[g].name = groups_.groups[g].name;
        lines[g].look = drawing::look_of_system(figure.series.size());
        figure.series.push_back(line_with_pauses(lines[g], most_));
      }
      if (!figure.series.empty()) figures.push_back(std::move(figure));
    }
    return figures;
  }

  const ReportedDrive& drive_;
  const GroupedResiduals& groups_;
  std::string prefix_;
  std::size_t most_;
};

drawing::Section section_of(const ReportedDrive& drive, const GroupedResiduals& groups) {
  drawing::Section section{"groups-" + for_id(groups.source),
                           fmt::format("Measurements by {}: {}", groups.one, groups.source),
                           {}};
  text::Table table = evaluation::group_table(groups);
  table.notes = {
      "rms: of the residuals after the fit. whitened rms: about 1 or below if the noise is as stated. down-weighted: "
      "the loss leaves less than half of the weight."};
  section.blocks.emplace_back(std::move(table));
  const GroupFigures figures(drive, groups);
  std::vector<drawing::Figure> skies;
  for (std::size_t q = 0; q < groups.quantities.size(); ++q)
    if (figures.has_sky(q)) skies.push_back(figures.sky(q));
  drawing::add_figures(std::move(skies), section);
  for (std::size_t q = 0; q < groups.quantities.size(); ++q)
    drawing::add_figures(figures.residuals(q), section);
  if (!groups.signal_name.empty()) drawing::add_figures(figures.signals(), section);
  return section;
}

}  // namespace

std::vector<drawing::Section> group_sections(const ReportedDrive& drive) {
  std::vector<drawing::Section> sections;
  for (const GroupedResiduals& groups : drive.groups) sections.push_back(section_of(drive, groups));
  return sections;
}

}  // namespace waymark::report

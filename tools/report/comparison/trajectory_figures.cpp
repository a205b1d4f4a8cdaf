// The trajectories of several runs over each other.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/report/comparison/comparison_parts.hpp>

namespace waymark::report {
namespace {

constexpr std::size_t kRunsInTrajectory = 7;  // the number of looks for systems

/// A plane that touches the ellipsoid WGS84 at a point. Runs may have frames of their own, so their
/// places are compared, not their grid coordinates.
class TangentPlane {
 public:
  explicit TangentPlane(const GeodeticPoint& origin) : origin_(origin) {
    constexpr double kEquator_m = 6378137;
    constexpr double kEccentricitySquared = 6.69437999014e-3;
    const double latitude = origin.latitude_deg * kRadians;
    const double w = 1 - kEccentricitySquared * std::sin(latitude) * std::sin(latitude);
    per_degree_ = {kRadians * kEquator_m / std::sqrt(w) * std::cos(latitude),
                   kRadians * kEquator_m * (1 - kEccentricitySquared) / (w * std::sqrt(w))};
  }
  [[nodiscard]] Eigen::Vector2d place(const GeodeticPoint& point) const {
    const double east_deg = std::remainder(point.longitude_deg - origin_.longitude_deg, 360.0);
    return {east_deg * per_degree_.x(), (point.latitude_deg - origin_.latitude_deg) * per_degree_.y()};
  }

 private:
  static constexpr double kRadians = std::numbers::pi / 180;
  GeodeticPoint origin_;
  Eigen::Vector2d per_degree_;  ///< m, east and north
};

/// Returns the first place of a group and when it was; empty if no run has places.
std::optional<std::pair<GeodeticPoint, Stamp>> first_place(const DriveGroup& group) {
  for (const ComparedRun* run : group.runs) {
    for (const evaluation::EpochResult& epoch : run->evaluation.epochs)
      if (epoch.fused_place) return std::pair{*epoch.fused_place, epoch.stamp};
  }
  return std::nullopt;
}

drawing::Series track_of(const ComparedRun& run, const TangentPlane& plane, Stamp begin, std::size_t index) {
  drawing::Series series{
      .name = run.label, .mark = drawing::Mark::line, .look = drawing::look_of_system(index)};
  for (const evaluation::EpochResult& epoch : run.evaluation.epochs) {
    if (!epoch.fused_place) continue;
    const Eigen::Vector2d place = plane.place(*epoch.fused_place);
    series.x.push_back(place.x());
    series.y.push_back(place.y());
    series.time.push_back(seconds_between(begin, epoch.stamp));
  }
  return series;
}

}  // namespace

std::vector<drawing::Figure> run_trajectories(const std::vector<DriveGroup>& groups) {
  std::vector<drawing::Figure> figures;
  for (const DriveGroup& group : groups) {
    const auto first = first_place(group);
    if (!first) continue;
    const TangentPlane plane(first->first);
    drawing::Figure figure;
    const auto finish = [&] {
      if (figure.series.empty()) return;
      figure.id = fmt::format("tracks-{}", figures.size() + 1);
      figure.title = groups.size() > 1 ? "Trajectories, " + group.drive : "Trajectories";
      figure.description =
          "Fused positions at the fixes, metres east and north of the first one on the plane that touches "
          "the ellipsoid there.";
      figure.x = {.title = "east", .unit = "m"};
      figure.y = {.title = "north", .unit = "m"};
      figure.motion = drawing::Motion::map;
      figure.geographic = true;
      figure.height = 620;
      figures.push_back(std::exchange(figure, {}));
    };
    for (const ComparedRun* run : group.runs) {
      drawing::Series track = track_of(*run, plane, first->second, figure.series.size());
      if (track.x.size() < 2) continue;
      figure.series.push_back(std::move(track));
      if (figure.series.size() == kRunsInTrajectory) finish();
    }
    finish();
  }
  return figures;
}

}  // namespace waymark::report

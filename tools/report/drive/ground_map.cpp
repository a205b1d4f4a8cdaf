#include <algorithm>
#include <cmath>
#include <limits>

#include <waymark/tools/report/drive/ground_map.hpp>

namespace waymark::report {
namespace {

constexpr double kFinest_m = 0.25;
constexpr double kCoarsest_m = 1024;
constexpr double kCoarseBuildings_m = 16;

struct Cell {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

Cell cell_of(const Eigen::Vector2d& point) {
  return {static_cast<std::int64_t>(std::floor(point.x() / GroundMap::kNear_m)),
          static_cast<std::int64_t>(std::floor(point.y() / GroundMap::kNear_m))};
}

/// A frame is at most 2^31 cells wide.
std::int64_t key_of(Cell cell) {
  return cell.x * (std::int64_t{1} << 32) + cell.y;
}

/// Returns the line without points that are less than `apart` from the last one kept.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& line, double apart) {
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept.empty() || i + 1 == line.size() || (line[i] - kept.back()).norm() >= apart)
      kept.push_back(line[i]);
  }
  return kept;
}

/// Returns how far a line goes from where it begins.
double extent_of(const std::vector<Eigen::Vector2d>& line) {
  double extent = 0;
  for (const Eigen::Vector2d& point : line) extent = std::max(extent, (point - line.front()).norm());
  return extent;
}

std::size_t add_lines(const std::vector<std::vector<Eigen::Vector2d>>& lines, double apart,
                      std::size_t fewest, drawing::Series& series) {
  constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
  for (const auto& line : lines) {
    const std::vector<Eigen::Vector2d> kept = thinned(line, apart);
    if (kept.size() < fewest || (apart > kFinest_m && extent_of(line) < 4 * apart)) continue;
    for (const Eigen::Vector2d& point : kept) {
      series.x.push_back(point.x());
      series.y.push_back(point.y());
    }
    series.x.push_back(kBreak);
    series.y.push_back(kBreak);
  }
  return series.x.size();
}

}  // namespace

GroundMap::GroundMap(const std::vector<Eigen::Vector2d>& track) {
  for (const Eigen::Vector2d& point : track) {
    if (!point.allFinite()) continue;
    const Cell middle = cell_of(point);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) cells_.insert(key_of({middle.x + dx, middle.y + dy}));
    }
  }
}

bool GroundMap::is_near(const Eigen::Vector2d& point) const {
  return cells_.contains(key_of(cell_of(point)));
}

void GroundMap::add_road(const Line& points) {
  Line part;
  const auto end_part = [&] {
    if (part.size() > 1) roads_.push_back(part);
    part.clear();
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    // A long piece may pass by the drive with both its ends far away: it is cut into short ones.
    const double length = (points[i + 1] - points[i]).norm();
    const auto pieces = static_cast<int>(std::min(std::ceil(length / kNear_m), 1e5));
    for (int k = 0; k < std::max(pieces, 1); ++k) {
      const Eigen::Vector2d from =
          points[i] + (points[i + 1] - points[i]) * (static_cast<double>(k) / std::max(pieces, 1));
      const Eigen::Vector2d to =
          points[i] + (points[i + 1] - points[i]) * (static_cast<double>(k + 1) / std::max(pieces, 1));
      if (!is_near(from) && !is_near(to)) {
        end_part();
        continue;
      }
      if (part.empty()) part.push_back(from);
      part.push_back(to);
    }
  }
  end_part();
}

void GroundMap::add_building(const Line& ring) {
  if (std::any_of(ring.begin(), ring.end(), [&](const Eigen::Vector2d& point) { return is_near(point); }))
    buildings_.push_back(ring);
}

std::vector<drawing::Series> GroundMap::series() const {
  for (double apart = kFinest_m;; apart *= 2) {
    drawing::Series roads{.name = "roads", .mark = drawing::Mark::line, .look = drawing::Look::road};
    drawing::Series buildings{
        .name = "buildings", .mark = drawing::Mark::areas, .look = drawing::Look::building};
    roads.in_view = buildings.in_view = false;
    std::size_t count = add_lines(roads_, apart, 2, roads);
    if (apart < kCoarseBuildings_m) count += add_lines(buildings_, apart, 4, buildings);
    if (count > kMostPoints && apart < kCoarsest_m) continue;
    std::vector<drawing::Series> all;
    if (!buildings.x.empty()) all.push_back(std::move(buildings));
    if (!roads.x.empty()) all.push_back(std::move(roads));
    return all;
  }
}

}  // namespace waymark::report

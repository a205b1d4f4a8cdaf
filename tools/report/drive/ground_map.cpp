#include <algorithm>
#include <cmath>
#include <limits>

#include <waymark/tools/report/drive/ground_map.hpp>

namespace waymark::report {
namespace {

constexpr double kFinest_m = 0.25;
constexpr double kCoarsest_m = 16;

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

/// A way as it is drawn.
struct DrawnWay {
  bool is_road = false;
  double extent_m = 0;  ///< how far it goes from where it begins
  std::vector<Eigen::Vector2d> points;
};

/// Thins lines and adds those that are still something to see. Returns their points, with one between lines.
std::size_t add_thinned(const std::vector<std::vector<Eigen::Vector2d>>& lines, double apart, bool is_road,
                        std::vector<DrawnWay>& ways) {
  std::size_t count = 0;
  for (const auto& line : lines) {
    DrawnWay way{.is_road = is_road, .points = thinned(line, apart)};
    if (way.points.size() < (is_road ? 2U : 4U)) continue;
    for (const Eigen::Vector2d& point : way.points)
      way.extent_m = std::max(way.extent_m, (point - way.points.front()).norm());
    count += way.points.size() + 1;
    ways.push_back(std::move(way));
  }
  return count;
}

void append_way(const DrawnWay& way, drawing::Series& series) {
  constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector2d& point : way.points) {
    series.x.push_back(point.x());
    series.y.push_back(point.y());
  }
  series.x.push_back(kBreak);
  series.y.push_back(kBreak);
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
  std::vector<DrawnWay> ways;
  for (double apart = kFinest_m; apart <= kCoarsest_m; apart *= 2) {
    ways.clear();
    const std::size_t roads = add_thinned(roads_, apart, true, ways);
    if (roads + add_thinned(buildings_, apart, false, ways) <= kMostPoints) break;
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](const DrawnWay& a, const DrawnWay& b) { return a.extent_m > b.extent_m; });
  drawing::Series roads{.name = "roads", .mark = drawing::Mark::line, .look = drawing::Look::road};
  drawing::Series buildings{
      .name = "buildings", .mark = drawing::Mark::areas, .look = drawing::Look::building};
  roads.in_view = buildings.in_view = false;
  for (const DrawnWay& way : ways) {
    if (roads.x.size() + buildings.x.size() + way.points.size() + 1 > kMostPoints) break;
    append_way(way, way.is_road ? roads : buildings);
  }
  std::vector<drawing::Series> all;
  if (!buildings.x.empty()) all.push_back(std::move(buildings));
  if (!roads.x.empty()) all.push_back(std::move(roads));
  return all;
}

}  // namespace waymark::report

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include <waymark/tools/drawing/figure/thinning.hpp>

namespace waymark::drawing {
namespace {

constexpr double kNear = 0.4;    // grains
constexpr double kMarker = 2.5;  // grains; a marker is 5 px wide

/// Keeps the needed points of each pixel column.
class Columns {
 public:
  explicit Columns(double width) : width_(width) {}
  void add(const DrawnPoint& point) {
    const double column = std::floor(point.x / width_);
    if (count_ > 0 && column != column_) flush();
    column_ = column;
    if (count_ == 0) first_ = lowest_ = highest_ = point;
    if (point.y < lowest_.y) lowest_ = point;
    if (point.y > highest_.y) highest_ = point;
    last_ = point;
    ++count_;
  }
  [[nodiscard]] std::vector<DrawnPoint> finish() {
    flush();
    return std::move(kept_);
  }

 private:
  void flush() {
    if (count_ == 0) return;
    std::vector<DrawnPoint> of_column = {first_, lowest_, highest_, last_};
    std::sort(of_column.begin(), of_column.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    for (const DrawnPoint& point : of_column) {
      if (kept_.empty() || kept_.back().index != point.index) kept_.push_back(point);
    }
    count_ = 0;
  }

  double width_;
  std::vector<DrawnPoint> kept_;
  DrawnPoint first_, lowest_, highest_, last_;
  double column_ = 0;
  std::size_t count_ = 0;
};

std::vector<DrawnPoint> thin_path(const std::vector<DrawnPoint>& points, double near) {
  std::vector<DrawnPoint> kept;
  for (const DrawnPoint& point : points) {
    const bool ends = point.index == points.back().index;
    if (kept.empty() || ends || std::hypot(point.x - kept.back().x, point.y - kept.back().y) >= near)
      kept.push_back(point);
  }
  return kept;
}

std::vector<DrawnPoint> thin_part(const std::vector<DrawnPoint>& points, double grain) {
  const bool ascends =
      std::is_sorted(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  if (!ascends) return thin_path(points, kNear * grain);
  Columns columns(grain);
  for (const DrawnPoint& point : points) columns.add(point);
  return columns.finish();
}

}  // namespace

std::vector<std::vector<DrawnPoint>> thin_line(const std::vector<double>& x, const std::vector<double>& y,
                                               const View& view) {
  std::vector<std::vector<DrawnPoint>> parts(1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (view.shows(x[i], y[i])) {
      parts.back().push_back({view.px_x(x[i]), view.px_y(y[i]), i});
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty()) parts.pop_back();
  for (auto& part : parts) part = thin_part(part, view.grain);
  return parts;
}

std::vector<DrawnPoint> thin_points(const std::vector<double>& x, const std::vector<double>& y,
                                    const View& view) {
  std::vector<DrawnPoint> kept;
  std::unordered_set<std::int64_t> taken;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!view.shows(x[i], y[i])) continue;
    const DrawnPoint point{view.px_x(x[i]), view.px_y(y[i]), i};
    // A figure is at most a few thousand px wide and high, so 2^20 rows keep the two numbers apart.
    const auto square = (static_cast<std::int64_t>(std::floor(point.x / (kMarker * view.grain))) << 20) +
                        static_cast<std::int64_t>(std::floor(point.y / (kMarker * view.grain)));
    if (taken.insert(square).second) kept.push_back(point);
  }
  return kept;
}

}  // namespace waymark::drawing

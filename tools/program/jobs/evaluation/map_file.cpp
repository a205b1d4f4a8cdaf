#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/program/jobs/evaluation/map_file.hpp>
#include <waymark/tools/report/drive/ground_map.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::program {
namespace {

constexpr double kMargin_m = 2000;
constexpr double kMetresPerDegree = 111'000;

/// A rectangle of longitudes (x) and latitudes (y), degrees.
struct GeodeticBox {
  Eigen::Vector2d low{180, 90};
  Eigen::Vector2d high{-180, -90};

  void add(const Eigen::Vector2d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  [[nodiscard]] bool holds(const Eigen::Vector2d& point) const {
    return (point.array() >= low.array()).all() && (point.array() <= high.array()).all();
  }
};

/// Returns the places of a drive with a margin.
GeodeticBox box_about(const std::vector<Eigen::Vector2d>& positions, const drive::Projection& projection) {
  Eigen::Vector2d low = positions.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& position : positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  GeodeticBox box;
  for (const Eigen::Vector2d& corner :
       {low, high, Eigen::Vector2d(low.x(), high.y()), Eigen::Vector2d(high.x(), low.y())}) {
    const GeodeticPoint place = projection.to_geodetic(corner);
    box.add({place.longitude_deg, place.latitude_deg});
  }
  const double north = kMargin_m / kMetresPerDegree;
  const double east = north / std::max(std::cos(box.high.y() * std::numbers::pi / 180), 0.01);
  box.low -= Eigen::Vector2d(east, north);
  box.high += Eigen::Vector2d(east, north);
  return box;
}

Eigen::Vector2d on_grid(const Eigen::Vector2d& point, const drive::Projection& projection) {
  return projection.to_grid({point.y(), point.x()}).position;
}

/// Keeps the parts of a way that are in the box. A building is kept whole if it begins there.
void keep_near(const formats::MapWay& way, const GeodeticBox& box, const drive::Projection& projection,
               std::vector<formats::MapWay>& ways) {
  formats::MapWay part{way.kind, {}};
  const auto end_part = [&] {
    if (part.points.size() > 1) ways.push_back(part);
    part.points.clear();
  };
  for (const Eigen::Vector2d& point : way.points) {
    if (box.holds(point)) {
      part.points.push_back(on_grid(point, projection));
    } else if (way.kind == formats::WayKind::road) {
      end_part();
    } else {
      return;
    }
  }
  end_part();
}

/// Returns the positions of all poses.
std::vector<Eigen::Vector2d> poses_of(const formats::GraphDocument& document) {
  std::vector<Eigen::Vector2d> positions;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(document.graph.vertex_count()); ++v) {
    if (const auto pose = stamped_pose(document.graph, v)) positions.emplace_back(pose->pose.head<2>());
  }
  return positions;
}

}  // namespace

MapFile read_map_file(const std::string& file, const Frame& frame,
                      const std::vector<Eigen::Vector2d>& positions) {
  if (file.empty()) return {};
  if (frame.zone == 0)
    throw InputError(file + ": a drive in a frame of its own has no place on Earth, and so no map");
  if (positions.empty()) throw InputError(file + ": the drive has no position where the map could be");
  const drive::Projection projection(frame);
  const GeodeticBox box = box_about(positions, projection);
  MapFile map{.name = file};
  const std::size_t ways =
      formats::read_geojson_map(formats::read_text_file(file), file,
                                [&](formats::MapWay&& way) { keep_near(way, box, projection, map.ways); });
  if (map.ways.empty())
    throw InputError(fmt::format(
        "{}: none of its {} roads and buildings is near the drive, which is at longitude {:.4f} to {:.4f} and "
        "latitude {:.4f} to {:.4f}: cut the extract there",
        file, ways, box.low.x(), box.high.x(), box.low.y(), box.high.y()));
  return map;
}

std::vector<Eigen::Vector2d> positions_of(const std::vector<Fix>& fixes) {
  std::vector<Eigen::Vector2d> positions;
  for (const Fix& fix : fixes) positions.push_back(fix.position);
  return positions;
}

std::vector<Eigen::Vector2d> positions_of(const formats::GraphDocument& document) {
  return document.fixes.empty() ? poses_of(document) : positions_of(document.fixes);
}

std::vector<drawing::Series> ground_of(const MapFile& map, const formats::GraphDocument& document) {
  if (map.ways.empty()) return {};
  report::GroundMap ground(poses_of(document));
  for (const formats::MapWay& way : map.ways) {
    if (way.kind == formats::WayKind::road) {
      ground.add_road(way.points);
    } else {
      ground.add_building(way.points);
    }
  }
  return ground.series();
}

}  // namespace waymark::program

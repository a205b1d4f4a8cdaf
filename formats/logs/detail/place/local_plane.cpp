#include <waymark/formats/logs/detail/place/local_plane.hpp>

#include <cmath>
#include <vector>

#include <GeographicLib/LocalCartesian.hpp>

namespace waymark::formats {

std::optional<LocalPlace> place_on_plane(const Eigen::Vector2d& east_north_m, const LocalOrigin& origin) {
  constexpr double kFarthest = 1e6;
  if (!(east_north_m.norm() < kFarthest)) return std::nullopt;
  const GeographicLib::LocalCartesian plane(origin.latitude_deg, origin.longitude_deg, origin.height_m);
  LocalPlace place;
  double up = 0;
  std::vector<double> turn(9);  // from east, north, up of the place to those of the origin, by rows
  for (int round = 0; round < 3; ++round) {
    double height = 0;
    plane.Reverse(east_north_m.x(), east_north_m.y(), up, place.latitude_deg, place.longitude_deg, height,
                  turn);
    up -= height - origin.height_m;
  }
  // The bearing of the plane's north at the place: its parts along true east and north there.
  place.axes.convergence_rad = std::atan2(turn[3], turn[4]);
  return place;
}

}  // namespace waymark::formats

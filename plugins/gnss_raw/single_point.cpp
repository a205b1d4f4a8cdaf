#include <waymark/plugins/gnss_raw/detail/single_point.hpp>

#include <cmath>
#include <vector>

namespace waymark::plugins::gnss_raw {

std::optional<PlaceFromRanges> single_point(const Epoch& epoch, const Eigen::Vector3d& guess, bool turned) {
  std::vector<MeasuredRange> ranges;
  for (const SatelliteReading& reading : epoch.satellites) {
    if (std::isnan(reading.pseudorange_m)) continue;
    // A clock that is 1 ms off turns the satellite by 2 m too much or too little: enough for a start.
    const double travel_s = turned ? 0 : reading.pseudorange_m / kLight_mps;
    ranges.push_back({turned_with_earth(reading.position, travel_s), reading.pseudorange_m});
  }
  return place_from_ranges(ranges, guess);
}

}  // namespace waymark::plugins::gnss_raw

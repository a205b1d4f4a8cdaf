#include <waymark/plugins/gnss_raw/detail/satellite_groups.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace waymark::plugins::gnss_raw {
namespace {

struct Name {
  int system;
  std::string_view letter;
  std::string_view name;
};
constexpr std::array kNames = {Name{kGps, "G", "GPS"}, Name{kSbas, "S", "SBAS"},
                               Name{kGlonass, "R", "GLONASS"}, Name{kGalileo, "E", "Galileo"},
                               Name{kBeidou, "C", "BeiDou"}};

const Name* name_of(int system) {
  const auto known =
      std::find_if(kNames.begin(), kNames.end(), [&](const Name& name) { return name.system == system; });
  return known == kNames.end() ? nullptr : &*known;
}

}  // namespace

std::string satellite_name(int system, int satellite) {
  const Name* known = name_of(system);
  // RINEX writes the PRN of an SBAS satellite, 120 to 158, without its hundred.
  const int number = system == kSbas && satellite > 100 ? satellite - 100 : satellite;
  return (known != nullptr ? std::string(known->letter) : std::to_string(system) + "-") +
         (number < 10 ? "0" : "") + std::to_string(number);
}

std::string system_name(int system) {
  const Name* known = name_of(system);
  return known != nullptr ? std::string(known->name) : "system " + std::to_string(system);
}

void SatelliteGroups::add(EdgePlace edge, const SatelliteReading& reading, const LocalSky& sky,
                          std::string_view quantity, std::string_view unit) {
  if (groups_ == nullptr) return;
  groups_->one = "satellite";
  groups_->many = "satellites";
  groups_->signal_name = "C/N0";
  groups_->signal_unit = "dB-Hz";
  const Eigen::Vector3d towards = sky.local(reading.position);
  groups_->add({.edge = edge,
                .quantity = groups_->quantity(quantity, unit),
                .group = groups_->group(satellite_name(reading.system, reading.satellite),
                                        system_name(reading.system)),
                .signal = reading.cn0_dbhz,
                .bearing_rad = std::atan2(towards.x(), towards.y()),
                .elevation_rad = std::atan2(towards.z(), towards.head<2>().norm())});
}

}  // namespace waymark::plugins::gnss_raw

#include <waymark/formats/satellites/ephemerides.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace waymark::formats::satellites {
namespace {

constexpr double kSlack_s = 60;

double usable_s(System system) {
  switch (system) {
    case System::gps:
      return 7200;
    case System::galileo:
      return 10'800;
    case System::beidou:
      return 3600;
    default:
      return 1800;
  }
}

/// Returns the ephemeris nearest in time; null if there is none that may be used.
template <typename Orbit>
const Orbit* nearest(const std::vector<Orbit>& orbits, Stamp moment, double usable) {
  const Orbit* best = nullptr;
  double least = usable + kSlack_s;
  for (const Orbit& orbit : orbits) {
    const double away = std::abs(seconds_between(orbit.toe, moment));
    if (away > least) continue;
    least = away;
    best = &orbit;
  }
  return best;
}

template <typename Orbit>
std::optional<SatelliteState> state_of_nearest(const std::vector<Orbit>& orbits, Stamp moment,
                                               System system) {
  const Orbit* orbit = nearest(orbits, moment, usable_s(system));
  if (orbit == nullptr || !orbit->is_healthy) return std::nullopt;
  const SatelliteState state = state_of(*orbit, moment);
  if (!state.position.allFinite() || !state.velocity.allFinite()) return std::nullopt;
  return state;
}

}  // namespace

std::string to_string(const SatelliteName& name) {
  const char letter = name.first == System::gps       ? 'G'
                      : name.first == System::sbas    ? 'S'
                      : name.first == System::glonass ? 'R'
                      : name.first == System::galileo ? 'E'
                                                      : 'C';
  const std::string digits = std::to_string(name.second);
  return letter + (digits.size() < 2 ? "0" + digits : digits);
}

void Ephemerides::add(const KeplerOrbit& orbit) {
  kepler_[{orbit.system, orbit.number}].push_back(orbit);
}

void Ephemerides::add(const GlonassOrbit& orbit) {
  glonass_[orbit.number].push_back(orbit);
}

std::optional<SatelliteState> Ephemerides::state(const SatelliteName& name, Stamp moment) const {
  if (name.first == System::glonass) {
    const auto found = glonass_.find(name.second);
    return found == glonass_.end() ? std::nullopt : state_of_nearest(found->second, moment, name.first);
  }
  const auto found = kepler_.find(name);
  return found == kepler_.end() ? std::nullopt : state_of_nearest(found->second, moment, name.first);
}

double Ephemerides::carrier_hz(const SatelliteName& name) const {
  if (name.first == System::beidou) return kBeidouB1_hz;
  if (name.first != System::glonass) return kL1_hz;
  const auto found = glonass_.find(name.second);
  return found == glonass_.end() ? 0 : kGlonassG1_hz + found->second.front().channel * kGlonassStep_hz;
}

std::map<SatelliteName, std::size_t> Ephemerides::counts() const {
  std::map<SatelliteName, std::size_t> counts;
  for (const auto& [name, orbits] : kepler_) counts[name] = orbits.size();
  for (const auto& [number, orbits] : glonass_) counts[{System::glonass, number}] = orbits.size();
  return counts;
}

std::pair<Stamp, Stamp> Ephemerides::times() const {
  Stamp first{std::numeric_limits<std::int64_t>::max()};
  Stamp last{std::numeric_limits<std::int64_t>::min()};
  const auto take = [&](const auto& all) {
    for (const auto& [name, orbits] : all)
      for (const auto& orbit : orbits) {
        first = std::min(first, orbit.toe);
        last = std::max(last, orbit.toe);
      }
  };
  take(kepler_);
  take(glonass_);
  return {first, last};
}

}  // namespace waymark::formats::satellites

// Raw measurements and ephemerides of a UBX log as RTKLIB's convbin (Debian package rtklib) converts them to RINEX. The log
// is made of the real measurements and ephemerides of the shared data.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/rinex/rinex_navigation.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_observations.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/satellites/broadcast/broadcast_messages.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/rinex/shared_raw.hpp"
#include "logs/ubx/raw_frames.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace ubx_raw_peer_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark::formats::satellites;
using namespace waymark_test;

namespace {

constexpr std::int64_t kWeek_ns = 604'800'000'000'000;

/// The numbers of a line of a navigation file, 19 columns each.
void add_numbers(std::string line, std::size_t begin, std::vector<double>& numbers) {
  std::replace(line.begin(), line.end(), 'D', 'E');
  for (std::size_t at = begin; at + 19 <= line.size(); at += 19)
    numbers.push_back(std::strtod(line.substr(at, 19).c_str(), nullptr));
}

/// Reads the ephemerides of GPS from RINEX 2 (letter ' '), or those of a system from RINEX 3.
std::vector<KeplerOrbit> orbits_of(const std::string& path, char letter, int week) {
  const bool two = letter == ' ';
  std::istringstream text(read_text_file(path));
  std::string line;
  while (std::getline(text, line) && line.find("END OF HEADER") == std::string::npos) {
  }
  std::vector<KeplerOrbit> orbits;
  while (std::getline(text, line)) {
    if (!two && line[0] != letter) continue;
    KeplerOrbit orbit;
    orbit.system = two || letter == 'G' ? System::gps : System::beidou;
    orbit.number = std::stoi(line.substr(two ? 0 : 1, 2));
    std::vector<double> n;
    add_numbers(line, two ? 22 : 23, n);
    for (int k = 0; k < 7; ++k) {
      std::getline(text, line);
      line.resize(two ? 79 : 80, ' ');
      add_numbers(line, two ? 3 : 4, n);
    }
    orbit.clock_bias_s = n[0], orbit.clock_drift = n[1], orbit.clock_drift_rate_1_s = n[2];
    orbit.crs = n[4], orbit.mean_motion_difference_radps = n[5], orbit.mean_anomaly_rad = n[6];
    orbit.cuc = n[7], orbit.eccentricity = n[8], orbit.cus = n[9], orbit.sqrt_a = n[10];
    orbit.toe_sow_s = n[11], orbit.cic = n[12], orbit.node_rad = n[13], orbit.cis = n[14];
    orbit.inclination_rad = n[15], orbit.crc = n[16], orbit.perigee_rad = n[17];
    orbit.node_rate_radps = n[18], orbit.inclination_rate_radps = n[19];
    orbit.is_healthy = n[24] == 0, orbit.group_delay_s = n[25];
    orbit.toe = orbit.toc =
        Stamp{week * kWeek_ns}.later(orbit.toe_sow_s + (orbit.system == System::beidou ? 14 : 0));
    orbits.push_back(orbit);
  }
  return orbits;
}

/// Reads the ephemerides of GLONASS from RINEX 2, as far as they are of one day: the stamps are UTC.
std::vector<GlonassOrbit> glonass_orbits_of(const std::string& path) {
  std::istringstream text(read_text_file(path));
  std::string line;
  while (std::getline(text, line) && line.find("END OF HEADER") == std::string::npos) {
  }
  std::vector<GlonassOrbit> orbits;
  constexpr double kKilometre_m = 1000;
  while (std::getline(text, line)) {
    GlonassOrbit orbit;
    orbit.number = std::stoi(line.substr(0, 2));
    const double second_of_day = 3600 * std::stod(line.substr(12, 2)) + 60 * std::stod(line.substr(15, 2)) +
                                 std::stod(line.substr(17, 5));
    constexpr double kMonday_s = 86'400;
    constexpr double kLeapSeconds = 17;
    const bool is_of_the_day = std::stoi(line.substr(9, 2)) == 6;
    orbit.toe = Stamp{1900 * kWeek_ns}.later(kMonday_s + second_of_day + kLeapSeconds);
    std::vector<double> n;
    add_numbers(line, 22, n);
    for (int k = 0; k < 3; ++k) {
      std::getline(text, line);
      line.resize(79, ' ');
      add_numbers(line, 3, n);
    }
    orbit.clock_bias_s = n[0], orbit.clock_drift = n[1];
    orbit.position = kKilometre_m * Eigen::Vector3d(n[3], n[7], n[11]);
    orbit.velocity = kKilometre_m * Eigen::Vector3d(n[4], n[8], n[12]);
    orbit.acceleration = kKilometre_m * Eigen::Vector3d(n[5], n[9], n[13]);
    orbit.is_healthy = n[6] == 0;
    orbit.channel = static_cast<int>(n[10]);
    if (is_of_the_day) orbits.push_back(orbit);
  }
  return orbits;
}

/// The first epochs of an observation file.
std::vector<RawEpoch> epochs_of(const std::string& path, std::size_t count) {
  std::vector<RawEpoch> epochs;
  RinexObservations observations(path,
                                 {[&](const RawEpoch& epoch) { epochs.push_back(epoch); },
                                  [](std::size_t, std::size_t, const std::string&) { FAIL("corrupt"); }});
  std::istringstream text(read_text_file(path));
  std::size_t number = 0;
  for (std::string line; epochs.size() < count && std::getline(text, line);)
    observations.take_line(line, ++number);
  return epochs;
}

double second_of_week(Stamp moment) {
  return static_cast<double>(moment.nanoseconds % kWeek_ns) * 1e-9;
}

std::string rawx_of(const RawEpoch& epoch, System system, int ubx_system) {
  std::vector<RawxMeasurement> measurements;
  for (const RawMeasurement& raw : epoch.satellites)
    if (raw.satellite.first == system)
      measurements.push_back({ubx_system, raw.satellite.second, 0, raw.pseudorange_m,
                              static_cast<float>(raw.doppler_hz), static_cast<int>(raw.cn0_dbhz)});
  return rawx_frame(static_cast<int>(epoch.moment.nanoseconds / kWeek_ns), second_of_week(epoch.moment),
                    measurements);
}

/// The orbits of a moment: one for each satellite, the nearest in time.
std::vector<KeplerOrbit> orbits_at(const std::vector<KeplerOrbit>& all, Stamp moment) {
  std::map<int, KeplerOrbit> nearest;
  const auto away = [&](const KeplerOrbit& orbit) { return std::abs(seconds_between(orbit.toe, moment)); };
  for (const KeplerOrbit& orbit : all) {
    const auto found = nearest.find(orbit.number);
    if (away(orbit) < 7200 && (found == nearest.end() || away(orbit) < away(found->second)))
      nearest[orbit.number] = orbit;
  }
  std::vector<KeplerOrbit> orbits;
  for (const auto& [number, orbit] : nearest) orbits.push_back(orbit);
  return orbits;
}

struct Converted {
  std::string observations, navigation;
};

/// Converts a log by convbin. @returns the paths of its files; nothing if it is not installed
std::optional<Converted> convert_by_rtklib(const std::string& log) {
  if (std::system("command -v convbin >/dev/null 2>&1") != 0) {
    skip("the program convbin (Debian package rtklib) is missing");
    return std::nullopt;
  }
  const std::string folder = scratch_dir().string() + "/";
  std::ofstream(folder + "peer.ubx", std::ios::binary) << log;
  const Converted files{folder + "peer.obs", folder + "peer.nav"};
  const std::string command = "convbin -r ubx -v 3.03 -od -os -o " + files.observations + " -n " +
                              files.navigation + " " + folder + "peer.ubx >/dev/null 2>&1";
  REQUIRE(std::system(command.c_str()) == 0);
  return files;
}

Ephemerides read_navigation(const std::string& path) {
  Ephemerides ephemerides;
  std::vector<std::string> notes;
  read_rinex_navigation(read_companion(path), ephemerides, notes);
  return ephemerides;
}

/// Both have the same satellite in the middle of its ephemeris, and so long before and after.
template <typename Orbit>
void check_same(const Ephemerides& ours, const Ephemerides& theirs, const SatelliteName& name,
                const Orbit& orbit, double away_s) {
  INFO(to_string(name));
  for (const double ahead_s : {-away_s, 0.0, away_s}) {
    const auto a = ours.state(name, orbit.toe.later(ahead_s));
    const auto b = theirs.state(name, orbit.toe.later(ahead_s));
    REQUIRE(a.has_value() == orbit.is_healthy);
    REQUIRE(b.has_value() == orbit.is_healthy);
    if (!a) continue;
    // RINEX has twelve digits: 0.1 mm in an angle, and less than a picosecond.
    CHECK((a->position - b->position).norm() < 1e-3);
    CHECK(std::abs(a->clock_s - b->clock_s) < 1e-12);
    CHECK(std::abs(a->clock_rate - b->clock_rate) < 1e-17);
  }
}

}  // namespace

TEST_CASE("ubx raw: rows and ephemerides of Berlin in UBX are those of RTKLIB's conversion to RINEX") {
  const std::string folder = "drives/berlin_potsdamer_platz_raw/";
  const auto observations = shared_data(folder + "rover.obs");
  if (!observations) return;
  const std::vector<RawEpoch> epochs = epochs_of(*observations, 100);
  const auto orbits =
      orbits_at(orbits_of(*shared_data(folder + "brdc1580.16n"), ' ', 1900), epochs[0].moment);
  REQUIRE(orbits.size() > 20);
  LnavMessages messages;
  Ephemerides ours;
  std::string subframes;
  for (const KeplerOrbit& orbit : orbits) {
    for (const int number : {1, 2, 3}) {
      const auto words = lnav_subframe(orbit, number, 17, 1900 % 1024);
      subframes += sfrbx_frame(0, orbit.number, 0, words);
      messages.take(orbit.number, std::span<const std::uint32_t>(words).first<10>(), epochs[0].moment, ours);
    }
  }
  std::string log;
  for (const RawEpoch& epoch : epochs) {
    log += rawx_of(epoch, System::gps, 0);
    if (&epoch == &epochs[0]) log += subframes;
  }
  const auto files = convert_by_rtklib(log);
  if (!files) return;
  const Ephemerides theirs = read_navigation(files->navigation);
  for (const KeplerOrbit& orbit : orbits) check_same(ours, theirs, {orbit.system, orbit.number}, orbit, 1800);

  LogRequest request;
  request.stream = StreamKind::sensor;
  request.readings = raw_gnss_columns();
  const LogData ubx = builtin_log_reader("ubx")->read(log, "peer.ubx", request);
  request.companions["navigation"] = {read_companion(files->navigation)};
  const LogData rinex = read_log_file(*builtin_log_reader("rinex"), files->observations, request);
  const auto our_rows = rows_by_key(ubx.readings, 1900);
  const auto their_rows = rows_by_key(rinex.readings, 1900);
  CHECK(our_rows.size() > 700);
  CHECK(our_rows.size() == their_rows.size());
  for (const auto& [key, ours_here] : our_rows) {
    const auto found = their_rows.find(key);
    REQUIRE(found != their_rows.end());
    CHECK(std::abs(ours_here[2] - found->second[2]) < 2e-3);  // pseudorange: RINEX has millimetres
    CHECK(std::abs(ours_here[3] - found->second[3]) < 2e-3);  // range rate: and millihertz
    for (const std::size_t axis : {4U, 5U, 6U}) CHECK(std::abs(ours_here[axis] - found->second[axis]) < 1e-3);
    CHECK(ours_here[11] == found->second[11]);
  }
}

TEST_CASE(
    "ubx raw: I/NAV of Galileo, D1 and D2 of BeiDou give the ephemerides that RTKLIB finds in the same words") {
  const auto navigation = shared_data("drives/urbannav_hk_tst/hksc137c.nav");
  if (!navigation) return;
  const Stamp moment = Stamp{2158 * kWeek_ns}.later(93'600);
  std::string log = rawx_frame(2158, second_of_week(moment), {{0, 5, 0, 2e7, 1.0F, 45}});
  std::vector<KeplerOrbit> orbits;
  Ephemerides ours;
  D1Messages beidou;
  D2Messages geostationary;
  InavMessages galileo;
  for (const KeplerOrbit& orbit : orbits_at(orbits_of(*navigation, 'C', 2158), moment)) {
    orbits.push_back(orbit);
    for (int page = 1; is_geostationary_beidou(orbit.number) && page <= 10; ++page) {
      const auto words = d2_page(orbit, page, 93'000U + 3U * static_cast<unsigned>(page), 802);
      log += sfrbx_frame(3, orbit.number, 1, words);
      geostationary.take(orbit.number, std::span<const std::uint32_t>(words).first<10>(), moment, ours);
    }
    if (is_geostationary_beidou(orbit.number)) continue;
    for (const int number : {1, 2, 3}) {
      const auto words = d1_subframe(orbit, number, 93'000U + 6U * static_cast<unsigned>(number), 802);
      log += sfrbx_frame(3, orbit.number, 0, words);
      beidou.take(orbit.number, std::span<const std::uint32_t>(words).first<10>(), moment, ours);
    }
  }
  REQUIRE(orbits.size() >= 5);
  // The elements of GPS are those of a satellite of Galileo, too.
  for (KeplerOrbit orbit : orbits_at(orbits_of(*navigation, 'G', 2158), moment)) {
    if (orbit.number > 30) continue;
    orbit.system = System::galileo;
    orbit.toe_sow_s = 60 * std::floor(orbit.toe_sow_s / 60);
    orbit.toe = orbit.toc = Stamp{2158 * kWeek_ns}.later(orbit.toe_sow_s);
    orbits.push_back(orbit);
    for (const int type : {0, 1, 2, 3, 4, 6, 5}) {  // RTKLIB waits for the other words when 5 comes
      auto words = inav_word(orbit, type, 44, 2158 - 1024);
      words.push_back(0);  // so F9 receivers send E1-B; E5b has eight words
      log += sfrbx_frame(2, orbit.number, 1, words);
      galileo.take(orbit.number, std::span<const std::uint32_t>(words).first<8>(), moment, ours);
    }
  }
  log += rawx_frame(2158, second_of_week(moment) + 1, {{0, 5, 0, 2e7, 1.0F, 45}});
  const auto files = convert_by_rtklib(log);
  if (!files) return;
  const Ephemerides theirs = read_navigation(files->navigation);
  for (const KeplerOrbit& orbit : orbits) check_same(ours, theirs, {orbit.system, orbit.number}, orbit, 1800);
}

TEST_CASE("ubx raw: strings of GLONASS give the ephemerides that RTKLIB finds in the same words") {
  const auto navigation = shared_data("drives/berlin_potsdamer_platz_raw/brdc1580.16g");
  if (!navigation) return;
  const Stamp moment = Stamp{1900 * kWeek_ns}.later(126'700);
  std::string log = rawx_frame(1900, second_of_week(moment), {{0, 5, 0, 2e7, 1.0F, 45}});
  std::vector<GlonassOrbit> orbits;
  Ephemerides ours;
  GlonassStrings strings;
  for (const GlonassOrbit& orbit : glonass_orbits_of(*navigation)) {
    if (std::abs(seconds_between(orbit.toe, moment)) > 900) continue;
    orbits.push_back(orbit);
    // 2016-06-06 is the day 158 of the first year of the interval 6, which begins in 2016.
    for (const int number : {1, 2, 3, 4, 5}) {
      const auto words = glonass_string(orbit, number, 158, 6);
      log += sfrbx_frame(6, orbit.number, 0, words, orbit.channel);
      strings.take(orbit.number, orbit.channel, std::span<const std::uint32_t>(words).first<4>(), moment,
                   ours);
    }
  }
  REQUIRE(orbits.size() > 15);
  log += rawx_frame(1900, second_of_week(moment) + 1, {{0, 5, 0, 2e7, 1.0F, 45}});
  const auto files = convert_by_rtklib(log);
  if (!files) return;
  const Ephemerides theirs = read_navigation(files->navigation);
  for (const GlonassOrbit& orbit : orbits) {
    const SatelliteName name{System::glonass, orbit.number};
    INFO(to_string(name));
    check_same(ours, theirs, name, orbit, 900);
    CHECK(ours.carrier_hz(name) == theirs.carrier_hz(name));
  }
}

}  // namespace ubx_raw_peer_test

// Satellites and corrected pseudoranges of real receivers against those that others computed: libRSF (Berlin), an
// independent export (Hong Kong), and RTKLIB's rnx2rtkp (Debian package rtklib).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <waymark/core/drive/place_from_ranges.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>
#include <waymark/formats/satellites/atmosphere.hpp>

#include "logs/rinex/shared_raw.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace rinex_peers_test {

using namespace waymark;
using namespace waymark_test;

namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kLight = 299'792'458;
const std::string kBerlin = "drives/berlin_potsdamer_platz_raw/";
const std::string kHongKong = "drives/urbannav_hk_tst/";
constexpr int kBerlinWeek = 1900;
constexpr int kHongKongWeek = 2158;

LogData berlin() {
  return read_rinex(kBerlin + "rover.obs", {kBerlin + "brdc1580.16n", kBerlin + "brdc1580.16g"});
}
LogData hong_kong() {
  return read_rinex(kHongKong + "20210517.light-urban.tste.ublox.m8t.GC.obs", {kHongKong + "hksc137c.nav"});
}

double quantile(std::vector<double> values, double share) {
  REQUIRE(!values.empty());
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}
double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

Eigen::Vector3d vector_at(const std::vector<double>& row, std::size_t column) {
  return {row[column], row[column + 1], row[column + 2]};
}
Eigen::Vector3d vector_of(const std::vector<std::string>& words, std::size_t first) {
  return {std::stod(words[first]), std::stod(words[first + 1]), std::stod(words[first + 2])};
}

/// Turns a satellite into the axes of the moment when its signal arrives.
Eigen::Vector3d turned(const Eigen::Vector3d& satellite, double travel_s) {
  return Eigen::AngleAxisd(-7.2921151467e-5 * travel_s, Eigen::Vector3d::UnitZ()) * satellite;
}

/// The delay that the reader takes off in Hong Kong, whose navigation file has no coefficients of the ionosphere, m.
double hong_kong_ionosphere_m(const Eigen::Vector3d& satellite, double second_of_week, int system) {
  const formats::GeodeticPlace place{22.3012, 114.179, 3};
  const Eigen::Vector3d way = formats::enu_from_ecef(place.latitude_deg, place.longitude_deg) *
                              (satellite - formats::ecef_from_geodetic(place));
  const double carrier_hz = system == 32 ? 1561.098e6 : 1575.42e6;
  return std::pow(1575.42e6 / carrier_hz, 2) *
         klobuchar_delay_m(formats::satellites::kTypicalIonosphere, Stamp::from_seconds(second_of_week),
                           place, {std::atan2(way.x(), way.y()), std::asin(way.normalized().z())});
}

struct Differences {
  std::vector<double> position_m, range_m, elevation_deg;
};

/// Runs rnx2rtkp in the scratch folder. @returns the name of its file of residuals; nothing if it is not installed
std::optional<std::string> run_rtklib(const std::string& files) {
  const std::string folder = scratch_dir().string() + "/";
  std::ofstream(folder + "peer.conf")
      << "pos1-posmode=single\npos1-elmask=5\npos1-ionoopt=brdc\npos1-tropopt=saas\npos1-sateph=brdc\n"
         "pos1-navsys=5\nout-solformat=xyz\nout-timesys=gpst\nout-timeform=tow\n";
  const std::string command =
      "rnx2rtkp -k " + folder + "peer.conf -y 2 -o " + folder + "peer.pos " + files + " >/dev/null 2>&1";
  if (std::system("command -v rnx2rtkp >/dev/null 2>&1") != 0) {
    skip("the program rnx2rtkp (Debian package rtklib) is missing");
    return std::nullopt;
  }
  REQUIRE(std::system(command.c_str()) == 0);
  return folder + "peer.pos.stat";
}

/// One epoch of RTKLIB: its position, and the residual of each satellite there.
struct PeerEpoch {
  Eigen::Vector3d position;
  std::vector<std::pair<RawKey, double>> residuals;
};

std::vector<PeerEpoch> peer_epochs(const std::string& stat) {
  std::vector<PeerEpoch> epochs;
  for (const auto& words : words_of_lines(stat)) {
    if (words.empty()) continue;
    if (words[0] == "$POS") epochs.push_back({vector_of(words, 4), {}});
    if (words[0] != "$SAT" || epochs.empty()) continue;
    const int system = words[3][0] == 'G' ? 1 : 4;
    epochs.back().residuals.push_back(
        {{std::lround(std::stod(words[2]) * 10), system, std::stoi(words[3].substr(1))},
         std::stod(words[7])});
  }
  return epochs;
}

}  // namespace

TEST_CASE("rinex: GPS and GLONASS of Berlin agree with the satellites and pseudoranges of libRSF to metres") {
  const auto exported = shared_data(kBerlin + "libRSF_input.txt");
  if (!exported) return;
  const LogData data = berlin();
  CHECK(data.corrupt == 0);
  const auto rows = rows_by_key(data.readings, kBerlinWeek);
  std::map<int, Differences> by_system;
  for (const auto& words : words_of_lines(*exported)) {
    if (words[0] != "pseudorange3") continue;
    const int system = std::stoi(words[8]);
    const int number = std::stoi(words[7]) - (system == 4 ? 300 : 0);
    const double second = 126'641.7 + std::stod(words[1]);
    const auto row = rows.find({std::lround(second * 10), system, number});
    if (row == rows.end()) continue;  // below 5 degrees
    Differences& differences = by_system[system];
    differences.position_m.push_back((vector_at(row->second, 4) - vector_of(words, 4)).norm());
    differences.range_m.push_back(std::abs(row->second[2] - std::stod(words[2])));
    differences.elevation_deg.push_back(std::abs(row->second[10] / kDegree - std::stod(words[9])));
  }
  REQUIRE(by_system.size() == 2);
  for (const auto& [system, differences] : by_system) {
    CHECK(differences.position_m.size() > 5000);
    CHECK(quantile(differences.position_m, 1) < 5);
    CHECK(quantile(differences.range_m, 1) < 5);
    CHECK(quantile(differences.elevation_deg, 1) < 0.01);
  }
}

TEST_CASE(
    "rinex: range rates and velocities of Berlin agree with those that were computed from the Doppler") {
  const auto exported = shared_data(kBerlin + "doppler_gps.csv");
  if (!exported) return;
  const auto rows = rows_by_key(berlin().readings, kBerlinWeek);
  std::size_t count = 0;
  for (const auto& words : words_of_lines(*exported)) {
    if (words[0][0] == 'g') continue;
    const auto row =
        rows.find({std::lround(std::stod(words[0]) * 10), std::stoi(words[1]), std::stoi(words[2])});
    if (row == rows.end()) continue;
    ++count;
    const double travel_s =
        (vector_at(row->second, 4) - Eigen::Vector3d(3.785e6, 9e5, 5.037e6)).norm() / kLight;
    // Theirs are digits of 0.1 mm/s, and their satellites are turned.
    CHECK(row->second[3] == Approx(std::stod(words[3])).margin(1e-4));
    CHECK((turned(vector_at(row->second, 4), travel_s) - vector_of(words, 4)).norm() < 10);
    CHECK((turned(vector_at(row->second, 7), travel_s) - vector_of(words, 7)).norm() < 0.02);
  }
  CHECK(count > 6000);
}

TEST_CASE("rinex: GPS and BeiDou of Hong Kong agree with an independent export, geostationary ones too") {
  const auto exported = shared_data(kHongKong + "pseudorange3.txt");
  if (!exported) return;
  const LogData data = hong_kong();
  CHECK(data.corrupt == 0);
  const auto rows = rows_by_key(data.readings, kHongKongWeek);
  std::map<int, Differences> by_system;
  std::size_t geostationary = 0;
  std::vector<double> delays_m;
  for (const auto& words : words_of_lines(*exported)) {
    const int system = std::stoi(words[8]);
    const int number = std::stoi(words[7]);
    const auto row = rows.find({std::lround(std::stod(words[1]) * 10), system, number});
    REQUIRE(row != rows.end());
    geostationary += system == 32 && number <= 5;
    const double travel_s = row->second[2] / kLight;
    Differences& differences = by_system[system];
    differences.position_m.push_back(
        (turned(vector_at(row->second, 4), travel_s) - vector_of(words, 4)).norm());
    const double ionosphere_m =
        hong_kong_ionosphere_m(vector_of(words, 4), std::stod(words[1]), system);  // they leave it
    differences.range_m.push_back(std::abs(row->second[2] + ionosphere_m - std::stod(words[2])));
    delays_m.push_back(ionosphere_m);
  }
  CHECK(median(delays_m) > 2);
  CHECK(geostationary > 1000);
  REQUIRE(by_system.size() == 2);
  for (const auto& [system, differences] : by_system) {
    CHECK(median(differences.position_m) < 3);
    // Near the border of two ephemerides of a satellite they may take the other one.
    CHECK(quantile(differences.position_m, 1) < 15);
    CHECK(median(differences.range_m) < 0.05);
    CHECK(quantile(differences.range_m, 1) < 5);
  }
}

TEST_CASE("rinex: the residuals of RTKLIB's single-point positions are ours to centimetres") {
  const auto observations = shared_data(kBerlin + "rover.obs");
  if (!observations) return;
  const std::string folder = shared_data_dir().string() + "/" + kBerlin;
  const auto stat = run_rtklib(*observations + " " + folder + "brdc1580.16n " + folder + "brdc1580.16g");
  if (!stat) return;
  const auto rows = rows_by_key(berlin().readings, kBerlinWeek);
  std::map<int, std::vector<double>> apart;
  std::vector<double> positions_apart;
  for (const PeerEpoch& epoch : peer_epochs(*stat)) {
    std::map<int, std::vector<double>> ours_minus_theirs;
    std::vector<MeasuredRange> ranges;
    for (const auto& [key, residual] : epoch.residuals) {
      const auto row = rows.find(key);
      if (row == rows.end()) continue;
      const Eigen::Vector3d left = vector_at(row->second, 4);
      const Eigen::Vector3d satellite = turned(left, (left - epoch.position).norm() / kLight);
      ours_minus_theirs[std::get<1>(key)].push_back(row->second[2] - (satellite - epoch.position).norm() -
                                                    residual);
      ranges.push_back({satellite, row->second[2]});
    }
    // The clock is a state of theirs, one for each system.
    for (const auto& [system, differences] : ours_minus_theirs)
      for (const double difference : differences)
        apart[system].push_back(std::abs(difference - median(differences)));
    if (const auto place = place_from_ranges(ranges, epoch.position))
      positions_apart.push_back((place->position - epoch.position).norm());
  }
  REQUIRE(apart.size() == 2);
  for (const auto& [system, differences] : apart) {
    CHECK(differences.size() > 50);
    CAPTURE(system, median(differences), quantile(differences, 1), median(positions_apart),
            quantile(positions_apart, 1));
    CHECK(median(differences) < 0.03);
    CHECK(quantile(differences, 1) < 0.3);
  }
  CHECK(median(positions_apart) < 20);
}

}  // namespace rinex_peers_test

// Raw measurements of UBX logs: frames made by hand with known values, and damaged ones.
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/ubx/ubx_raw.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "logs/log_pieces.hpp"
#include "logs/rinex/made_rinex.hpp"
#include "logs/rinex/shared_raw.hpp"
#include "logs/ubx/raw_frames.hpp"
#include "logs/ubx/ubx_bytes.hpp"

namespace ubx_raw_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark::formats::satellites;
using namespace waymark_test;
using Catch::Matchers::Contains;

namespace {

constexpr int kWeek = 1900;
constexpr double kTow = 129'600;  // Monday, 12:00
constexpr std::int64_t kWeek_ns = 604'800'000'000'000;
constexpr double kLight = 299'792'458;

Stamp at(double second_of_week) {
  return Stamp{kWeek * kWeek_ns}.later(second_of_week);
}

/// An orbit whose elements are whole steps of all three messages. @param k moves it along the equator and the orbit
KeplerOrbit orbit(System system, int number, int k) {
  constexpr double kPi = std::numbers::pi;
  KeplerOrbit orbit;
  orbit.system = system;
  orbit.number = number;
  const double behind_s = system == System::beidou ? 14 : 0;
  orbit.toe_sow_s = kTow;
  orbit.toe = at(kTow).later(behind_s);
  orbit.toc = at(kTow).later(behind_s);
  orbit.clock_bias_s = -std::ldexp(1234 + k, -28), orbit.clock_drift = std::ldexp(-31, -43);
  orbit.group_delay_s = system == System::beidou ? -51e-10 : -std::ldexp(11, -31);
  orbit.sqrt_a = 5153.5 + 0.125 * k, orbit.eccentricity = std::ldexp(1 + k, -9);
  orbit.mean_anomaly_rad = kPi * (0.0625 * k - 0.5),
  orbit.mean_motion_difference_radps = kPi * std::ldexp(12000, -43);
  orbit.node_rad = kPi * (0.125 * k - 0.75), orbit.node_rate_radps = -kPi * std::ldexp(22000, -43);
  orbit.inclination_rad = kPi * 0.3125, orbit.inclination_rate_radps = kPi * std::ldexp(-150, -43);
  orbit.perigee_rad = -kPi * 0.1875;
  orbit.cuc = -std::ldexp(1500, -29), orbit.cus = std::ldexp(4000, -29);
  orbit.crc = std::ldexp(7000, -5), orbit.crs = -std::ldexp(900, -5);
  orbit.cic = std::ldexp(-77, -29), orbit.cis = std::ldexp(88, -29);
  return orbit;
}

void check_same_orbit(const Ephemerides& ephemerides, const KeplerOrbit& sent) {
  for (const double ahead_s : {-3000.0, 0.0, 3000.0}) {
    const auto found = ephemerides.state({sent.system, sent.number}, sent.toe.later(ahead_s));
    REQUIRE(found);
    const SatelliteState expected = state_of(sent, sent.toe.later(ahead_s));
    // Elements are rounded to bits only.
    CHECK((found->position - expected.position).norm() < 1e-5);
    CHECK((found->velocity - expected.velocity).norm() < 1e-8);
    CHECK(found->clock_s == Approx(expected.clock_s).epsilon(1e-12));
    CHECK(found->clock_rate == Approx(expected.clock_rate).epsilon(1e-6));
  }
}

template <std::size_t Count>
std::span<const std::uint32_t, Count> first_of(const std::vector<std::uint32_t>& words) {
  return std::span<const std::uint32_t>(words).template first<Count>();
}

LogRequest request() {
  LogRequest result;
  result.stream = StreamKind::sensor;
  result.readings = raw_gnss_columns();
  return result;
}

LogData decode(const std::string& log, const LogRequest& how = request()) {
  const auto decoder = builtin_log_reader("ubx")->open("log.ubx", how);
  decoder->take(log);
  decoder->finish();
  return decoder->data();
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

std::string gps_subframes(const KeplerOrbit& orbit, unsigned issue) {
  std::string log;
  for (const int number : {1, 2, 3})
    log += sfrbx_frame(0, orbit.number, 0, lnav_subframe(orbit, number, issue, kWeek % 1024));
  return log;
}

/// The place of the receiver: 50 degrees north, 10 degrees east, about.
const Eigen::Vector3d kReceiver(4'045'000, 713'000, 4'863'000);

/// A log with ephemerides and measurements of the satellites above; their pseudoranges are those of a receiver whose clock
/// is right, without an atmosphere.
std::string whole_log(int epochs, std::vector<int>& seen) {
  std::string ephemerides, log;
  std::vector<KeplerOrbit> orbits;
  for (int k = 1; k <= 32; ++k) orbits.push_back(orbit(System::gps, k, k));
  for (const KeplerOrbit& one : orbits) {
    const SatelliteState state = state_of(one, at(kTow));
    if ((state.position - kReceiver).normalized().dot(kReceiver.normalized()) < 0.2) continue;
    seen.push_back(one.number);
    ephemerides += gps_subframes(one, 7);
  }
  for (int second = 0; second < epochs; ++second) {
    std::vector<RawxMeasurement> measurements;
    for (const int number : seen) {
      const KeplerOrbit& one = orbits[static_cast<std::size_t>(number - 1)];
      double range = 22e6;
      double clock_s = 0;
      for (int i = 0; i < 6; ++i) {
        const double travel_s = range / kLight;
        const SatelliteState state = state_of(one, at(kTow + second - travel_s));
        const double turn = 7.2921151467e-5 * travel_s;
        const Eigen::Vector3d p = state.position;
        const Eigen::Vector3d turned(p.x() * std::cos(turn) + p.y() * std::sin(turn),
                                     p.y() * std::cos(turn) - p.x() * std::sin(turn), p.z());
        range = (turned - kReceiver).norm();
        clock_s = state.clock_s;
      }
      measurements.push_back({0, number, 0, range - kLight * clock_s, 1000.5F, 40});
    }
    log += rawx_frame(kWeek, kTow + second, measurements);
    if (second == 2) log += ephemerides;
  }
  return log;
}

}  // namespace

TEST_CASE("ubx raw: the parity of real words of GPS is right, and of none with one bit wrong") {
  // A subframe of a real receiver (GPS 5, 2020), as the tests of pyubx2 list it.
  const std::vector<std::uint32_t> words{583028782, 2463198336, 394902765,  2566867280, 1062207503,
                                         675481840, 616371498,  2740700967, 768066377,  3045061856};
  for (const std::uint32_t word : words) {
    CHECK(lnav_parity_is_right(word));
    for (unsigned bit = 0; bit < 30; ++bit) CHECK_FALSE(lnav_parity_is_right(word ^ 1U << bit));
  }
}

TEST_CASE("ubx raw: LNAV gives the orbit and the clock that were sent, once for each issue") {
  const KeplerOrbit sent = orbit(System::gps, 5, 3);
  LnavMessages messages;
  Ephemerides ephemerides;
  const auto take = [&](int number, unsigned issue) {
    return messages.take(5, first_of<10>(lnav_subframe(sent, number, issue, 876)), at(kTow + 5000),
                         ephemerides);
  };
  CHECK(take(1, 7) == LnavMessages::Found::nothing);
  CHECK(take(2, 7) == LnavMessages::Found::nothing);
  CHECK(take(3, 8) == LnavMessages::Found::nothing);  // of another issue
  CHECK(ephemerides.empty());
  CHECK(take(3, 7) == LnavMessages::Found::ephemeris);
  CHECK(take(3, 7) == LnavMessages::Found::nothing);
  check_same_orbit(ephemerides, sent);
  auto broken = lnav_subframe(sent, 1, 9, 876);
  broken[6] ^= 1U << 20U;
  CHECK(messages.take(5, first_of<10>(broken), at(kTow), ephemerides) == LnavMessages::Found::wrong_parity);
}

TEST_CASE("ubx raw: a satellite of GPS that calls itself unhealthy is not used, and the week may end") {
  KeplerOrbit sent = orbit(System::gps, 9, 1);
  sent.is_healthy = false;
  sent.toe_sow_s = 0;
  sent.toe = sent.toc = at(604'800);
  LnavMessages messages;
  Ephemerides ephemerides;
  for (const int number : {1, 2, 3})
    messages.take(9, first_of<10>(lnav_subframe(sent, number, 1, 877)), at(604'000), ephemerides);
  CHECK(ephemerides.times().first == at(604'800));
  CHECK_FALSE(ephemerides.state({System::gps, 9}, at(604'700)));
  sent.is_healthy = true;
  messages.take(9, first_of<10>(lnav_subframe(sent, 1, 1, 877)), at(604'010), ephemerides);
  CHECK(ephemerides.times().second == at(604'800));
}

TEST_CASE("ubx raw: page 18 of subframe 4 has the coefficients of the ionosphere") {
  LnavMessages messages;
  Ephemerides ephemerides;
  const auto found = messages.take(5, first_of<10>(lnav_ionosphere_page({7, 3, -2, -1, 42, -6, 1, -8})),
                                   at(kTow), ephemerides);
  CHECK(found == LnavMessages::Found::ionosphere);
  REQUIRE(ephemerides.ionosphere);
  CHECK(ephemerides.ionosphere->alpha ==
        std::array{std::ldexp(7, -30), std::ldexp(3, -27), std::ldexp(-2, -24), std::ldexp(-1, -24)});
  CHECK(ephemerides.ionosphere->beta ==
        std::array{std::ldexp(42, 11), std::ldexp(-6, 14), std::ldexp(1, 16), std::ldexp(-8, 16)});
}

TEST_CASE("ubx raw: I/NAV gives the orbit and the clock that were sent, and a wrong checksum nothing") {
  const KeplerOrbit sent = orbit(System::galileo, 11, 2);
  InavMessages messages;
  Ephemerides ephemerides;
  auto broken = inav_word(sent, 4, 33, 876);
  broken[1] ^= 1U << 9U;
  CHECK(messages.take(11, first_of<8>(broken), at(kTow), ephemerides) == InavMessages::Found::wrong_checksum);
  for (const int type : {1, 2, 3, 4})
    CHECK(messages.take(11, first_of<8>(inav_word(sent, type, 33, 876)), at(kTow), ephemerides) ==
          InavMessages::Found::nothing);
  CHECK(messages.take(11, first_of<8>(inav_word(sent, 5, 33, 876)), at(kTow), ephemerides) ==
        InavMessages::Found::ephemeris);
  check_same_orbit(ephemerides, sent);
}

TEST_CASE("ubx raw: D1 gives the orbit and the clock that were sent, if its subframes follow one another") {
  const KeplerOrbit sent = orbit(System::beidou, 14, 5);
  D1Messages messages;
  Ephemerides ephemerides;
  const auto take = [&](int number, unsigned second) {
    return messages.take(14, first_of<10>(d1_subframe(sent, number, second, 544)), at(kTow), ephemerides);
  };
  CHECK_FALSE(take(1, 129'000));
  CHECK_FALSE(take(2, 129'006));
  CHECK_FALSE(take(3, 129'042));  // of the next frame
  CHECK(take(3, 129'012));
  CHECK_FALSE(take(3, 129'012));
  check_same_orbit(ephemerides, sent);
}

TEST_CASE("ubx raw: D2 gives the orbit and the clock that were sent, if its pages follow one another") {
  KeplerOrbit sent = orbit(System::beidou, 3, 5);
  sent.sqrt_a = 6493.375;
  sent.inclination_rad = std::numbers::pi * 0.03125;
  D2Messages messages;
  Ephemerides ephemerides;
  const auto take = [&](int page, unsigned second) {
    return messages.take(3, first_of<10>(d2_page(sent, page, second, 544)), at(kTow), ephemerides);
  };
  for (int page = 1; page < 10; ++page)
    CHECK_FALSE(take(page, 129'000U + 3U * static_cast<unsigned>(page - 1)));
  CHECK_FALSE(take(10, 129'057));  // of the next cycle
  CHECK(take(10, 129'027));
  CHECK_FALSE(take(10, 129'027));
  check_same_orbit(ephemerides, sent);
}

TEST_CASE("ubx raw: strings of GLONASS give the orbit and the clock that were sent, over midnight too") {
  GlonassOrbit sent;
  sent.number = 11;
  sent.channel = -4;
  sent.position = {1000 * std::ldexp(30'000'001, -11), -1000 * std::ldexp(35'000'000, -11),
                   1000 * std::ldexp(25'000'000, -11)};
  sent.velocity = {-1000 * std::ldexp(1'500'000, -20), 1000 * std::ldexp(700'000, -20),
                   1000 * std::ldexp(2'900'000, -20)};
  sent.acceleration = {1000 * std::ldexp(2, -30), 0, -1000 * std::ldexp(3, -30)};
  sent.clock_bias_s = -std::ldexp(54'321, -30);
  sent.clock_drift = std::ldexp(3, -40);
  const auto quarter = [](double second_of_week) {
    return at(second_of_week + 17);
  };  // 17 leap seconds in 2016
  for (const auto& [toe_s, received_s] :
       std::vector<std::pair<double, double>>{{kTow + 900, kTow + 100},
                                              {86'400 - 10'800, 86'400 - 12'000},
                                              {2 * 86'400 - 9'900, 2 * 86'400 - 11'000}}) {
    sent.toe = quarter(toe_s);
    const double near_s = received_s;  // clang 14 captures no structured binding
    GlonassStrings strings;
    Ephemerides ephemerides;
    const auto take = [&](int number) {
      return strings.take(11, -4, first_of<4>(glonass_string(sent, number, 888, 6)), at(near_s), ephemerides);
    };
    using Found = GlonassStrings::Found;
    CHECK(take(2) == Found::nothing);  // of a frame whose first string was lost
    for (const int number : {1, 2, 3, 5}) CHECK(take(number) == Found::nothing);
    CHECK(take(4) == Found::ephemeris);
    for (const int number : {1, 2, 3, 4}) CHECK(take(number) == Found::nothing);  // once
    const auto found = ephemerides.state({System::glonass, 11}, sent.toe.later(600));
    REQUIRE(found);
    const SatelliteState expected = state_of(sent, sent.toe.later(600));
    CHECK((found->position - expected.position).norm() < 1e-6);
    CHECK(found->clock_s == Approx(expected.clock_s).epsilon(1e-14));
    CHECK(ephemerides.carrier_hz({System::glonass, 11}) == 1602e6 - 4 * 562.5e3);
  }
}

TEST_CASE("ubx raw: no bit of a string of GLONASS may be wrong, and strings of two frames do not mix") {
  GlonassOrbit sent;
  sent.number = 2;
  sent.position = {2.5e7, 0, 0};
  sent.toe = at(kTow + 917);
  GlonassStrings strings;
  Ephemerides ephemerides;
  using Found = GlonassStrings::Found;
  for (std::size_t bit = 0; bit < 85; ++bit) {
    auto words = glonass_string(sent, 2, 888, 6);
    words[bit / 32] ^= 1U << (31 - bit % 32);
    CHECK(strings.take(2, 0, first_of<4>(words), at(kTow), ephemerides) == Found::wrong_checksum);
  }
  for (const int number : {1, 2, 3, 2, 3, 4})  // the end of a frame and the begin of the next are lost
    CHECK(strings.take(2, 0, first_of<4>(glonass_string(sent, number, 888, 6)), at(kTow), ephemerides) ==
          Found::nothing);
  CHECK(ephemerides.empty());
}

TEST_CASE("ubx raw: RXM-RAWX gives time, pseudorange, Doppler and C/N0 of the first frequency") {
  const std::string frame = rawx_frame(kWeek, 1234.5,
                                       {{0, 5, 0, 20'000'000.25, -1500.5F, 47},    // GPS L1 C/A
                                        {0, 5, 3, 20'000'003.0, -1169.0F, 40},     // L2 CL
                                        {2, 11, 0, 24'000'000.0, 10.0F, 33},       // E1-C
                                        {2, 11, 1, 24'000'001.0, 10.0F, 33},       // E1-B, the same satellite
                                        {3, 14, 0, 23'000'000.0, 20.0F, 0},        // B1I, no C/N0
                                        {6, 255, 0, 21'000'000.0, 30.0F, 40},      // GLONASS, not known yet
                                        {6, 8, 0, 21'000'000.0, 2e5F, 40},         // no such Doppler
                                        {1, 123, 0, 38'000'000.0, 0.5F, 40},       // SBAS
                                        {5, 1, 0, 36'000'000.0, 0.5F, 40},         // QZSS
                                        {0, 7, 0, 20'000'000.0, 1.0F, 40, false},  // not valid
                                        {0, 8, 0, 12.0, 1.0F, 40}});               // no such range
  const UbxPayload payload(std::string_view(frame).substr(6, frame.size() - 8));
  CHECK(rawx_error(payload).empty());
  const UbxRawEpoch raw = read_rxm_rawx(payload);
  CHECK(raw.epoch.moment == at(1234.5));
  CHECK(raw.unused == 6);
  REQUIRE(raw.epoch.satellites.size() == 5);
  const auto& gps = raw.epoch.satellites[0];
  CHECK(gps.satellite == SatelliteName{System::gps, 5});
  CHECK(gps.pseudorange_m == 20'000'000.25);
  CHECK(gps.doppler_hz == -1500.5);
  CHECK(gps.cn0_dbhz == 47);
  CHECK(raw.epoch.satellites[1].pseudorange_m == 24'000'000);
  CHECK(std::isnan(raw.epoch.satellites[2].cn0_dbhz));
  CHECK(std::isnan(raw.epoch.satellites[3].doppler_hz));
  CHECK(raw.epoch.satellites[4].satellite == SatelliteName{System::sbas, 23});
}

TEST_CASE("ubx raw: a log with its own ephemerides gives corrected rows from its first epoch on") {
  std::vector<int> seen;
  const std::string log = whole_log(5, seen);
  REQUIRE(seen.size() >= 5);
  const LogData data = check_pieces(*builtin_log_reader("ubx"), log, "log.ubx", request());
  CHECK(data.corrupt == 0);
  CHECK(data.readings.size() == 5 * seen.size());
  CHECK(data.readings.stamps.front() == at(kTow));
  CHECK(any_contains(data.notes, std::to_string(seen.size()) + " ephemerides come from"));
  for (std::size_t row = 0; row < data.readings.size(); ++row) {
    const KeplerOrbit one = orbit(System::gps, static_cast<int>(data.readings.at(row, 1)),
                                  static_cast<int>(data.readings.at(row, 1)));
    const Eigen::Vector3d satellite(data.readings.at(row, 4), data.readings.at(row, 5),
                                    data.readings.at(row, 6));
    const Stamp sent = data.readings.stamps[row].later(-(satellite - kReceiver).norm() / kLight);
    CHECK((state_of(one, sent).position - satellite).norm() < 1);
    // What is left of the pseudorange: the distance, the turning Earth, and the troposphere, 2.4 m in the zenith.
    const double distance = (satellite - kReceiver).norm();
    CHECK(std::abs(data.readings.at(row, 2) - distance) < 60);
    CHECK(data.readings.at(row, 11) == 40);
  }
  CHECK(builtin_log_reader("ubx")->recognise(log).certainty == 1);
}

TEST_CASE("ubx raw: ephemerides of a navigation file take the place of those of the log") {
  LogRequest with_file = request();
  with_file.companions["navigation"] = {{"brdc.nav", made_rinex_navigation()}};
  std::string log;
  for (int second = 0; second < 3; ++second)
    log += rawx_frame(kWeek, second, {{0, 5, 0, 20'182'000, 100.0F, 45}, {0, 6, 0, 20'182'000, 100.0F, 45}});
  log += gps_subframes(orbit(System::gps, 6, 1), 3);
  // One satellite gives no position.
  CHECK_THROWS_WITH(decode(log, with_file), Contains("log.ubx: no epoch has five satellites"));
  LogRequest other = request();
  other.companions["dbc"] = {{"car.dbc", ""}};
  CHECK_THROWS_WITH(decode(log, other), Contains("a UBX log of raw measurements takes no 'dbc' file"));
}

TEST_CASE("ubx raw: a log without ephemerides names the remedy") {
  std::string log;
  for (int second = 0; second < 3; ++second)
    log += rawx_frame(kWeek, kTow + second, {{0, 5, 0, 2e7, 1.0F, 45}});
  CHECK_THROWS_WITH(
      decode(log),
      "log.ubx: no message of the log holds a whole ephemeris from 2016-06-06T12:00:00 to "
      "2016-06-06T12:00:02 (GPS time); name the broadcast ephemerides of that day with 'navigation: FILE'");
  CHECK_THROWS_WITH(decode(log, {}),
                    "log.ubx: the log holds no positions but 3 messages RXM-RAWX; fuse these with 'sensors: "
                    "{name: gnss_raw, file: ...}'");
  CHECK(any_contains(decode(ubx_frame(0x0107, nav_pvt().bytes())).notes,
                     "the log holds no message RXM-RAWX; enable it at the receiver"));
}

TEST_CASE("ubx raw: damaged messages are corrupt, wrong parities and unknown weeks are noted") {
  std::vector<int> seen;
  const std::string sound = whole_log(4, seen);
  std::string flipped = sound;
  flipped[30] ^= 1;
  CHECK(decode(flipped).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: RXM-RAWX: the checksum is wrong"});
  std::string short_frame = rawx_frame(kWeek, kTow, {{0, 5, 0, 2e7, 1.0F, 45}});
  short_frame = ubx_frame(0x0215, std::string_view(short_frame).substr(6, 16 + 31));
  CHECK(decode(short_frame + sound).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: RXM-RAWX: 47 bytes, but 1 measurements need 48"});
  CHECK(decode(ubx_frame(0x0215, "abc") + sound).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: RXM-RAWX: 3 bytes, but the message has at least 16"});
  CHECK(decode(rawx_frame(kWeek, -1, {}) + sound).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: RXM-RAWX: the time of the week is outside 0 .. 604800 s"});
  CHECK(decode(rawx_frame(20'000, 1, {}) + sound).corrupt == 1);
  UbxBytes words(12);
  words.u8(4, 200);
  CHECK(decode(ubx_frame(0x0213, words.bytes()) + sound).corrupt_examples ==
        std::vector<std::string>{"log.ubx:byte 0: RXM-SFRBX: 12 bytes cannot hold 200 words"});
  CHECK(any_contains(decode(rawx_frame(0, 5, {}) + sound).notes,
                     "1 messages RXM-RAWX come before the receiver knows"));
  auto subframe = lnav_subframe(orbit(System::gps, 5, 1), 1, 7, 876);
  subframe[4] ^= 1U << 12U;
  CHECK(any_contains(decode(sfrbx_frame(0, 5, 0, subframe) + sound).notes,
                     "1 messages RXM-SFRBX have a wrong parity and are left out"));
}

}  // namespace ubx_raw_test

#include <waymark/formats/logs/detail/rinex/rinex_navigation.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_fields.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

using satellites::System;

constexpr std::size_t kNumberWidth = 19;

/// A record: its first line has a clock, the others four numbers each.
struct NavigationRecord {
  satellites::SatelliteName satellite;
  Stamp clock_time;                  ///< as written, without a scale
  std::array<double, 31> numbers{};  ///< in the order of the file
};

/// Tells by the data sources of a record of Galileo whether its clock is that of E1 and E5b (I/NAV) or that of
/// E1 and E5a (F/NAV).
bool is_of_e5b(double sources) {
  constexpr unsigned kOfE5a = 1U << 8U;
  return sources >= 0 && sources < 1024 && (static_cast<unsigned>(sources) & kOfE5a) == 0;
}

/// Galileo's health of E1-B: data invalid (bit 0), signal state (bits 1, 2).
bool galileo_is_healthy(double health) {
  return health >= 0 && health < 1024 && (static_cast<unsigned>(health) & 7U) == 0;
}

std::optional<satellites::KeplerOrbit> kepler_of(const NavigationRecord& record) {
  const auto& n = record.numbers;
  satellites::KeplerOrbit orbit;
  orbit.system = record.satellite.first;
  orbit.number = record.satellite.second;
  orbit.clock_bias_s = n[0], orbit.clock_drift = n[1], orbit.clock_drift_rate_1_s = n[2];
  orbit.crs = n[4], orbit.mean_motion_difference_radps = n[5], orbit.mean_anomaly_rad = n[6];
  orbit.cuc = n[7], orbit.eccentricity = n[8], orbit.cus = n[9], orbit.sqrt_a = n[10];
  orbit.toe_sow_s = n[11], orbit.cic = n[12], orbit.node_rad = n[13], orbit.cis = n[14];
  orbit.inclination_rad = n[15], orbit.crc = n[16], orbit.perigee_rad = n[17], orbit.node_rate_radps = n[18];
  orbit.inclination_rate_radps = n[19];
  const double behind_s = orbit.system == System::beidou ? satellites::kBeidouBehind_s : 0;
  if (!satellites::is_possible(orbit)) return std::nullopt;
  orbit.toe = in_nearest_week(record.clock_time, orbit.toe_sow_s).later(behind_s);
  orbit.toc = record.clock_time.later(behind_s);
  if (orbit.system == System::galileo) {
    orbit.is_healthy = galileo_is_healthy(n[24]);
    orbit.group_delay_s = is_of_e5b(n[20]) ? n[26] : n[25];
  } else {
    orbit.is_healthy = n[24] == 0;
    orbit.group_delay_s = n[25];
  }
  return orbit;
}

std::optional<satellites::GlonassOrbit> glonass_of(const NavigationRecord& record) {
  const auto& n = record.numbers;
  constexpr double kKilometre = 1000;
  satellites::GlonassOrbit orbit;
  orbit.number = record.satellite.second;
  orbit.toe = convert(Stamp{record.clock_time.nanoseconds + kGpsEpochPosix}, TimeScale::utc, TimeScale::gps);
  orbit.clock_bias_s = n[0], orbit.clock_drift = n[1];
  orbit.position = kKilometre * Eigen::Vector3d(n[3], n[7], n[11]);
  orbit.velocity = kKilometre * Eigen::Vector3d(n[4], n[8], n[12]);
  orbit.acceleration = kKilometre * Eigen::Vector3d(n[5], n[9], n[13]);
  orbit.is_healthy = n[6] == 0;
  orbit.channel = std::abs(n[10]) < 1000 ? static_cast<int>(std::lround(n[10])) : 1000;
  // Old files count channels -7 .. -1 as 249 and so on.
  if (orbit.channel > 127) orbit.channel -= 256;
  return is_possible(orbit) ? std::optional(orbit) : std::nullopt;
}

class NavigationReader {
 public:
  NavigationReader(const CompanionFile& file, satellites::Ephemerides& ephemerides)
      : file_(file), rest_(file.text), ephemerides_(ephemerides) {}

  void read() {
    read_header();
    while (next_line()) read_record();
    if (used_ == 0)
      throw InputError(
          fmt::format("{}: the navigation file holds no ephemeris{}; take a file of broadcast ephemerides "
                      "of the day",
                      file_.path, unusable_ == 0 ? "" : " that can be used (" + first_trouble_ + ")"));
  }

  void add_notes(std::vector<std::string>& notes) const {
    if (unusable_ > 0)
      notes.push_back(fmt::format("{}: {} records could not be used, the first one: {}", file_.path,
                                  unusable_, first_trouble_));
  }

 private:
  /// Goes to the next line, or stays once if the line is held.
  bool next_line() {
    if (std::exchange(is_held_, false)) return true;
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    ++number_;
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_.path, number_, what));
  }

  void read_header() {
    const auto version = next_line() ? rinex_version(line_) : std::nullopt;
    if (!version)
      throw InputError(fmt::format(
          "{}:1: expected a RINEX navigation file, whose first line ends with 'RINEX VERSION / TYPE'",
          file_.path));
    if (version->kind == 'O')
      fail("this is an observation file; 'navigation' names a file of broadcast ephemerides");
    if (version->version < 2 || version->version >= 4)
      fail(fmt::format("RINEX {:.2f} is not read, only 2 and 3; RTKLIB's convbin or gfzrnx converts it",
                       version->version));
    version_ = version->version;
    is_version_3_ = version_ >= 3;
    is_glonass_ = version->kind == 'G';
    if (!is_version_3_ && version->kind == 'H')
      fail("this is a navigation file of SBAS, which is not used; leave it out");
    if (version->kind != 'N' && version->kind != 'G')
      fail(fmt::format("expected a navigation file, whose type is N or G, got '{}'",
                       shown_name({&version->kind, 1})));
    while (next_line()) {
      const std::string_view label = rinex_label(line_);
      if (label == "END OF HEADER") return;
      if (label == "ION ALPHA") read_ionosphere(2, true);
      if (label == "ION BETA") read_ionosphere(2, false);
      if (label == "IONOSPHERIC CORR" && line_.starts_with("GPSA")) read_ionosphere(5, true);
      if (label == "IONOSPHERIC CORR" && line_.starts_with("GPSB")) read_ionosphere(5, false);
    }
    fail("the file ends in its header; fetch it again");
  }

  void read_ionosphere(std::size_t begin, bool alpha) {
    satellites::KlobucharCoefficients coefficients =
        ephemerides_.ionosphere.value_or(satellites::KlobucharCoefficients{});
    for (std::size_t i = 0; i < 4; ++i) {
      const auto number = rinex_number(line_, begin + 12 * i, 12);
      if (!number) return;
      (alpha ? coefficients.alpha : coefficients.beta)[i] = *number;
    }
    ephemerides_.ionosphere = coefficients;
  }

  /// Reads a record whose first line is there.
  void read_record() {
    if (line_.find_first_not_of(' ') == std::string_view::npos) return;
    const std::size_t first = number_;
    const char letter = is_version_3_ ? line_[0] : is_glonass_ ? 'R' : 'G';
    if (std::string_view("GRECSJI").find(letter) == std::string_view::npos)
      return unusable(first, "no satellite of RINEX");
    std::optional<NavigationRecord> record = read_head(letter);
    const bool kepler = letter != 'R' && letter != 'S';
    constexpr double kLongGlonass = 3.045;  // RINEX 3.05 adds a line to GLONASS
    const std::size_t lines = kepler ? 7 : letter == 'R' && version_ > kLongGlonass ? 4 : 3;
    NavigationRecord ignored;
    for (std::size_t i = 0; i < lines; ++i) {
      if (!next_line()) return unusable(first, "the file ends in the record");
      if (!line_.starts_with("   ")) {
        is_held_ = true;
        return unusable(first, "a line of the record is missing");
      }
      read_numbers(is_version_3_ ? 4 : 3, 3 + 4 * i, 4, record ? *record : ignored);
    }
    if (letter == 'S' || letter == 'J' || letter == 'I') return;
    if (!record) return unusable(first, "its satellite or date is impossible");
    if (kepler)
      take(kepler_of(*record), first);
    else
      take(glonass_of(*record), first);
  }

  std::optional<NavigationRecord> read_head(char letter) {
    const std::size_t at = is_version_3_ ? 4 : 3;
    const std::size_t year_width = is_version_3_ ? 4 : 2;
    const std::string name =
        is_version_3_ ? std::string(line_.substr(0, 3)) : letter + std::string(line_.substr(0, 2));
    const auto satellite = rinex_satellite(name, letter);
    const auto year = rinex_count(line_, at, year_width);
    const std::size_t month = at + year_width;
    const auto field = [&](std::size_t i) { return rinex_count(line_, month + 3 * i, 3).value_or(-1); };
    const auto second = rinex_number(line_, month + 12, is_version_3_ ? 3 : 5);
    if (!satellite || !year || !second) return std::nullopt;
    const auto stamp = stamp_of({*year, field(0), field(1), field(2), field(3), *second});
    if (!stamp) return std::nullopt;
    NavigationRecord record;
    record.satellite = *satellite;
    record.clock_time = *stamp;
    read_numbers(is_version_3_ ? 23 : 22, 0, 3, record);
    return record;
  }

  void read_numbers(std::size_t begin, std::size_t first, std::size_t count, NavigationRecord& record) {
    for (std::size_t i = 0; i < count; ++i)
      record.numbers.at(first + i) = rinex_number(line_, begin + kNumberWidth * i, kNumberWidth).value_or(0);
  }

  template <typename Orbit>
  void take(const std::optional<Orbit>& orbit, std::size_t line) {
    if (!orbit) return unusable(line, "its numbers are no orbit");
    ephemerides_.add(*orbit);
    ++used_;
  }

  void unusable(std::size_t line, const char* why) {
    ++unusable_;
    if (first_trouble_.empty()) first_trouble_ = fmt::format("line {}: {}", line, why);
  }

  const CompanionFile& file_;
  std::string_view rest_;
  std::string_view line_;
  satellites::Ephemerides& ephemerides_;
  std::size_t number_ = 0, used_ = 0, unusable_ = 0;
  std::string first_trouble_;
  bool is_version_3_ = false, is_glonass_ = false, is_held_ = false;
  double version_ = 0;
};

}  // namespace

void read_rinex_navigation(const CompanionFile& file, satellites::Ephemerides& ephemerides,
                           std::vector<std::string>& notes) {
  NavigationReader reader(file, ephemerides);
  reader.read();
  reader.add_notes(notes);
}

}  // namespace waymark::formats

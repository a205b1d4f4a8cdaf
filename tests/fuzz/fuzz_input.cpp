#include "fuzz_input.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/novatel/novatel_message.hpp>

namespace waymark_fuzz {
namespace {

using waymark::AccuracyMeaning;
using waymark::LogRequest;
using waymark::StreamKind;
using waymark::TimeScale;

constexpr std::size_t kHeader = 4;

bool is_can(std::string_view reader) {
  return reader == "candump" || reader == "asc" || reader == "trc";
}

bool is_ros(std::string_view reader) {
  return reader == "mcap" || reader == "rosbag";
}

std::vector<StreamKind> streams_of(std::string_view reader) {
  if (reader == "csv" || is_can(reader) || reader == "ubx" || is_ros(reader))
    return {StreamKind::odometry, StreamKind::gnss, StreamKind::truth, StreamKind::sensor};
  if (reader == "kitti_oxts") return {StreamKind::odometry, StreamKind::gnss, StreamKind::truth};
  if (reader == "rinex") return {StreamKind::sensor};
  return {StreamKind::gnss, StreamKind::truth};
}

/// Fletcher's sums over class to payload.
void repair_ubx(std::string& log) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(log[i]); };
  for (std::size_t i = log.find("\xB5\x62"); i != std::string::npos; i = log.find("\xB5\x62", i)) {
    if (i + 8 > log.size()) return;
    const std::size_t length = byte(i + 4) | static_cast<std::size_t>(byte(i + 5)) << 8U;
    if (length > log.size() - i - 8) {
      i += 2;
      continue;
    }
    std::uint8_t a = 0;
    std::uint8_t b = 0;
    for (std::size_t k = i + 2; k < i + 6 + length; ++k) {
      a = static_cast<std::uint8_t>(a + byte(k));
      b = static_cast<std::uint8_t>(b + a);
    }
    log[i + 6 + length] = static_cast<char>(a);
    log[i + 7 + length] = static_cast<char>(b);
    i += 8 + length;
  }
}

/// Every '*' of a line is followed by the right digits.
std::string repair_lines(const std::string& log, bool novatel) {
  std::string result;
  for (std::string_view rest = log; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t star = line.rfind('*');
    if (line.empty() || star == std::string_view::npos || star == 0) {
      result += line;
    } else {
      const std::string_view covered = line.substr(1, star - 1);
      result += line.substr(0, star + 1);
      if (novatel) {
        result += fmt::format("{:08x}", waymark::formats::novatel_checksum(covered));
      } else {
        unsigned sum = 0;
        for (const char c : covered) sum ^= static_cast<unsigned char>(c);
        result += fmt::format("{:02X}", sum);
      }
    }
    result += '\n';
  }
  return result;
}

void set_csv_columns(LogRequest& request, unsigned variant) {
  if (variant == 0) return;
  const bool other_units = variant % 2 == 0;
  request.columns["time"] = {"1", other_units ? "iso8601" : "ms", ""};
  if (request.stream == StreamKind::odometry) {
    request.columns["speed"] = {"2", other_units ? "km/h" : "", ""};
    request.columns["yaw_rate"] = {"3", other_units ? "deg/s" : "", other_units ? "cw" : ""};
  } else if (request.stream == StreamKind::sensor) {
    request.columns["range"] = {"2", other_units ? "mm" : "", ""};
  } else {
    request.columns["latitude"] = {"2", other_units ? "1e-7deg" : "", ""};
    request.columns["longitude"] = {"3", other_units ? "1e-7deg" : "", ""};
    request.columns["height"] = {"4", other_units ? "mm" : "", ""};
  }
  if (request.stream != StreamKind::gnss) return;
  if (variant < 3) {
    request.columns["accuracy"] = {"5", other_units ? "mm" : "", ""};
  } else if (variant < 5) {
    request.columns["sigma_east"] = {"5", "", ""};
    request.columns["sigma_north"] = {"6", "", ""};
    request.columns["covariance_en_signed_root"] = {"7", "", ""};
  } else {
    request.columns["accuracy_east"] = {"5", "", ""};
    request.columns["accuracy_north"] = {"6", "", ""};
    request.columns["course"] = {"7", "", other_units ? "ccw_from_east" : ""};
    request.columns["course_accuracy"] = {"7", "", ""};
    request.columns["speed"] = {"8", "", ""};
    request.columns["speed_accuracy"] = {"8", "", ""};
    request.columns["gnss_time"] = {"1", "", ""};
    request.columns["valid"] = {"9", "", ""};
  }
}

/// Times, angles and places as people write them.
void set_csv_dialect(LogRequest& request, unsigned choice) {
  constexpr std::array kTimes{"", "ms", "dmy", "mdy", "hms", "excel", "filetime", "matlab"};
  constexpr std::array kDays{"", "iso8601", "dmy", "gps_week"};
  if (choice == 0) return;
  if (request.columns.contains("time")) request.columns["time"].unit = kTimes[choice & 7U];
  if (choice & 24U) request.columns["date"] = {"2", kDays[choice >> 3U & 3U], ""};
  if (request.stream != StreamKind::gnss && request.stream != StreamKind::truth) return;
  const char* const angle = std::array{"deg", "ddmm", "dms", "min"}[choice >> 5U & 3U];
  if (request.columns.contains("latitude")) {
    request.columns["latitude"].unit = angle;
    request.columns["longitude"].unit = angle;
  }
  if (choice & 128U) request.where = waymark::RowFilter{"4", "front", true};
}

/// Takes the first bytes of a log off, up to a zero: they are a file that belongs to it.
std::string take_companion(std::string& log) {
  const std::size_t end = std::min(log.find('\0'), log.size());
  std::string companion = log.substr(0, end);
  log.erase(0, std::min(end + 1, log.size()));
  return companion;
}

/// One stamp for each record, one too few, or the first bytes of the log itself.
std::string kitti_stamps(std::string& log, unsigned variant, unsigned between) {
  if (variant == 7) return take_companion(log);
  auto lines = static_cast<std::size_t>(std::count(log.begin(), log.end(), '\n'));
  if (!log.empty() && log.back() != '\n') ++lines;
  if (variant == 6 && lines > 0) --lines;
  std::string stamps;
  for (std::size_t i = 0; i < lines; ++i) {
    const std::size_t ms = i * between;
    stamps += fmt::format("2011-09-26 {:02}:{:02}:{:02}.{:03}000000\n", ms / 3'600'000 % 24, ms / 60'000 % 60,
                          ms / 1000 % 60, ms % 1000);
  }
  return stamps;
}

/// Ephemerides of GPS, Galileo and BeiDou, 32 of each, and two of GLONASS, at 2016-06-06 11:00.
const std::string& fuzz_navigation() {
  static const std::string text = [] {
    std::string made =
        fmt::format("{:60}RINEX VERSION / TYPE\n", "     3.03           N: GNSS NAV DATA    M");
    made += fmt::format("GPSA {:12.4E}{:12.4E}{:12.4E}{:12.4E}{:7}IONOSPHERIC CORR\n", 7e-9, 2e-8, -6e-8,
                        -1e-7, "");
    made +=
        fmt::format("GPSB {:12.4E}{:12.4E}{:12.4E}{:12.4E}{:7}IONOSPHERIC CORR\n", 9e4, 1e5, -7e4, -5e5, "");
    made += fmt::format("{:60}END OF HEADER\n", "");
    const auto line = [&](std::array<double, 4> values) {
      made += "    ";
      for (const double value : values) made += fmt::format("{:19.12E}", value);
      made += '\n';
    };
    const auto head = [&](char system, int number) {
      made += fmt::format("{}{:02} 2016 06 06 11 00 00{:19.12E}{:19.12E}{:19.12E}\n", system, number, 1e-5,
                          1e-12, 0.0);
    };
    constexpr double kToe_s = 86'400 + 11 * 3600;
    for (const char system : {'G', 'E', 'C'}) {
      for (int number = 1; number <= 32; ++number) {
        head(system, number);
        line({1, 10, 4e-9, 0.4 * number});
        line({1e-7, 0.005, 1e-5, 5153.7});
        line({kToe_s, 1e-7, 1.0 * (number % 6), 1e-7});
        line({0.96, 170, 0.5, -8e-9});
        line({6e-10, 1, 1900, 0});
        line({2, 0, 5e-9, 0});
        line({0, 0, 0, 0});
      }
    }
    for (const int number : {1, 2}) {
      head('R', number);
      line({1e7, 2, 0, 0});
      line({number == 1 ? 2e7 : -2e7, 1, 0, 5});
      line({1.2e7, -2.5, 0, 0});
    }
    return made;
  }();
  return text;
}

/// Raw measurements of RINEX or UBX. The ephemerides of RINEX are those of fuzz_navigation() or stand before the log; UBX
/// has its own or those.
void set_raw_readings(FuzzInput& input, bool is_rinex, unsigned variant) {
  input.request.readings.clear();
  for (const char* name : {"system", "satellite", "pseudorange", "range_rate", "satellite_x", "satellite_vz",
                           "elevation", "cn0"})
    input.request.readings.push_back({name, "", "", false, ""});
  if (!is_rinex && variant == 2) return;
  const bool before = is_rinex && variant >= 4;
  input.request.companions["navigation"] = {
      {"fuzz.nav", before ? take_companion(input.log) : fuzz_navigation()}};
}

void set_readings(LogRequest& request, std::string_view reader, unsigned variant) {
  if (request.stream == StreamKind::sensor) {
    if (reader == "csv") {
      request.readings = {{"range", "m", "", true, ""}, {"bearing", "rad", "ccw", false, ""}};
    } else {
      request.readings = waymark::formats::odometry_channels();
    }
  } else if (request.stream == StreamKind::odometry &&
             ((reader != "csv" && !is_ros(reader)) || variant == 7)) {
    if (reader != "kitti_oxts") request.readings = waymark::formats::odometry_channels();
  } else if (request.stream == StreamKind::gnss && variant == 7 && (reader == "csv" || is_can(reader))) {
    request.readings = waymark::formats::velocity_channels();
  }
}

}  // namespace

const std::string& fuzz_dbc() {
  static const std::string text =
      "BO_ 170 WHEELS: 4 ECU\n"
      " SG_ FL : 7|16@0+ (0.01,0) [0|0] \"kph\" X\n"
      " SG_ FR : 23|16@0+ (0.01,0) [0|0] \"kph\" X\n"
      "BO_ 36 MOTION: 2 ECU\n"
      " SG_ YAW_RATE : 0|16@1- (0.1,0) [0|0] \"deg/s\" X\n"
      "BO_ 180 SPEED_MUX: 8 ECU\n"
      " SG_ PAGE M : 0|4@1+ (1,0) [0|0] \"\" X\n"
      " SG_ SPEED m1 : 8|32@1- (1,0) [0|0] \"m/s\" X\n"
      "BO_ 3 POSITION: 8 R\n"
      " SG_ Latitude : 0|28@1+ (1e-06,-90) [0|0] \"deg\" X\n"
      " SG_ Longitude : 28|29@1+ (1e-06,-180) [0|0] \"deg\" X\n"
      " SG_ Accuracy : 57|6@1+ (1,0) [0|0] \"m\" X\n"
      " SG_ Valid : 63|1@1+ (1,0) [0|0] \"\" X\n"
      "BO_ 7 VELOCITY: 4 R\n"
      " SG_ Speed : 0|16@1+ (0.01,0) [0|0] \"m/s\" X\n"
      " SG_ Heading : 16|16@1+ (0.1,0) [0|0] \"deg\" X\n"
      "BO_ 2 TIME: 5 R\n"
      " SG_ Epoch : 0|40@1+ (0.001,1577840400) [0|0] \"sec\" X\n"
      "SIG_VALTYPE_ 180 SPEED : 1;\n";
  return text;
}

void set_can_columns(LogRequest& request, unsigned variant) {
  auto& columns = request.columns;
  if (request.stream == StreamKind::odometry || request.stream == StreamKind::sensor) {
    columns["wheel_speed_rear_left"] = {"FL", "km/h", ""};
    columns["yaw_rate"] = {"MOTION.YAW_RATE", "deg/s", variant % 2 == 0 ? "ccw" : "cw"};
    if (variant > 1) columns["speed"] = {"SPEED_MUX.SPEED", "", ""};
    return;
  }
  columns["latitude"] = {"Latitude", "", ""};
  columns["longitude"] = {"Longitude", "", ""};
  if (request.stream == StreamKind::truth) {
    columns["heading"] = {"VELOCITY.Heading", "deg", "cw_from_north"};
    return;
  }
  columns["valid"] = {"Valid", "", ""};
  if (variant != 7) columns["accuracy"] = {"Accuracy", "", ""};
  if (variant > 1) columns["course"] = {"VELOCITY.Heading", "deg", ""};
  if (variant > 2) columns["gnss_time"] = {"TIME.Epoch", "s", ""};
}

FuzzInput fuzz_input(std::string_view reader, const std::uint8_t* bytes, std::size_t size) {
  std::array<unsigned, kHeader> head{};
  const std::size_t given = std::min(size, kHeader);
  std::copy_n(bytes, given, head.begin());

  FuzzInput input;
  input.log.assign(reinterpret_cast<const char*>(bytes) + given, size - given);
  LogRequest& request = input.request;
  const std::vector<StreamKind> streams = streams_of(reader);
  request.stream = streams[(head[0] & 3U) % streams.size()];
  input.piece = std::array<std::size_t, 4>{1, 7, 64, 0}[head[0] >> 2U & 3U];
  const bool repair = (head[0] & 16U) != 0;
  const unsigned variant = head[0] >> 5U;

  request.accuracy =
      std::array{AccuracyMeaning::automatic, AccuracyMeaning::percent95, AccuracyMeaning::one_sigma,
                 AccuracyMeaning::drms, AccuracyMeaning::cep50}[(head[1] & 7U) % 5];
  if ((head[1] & 8U) != 0) request.default_sigma_m = 5;
  if ((head[1] & 16U) != 0) request.range_error_m = 4;
  request.time_scale = std::array{TimeScale::gps, TimeScale::utc, TimeScale::unix_time}[(head[1] >> 5U) % 3];
  request.gps_week = std::array{0, 1, 2200, 10'000}[head[2] & 3U];
  if ((head[2] & 4U) != 0) request.date = waymark::Stamp::from_seconds(1.3e9 - 1.3e9 / 86400 + 15046.0);
  request.time_offset_s = std::array{0.0, 0.25, -7.5, 1e9}[head[2] >> 3U & 3U];
  request.separator = std::array{'\0', ',', ';', ' ', '\t', '\0', '\0', '\0'}[head[2] >> 5U];

  if (repair && reader == "ubx") repair_ubx(input.log);
  if (repair && (reader == "nmea" || reader == "novatel"))
    input.log = repair_lines(input.log, reader == "novatel");
  if (reader == "kitti_oxts")
    request.companions["timestamps"] = {{"timestamps.txt", kitti_stamps(input.log, variant, head[3])}};
  if (reader != "rinex") set_readings(request, reader, variant);
  const bool is_raw_ubx =
      reader == "ubx" && request.stream == StreamKind::sensor && (variant == 2 || variant == 3);
  if (reader == "rinex" || is_raw_ubx) set_raw_readings(input, reader == "rinex", variant);
  if (reader == "csv" && request.readings.empty()) set_csv_columns(request, variant);
  if (reader == "csv") set_csv_dialect(request, head[3]);
  if (is_can(reader)) {
    request.companions["dbc"] = {{"fuzz.dbc", fuzz_dbc()}};
    if (variant != 7 || request.stream != StreamKind::gnss)
      set_can_columns(request, variant);
    else
      request.columns["speed"] = {"VELOCITY.Speed", "", ""};
  }
  if (reader == "ubx" && variant == 1 && request.readings.empty())
    request.columns["position"] = {"HNR-PVT", "", ""};
  if (is_ros(reader) && variant == 1) request.columns["topic"] = {"/fix", "", ""};
  return input;
}

}  // namespace waymark_fuzz

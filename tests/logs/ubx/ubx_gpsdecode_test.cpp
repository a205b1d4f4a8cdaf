/// UBX logs of real receivers against gpsd's decoder (program gpsdecode of the Debian package gpsd-clients).
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/formats/logs/detail/ubx/ubx.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/gpsd/gpsdecode.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace ubx_gpsdecode_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Report {
  Stamp utc;
  double latitude_deg, longitude_deg, speed_mps, course_deg, hacc_m, sacc_mps;
};

double member(const nlohmann::json& object, const char* key) {
  return object.contains(key) ? object.at(key).get<double>() : std::nan("");
}

/// The TPV objects with a position and a time.
std::vector<Report> reports_of(const std::vector<nlohmann::json>& objects) {
  std::vector<Report> reports;
  for (const nlohmann::json& tpv : objects) {
    if (tpv.at("class") != "TPV" || !tpv.contains("lat") || !tpv.contains("time")) continue;
    reports.push_back({stamp_from_iso8601(tpv.at("time").get<std::string>()).value(), member(tpv, "lat"),
                       member(tpv, "lon"), member(tpv, "speed"), member(tpv, "track"), member(tpv, "eph"),
                       member(tpv, "eps")});
  }
  return reports;
}

std::string log_path(const std::string& folder, const std::string& name) {
  return (waymark_test::shared_data_dir() / "logs" / folder / name).string();
}

LogData read_fixes(const std::string& name, const std::string& position = "NAV-PVT") {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.columns["position"] = {position, "", ""};
  return UbxReader().read(read_text_file(log_path("ubx", name)), name, request);
}

/// By the formulas of the ellipsoid WGS84.
Eigen::Vector3d ecef_of(const GeodeticFix& fix) {
  constexpr double kRadius = 6'378'137;
  constexpr double kFlattening = 1 / 298.257223563;
  constexpr double kSquare = kFlattening * (2 - kFlattening);
  const double latitude = fix.latitude_deg * kDegree;
  const double longitude = fix.longitude_deg * kDegree;
  const double across = kRadius / std::sqrt(1 - kSquare * std::pow(std::sin(latitude), 2));
  return {(across + fix.height_m) * std::cos(latitude) * std::cos(longitude),
          (across + fix.height_m) * std::cos(latitude) * std::sin(longitude),
          (across * (1 - kSquare) + fix.height_m) * std::sin(latitude)};
}

/// gpsd's objects of a class at a time, or an epoch before or after it: it gives what it has when the next
/// message comes.
std::vector<nlohmann::json> at_time(const std::vector<nlohmann::json>& objects, const char* kind,
                                    Stamp stamp) {
  std::vector<nlohmann::json> result;
  for (const nlohmann::json& object : objects) {
    if (object.at("class") != kind || !object.contains("time")) continue;
    const Stamp time = stamp_from_iso8601(object.at("time").get<std::string>()).value();
    if (std::abs(seconds_between(time, stamp)) < 1.0011) result.push_back(object);
  }
  return result;
}

/// Reads a log after its frames NAV-PVT were taken out.
LogData read_without_pvt(const std::string& name) {
  std::string bytes = read_text_file(log_path("ubx", name));
  constexpr std::string_view kPvt = "\xB5\x62\x01\x07";
  for (std::size_t at = bytes.find(kPvt); at != std::string::npos; at = bytes.find(kPvt, at)) {
    const auto length =
        static_cast<unsigned char>(bytes[at + 4]) + 256U * static_cast<unsigned char>(bytes[at + 5]);
    bytes.erase(at, length + 8);
  }
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 5;
  return UbxReader().read(bytes, name, request);
}

/// Largest differences over the epochs that both have.
struct Differences {
  std::size_t epochs = 0;
  std::size_t without_report = 0;
  double position_m = 0, time_s = 0, speed_mps = 0, course_deg = 0, hacc_m = 0, sacc_mps = 0;
};

double metres_between(const GeodeticFix& fix, const Report& report) {
  const double north = (fix.latitude_deg - report.latitude_deg) * 111'320;
  const double east =
      (fix.longitude_deg - report.longitude_deg) * 111'320 * std::cos(fix.latitude_deg * kDegree);
  return std::hypot(north, east);
}

void widen(double& largest, double difference) {
  if (!std::isnan(difference)) largest = std::max(largest, std::abs(difference));
}

/// gpsd reports an epoch up to four times, as its messages come, partly with the next epoch's time and the
/// last one's position: of the reports of a time, the first of those with the nearest position is compared.
/// Its `eps` is sAcc in the first report and its own estimate in later ones: the nearest is taken.
Differences compare(const std::vector<GeodeticFix>& fixes, const std::vector<Report>& reports) {
  Differences largest;
  for (const GeodeticFix& fix : fixes) {
    const Report* best = nullptr;
    double speed_accuracy = std::numeric_limits<double>::quiet_NaN();
    for (const Report& report : reports) {
      if (std::abs(seconds_between(report.utc, fix.stamp)) > 0.0011) continue;
      if (best == nullptr || metres_between(fix, report) < metres_between(fix, *best)) best = &report;
      speed_accuracy = std::fmin(speed_accuracy, std::abs(*fix.speed_sigma_mps - report.sacc_mps));
    }
    if (best == nullptr) {
      ++largest.without_report;
      continue;
    }
    ++largest.epochs;
    widen(largest.position_m, metres_between(fix, *best));
    widen(largest.time_s, seconds_between(best->utc, fix.stamp));
    widen(largest.speed_mps, *fix.speed_mps - best->speed_mps);
    widen(largest.course_deg, std::remainder(*fix.course_rad / kDegree - best->course_deg, 360));
    widen(largest.hacc_m, std::sqrt(2 * fix.covariance_en(0, 0)) - best->hacc_m);
    widen(largest.sacc_mps, speed_accuracy);
  }
  return largest;
}

/// gpsd prints milliseconds, 1e-4 degree, 0.01 m/s; half a unit of the last digit is no difference.
void check_agreement(const Differences& largest, double position_m, double hacc_m) {
  CHECK(largest.without_report == 0);
  CHECK(largest.position_m <= position_m);
  CHECK(largest.time_s < 5.01e-4);
  CHECK(largest.speed_mps < 1e-9);
  CHECK(largest.course_deg < 5.01e-5);
  CHECK(largest.hacc_m <= hacc_m);
  CHECK(largest.sacc_mps < 5.01e-3);
}

}  // namespace

TEST_CASE("ubx: real logs of NAV-PVT agree with gpsdecode") {
  struct Case {
    const char* name;
    std::size_t fixes, without_fix, corrupt;
  };
  // gpsd reports positions without gnssFixOK too (283 of ublox-glo), which are no fixes here.
  for (const Case& log :
       {Case{"gpsd_navisys-gr8013.log", 35, 0, 0}, Case{"gpsd_ublox-glo.log", 16, 283, 0},
        Case{"gpsd_ublox-neo-m8l.log", 19, 0, 0}, Case{"gpsd_ublox-neo-m8u-hnr.log", 1, 0, 0},
        Case{"pyubx2_pygpsdata-MIXED.log", 39, 0, 0}, Case{"swiftnav_nav_pvt.ubx", 1, 0, 0},
        Case{"swiftnav_nav_pvt_corrupted.ubx", 1, 0, 2}, Case{"swiftnav_nav_pvt_fix_type.ubx", 13, 3, 0}}) {
    const auto objects = waymark_test::run_gpsdecode(log_path("ubx", log.name));
    if (!objects) return;
    INFO(log.name);
    const LogData data = read_fixes(log.name);
    CHECK(data.fixes.size() == log.fixes);
    CHECK(data.without_fix == log.without_fix);
    CHECK(data.corrupt == log.corrupt);
    check_agreement(compare(data.fixes, reports_of(*objects)), 1e-6, 1e-9);
  }
}

TEST_CASE("ubx: a real log of NAV-HPPOSLLH agrees with gpsdecode") {
  const std::string name = "gpsd_ublox-zed-f9p-hp.log";
  const auto objects = waymark_test::run_gpsdecode(log_path("ubx", name));
  if (!objects) return;
  const LogData data = read_fixes(name);
  CHECK(data.fixes.size() == 29);
  const std::vector<Report> reports = reports_of(*objects);
  // If gpsd reports an epoch only once, it is with NAV-PVT's position and hAcc, rounded to 1e-7 degree and
  // to 1 mm: 5.6 mm north, 3.9 mm east at most, and 0.5 mm.
  check_agreement(compare(data.fixes, reports), 0.0068, 0.00051);
  std::vector<GeodeticFix> precise;
  for (const GeodeticFix& fix : data.fixes) {
    const bool reported = std::any_of(reports.begin(), reports.end(), [&](const Report& report) {
      return metres_between(fix, report) < 1e-4;  // gpsd prints 1e-9 degree
    });
    if (reported) precise.push_back(fix);
  }
  CHECK(precise.size() >= 14);
  CHECK(compare(precise, reports).position_m < 1e-6);
}

TEST_CASE("ubx: real HNR-PVT agrees with what gpsd 3.25 made of it") {
  const std::string name = "gpsd_ublox-neo-m8l.log";
  const auto reference = waymark_test::shared_data("logs/gpsd/" + name + ".chk");
  if (!reference) return;
  const LogData data = read_fixes(name, "HNR-PVT");
  CHECK(data.fixes.size() == 189);
  check_agreement(compare(data.fixes, reports_of(waymark_test::gpsd_objects(read_text_file(*reference)))),
                  1e-6, 1e-9);
}

TEST_CASE("ubx: Earth-centred positions, qualities and HDOP of real logs agree with gpsdecode") {
  struct Case {
    const char* name;
    std::size_t fixes;      ///< of NAV-POSECEF
    std::size_t qualities;  ///< whose status gpsd tells
  };
  for (const Case& log : {Case{"gpsd_navisys-gr8013.log", 34, 35}, Case{"gpsd_ublox-neo-m8l.log", 19, 19}}) {
    const auto objects = waymark_test::run_gpsdecode(log_path("ubx", log.name));
    if (!objects) return;
    INFO(log.name);
    // NAV-POSECEF counts where the log has no NAV-PVT, which tells the quality.
    const LogData earth_centred = read_without_pvt(log.name);
    CHECK(earth_centred.fixes.size() == log.fixes);
    std::size_t positions = 0;
    for (const GeodeticFix& fix : earth_centred.fixes) {
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const nlohmann::json& tpv : at_time(*objects, "TPV", fix.stamp))
        if (tpv.contains("ecefx"))
          nearest_m = std::min(nearest_m, (ecef_of(fix) - Eigen::Vector3d(tpv.at("ecefx").get<double>(),
                                                                          tpv.at("ecefy").get<double>(),
                                                                          tpv.at("ecefz").get<double>()))
                                              .norm());
      positions += nearest_m < 0.002;  // gpsd repeats the receiver's centimetres
    }
    CHECK(positions >= log.fixes - 1);  // gpsd reports the last epoch without them
    const LogData data = read_fixes(log.name);
    std::size_t qualities = 0;
    std::size_t dilutions = 0;
    for (const GeodeticFix& fix : data.fixes) {
      for (const nlohmann::json& sky : at_time(*objects, "SKY", fix.stamp))
        dilutions += sky.contains("hdop") && std::abs(sky.at("hdop").get<double>() - fix.told.hdop) < 1e-9;
      const std::vector<nlohmann::json> reports = at_time(*objects, "TPV", fix.stamp);
      qualities += std::any_of(reports.begin(), reports.end(), [&](const nlohmann::json& tpv) {
        return tpv.contains("status") &&
               waymark_test::is_status(fix.told.quality, tpv.at("status").get<int>());
      });
    }
    CHECK(qualities == log.qualities);
    CHECK(dilutions >= log.qualities - 3);
  }
}

}  // namespace ubx_gpsdecode_test

#include "logs/gpsd/gpsdecode.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <sstream>

#include <waymark/formats/text/iso8601.hpp>

#include "support/skip.hpp"

namespace waymark_test {
namespace {

using nlohmann::json;

constexpr std::int64_t kRollover = 1024LL * 7 * 86'400 * 1'000'000'000;
constexpr std::int64_t kMillisecond = 1'000'000;

double number(const json& object, const char* key) {
  return object.contains(key) ? object.at(key).get<double>() : std::nan("");
}

/// The larger of the two; a difference that is not defined changes nothing.
void enlarge(double& largest, double difference) {
  if (std::abs(difference) > largest) largest = std::abs(difference);
}

std::int64_t within_rollover(std::int64_t nanoseconds) {
  return ((nanoseconds % kRollover) + kRollover) % kRollover;
}

double metres_between(const waymark::GeodeticFix& fix, const json& report) {
  constexpr double kDegree = 6'378'137 * std::numbers::pi / 180;
  const double north = (number(report, "lat") - fix.latitude_deg) * kDegree;
  const double east = std::remainder(number(report, "lon") - fix.longitude_deg, 360) * kDegree *
                      std::cos(fix.latitude_deg * std::numbers::pi / 180);
  return std::hypot(north, east);
}

/// A report, and the SKY objects before and behind it.
struct Sighting {
  json report;
  double hdop_before, hdop_behind;
};

/// The TPV objects with a fix by their time. gpsd gives SKY objects of NMEA no time.
std::multimap<std::int64_t, Sighting> sightings(const std::vector<json>& objects) {
  std::multimap<std::int64_t, Sighting> result;
  std::vector<Sighting*> waiting;
  double last = std::nan("");
  for (const json& object : objects) {
    if (object.at("class") == "SKY" && object.contains("hdop")) {
      last = object.at("hdop").get<double>();
      for (Sighting* sighting : waiting) sighting->hdop_behind = last;
      waiting.clear();
    }
    const bool fix = object.at("class") == "TPV" && object.contains("time") && object.value("mode", 0) >= 2 &&
                     object.contains("lat");
    if (!fix) continue;
    const std::int64_t time = within_rollover(
        waymark::formats::stamp_from_iso8601(object.at("time").get<std::string>()).value().nanoseconds);
    waiting.push_back(&result.emplace(time, Sighting{object, last, std::nan("")})->second);
  }
  return result;
}

void compare_details(const waymark::FixDetails& told, const Sighting& sighting, Comparison& result) {
  if (sighting.report.contains("status")) {
    ++result.qualities;
    result.other_qualities += !is_status(told.quality, sighting.report.at("status").get<int>());
  }
  if (sighting.report.contains("dgpsAge") && !std::isnan(told.correction_age_s)) {
    ++result.ages;
    enlarge(result.age_s, number(sighting.report, "dgpsAge") - told.correction_age_s);
  }
  if (told.hdop == 0 || (std::isnan(sighting.hdop_before) && std::isnan(sighting.hdop_behind))) return;
  constexpr double kRounded = 0.00501;
  const bool same = std::abs(told.hdop - sighting.hdop_before) < kRounded ||
                    std::abs(told.hdop - sighting.hdop_behind) < kRounded;
  ++(same ? result.same_hdop : result.other_hdop);
}

void compare_one(const waymark::GeodeticFix& fix, const Sighting& sighting, Comparison& result) {
  const json& report = sighting.report;
  ++result.matched;
  compare_details(fix.told, sighting, result);
  const std::int64_t theirs =
      waymark::formats::stamp_from_iso8601(report.at("time").get<std::string>()).value().nanoseconds;
  if (std::abs(theirs - fix.stamp.nanoseconds) > kRollover / 2) ++result.other_dates;
  const std::int64_t apart = within_rollover(theirs - fix.stamp.nanoseconds + kRollover / 2) - kRollover / 2;
  enlarge(result.time_s, 1e-9 * static_cast<double>(apart));
  enlarge(result.position_m, metres_between(fix, report));
  enlarge(result.height_m, number(report, "altHAE") - fix.height_m);
  if (fix.speed_mps) enlarge(result.speed_mps, number(report, "speed") - *fix.speed_mps);
  if (fix.course_rad)
    enlarge(result.course_deg,
            std::remainder(number(report, "track") - *fix.course_rad * 180 / std::numbers::pi, 360));
}

}  // namespace

bool is_status(waymark::FixQuality quality, int status) {
  using waymark::FixQuality;
  switch (status) {
    case 2:
      return quality == FixQuality::differential;
    case 3:
      return quality == FixQuality::fixed;
    case 4:
      return quality == FixQuality::floating;
    case 5:
    case 6:
      return quality == FixQuality::dead_reckoned;
    case 7:
      return quality == FixQuality::manual;
    case 8:
      return quality == FixQuality::simulated;
    default:
      return quality == FixQuality::single;
  }
}

std::vector<json> gpsd_objects(const std::string& text) {
  std::vector<json> objects;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('{')) objects.push_back(json::parse(line));
  }
  return objects;
}

std::optional<std::vector<json>> run_gpsdecode(const std::filesystem::path& log) {
  if (!std::filesystem::exists(log)) {
    skip(log.string() + " is absent");
    return std::nullopt;
  }
  if (std::system("command -v gpsdecode > /dev/null") != 0) {
    skip("gpsdecode is absent (Debian package gpsd-clients)");
    return std::nullopt;
  }
  std::FILE* pipe = ::popen(("gpsdecode -j < '" + log.string() + "' 2> /dev/null").c_str(), "r");
  if (pipe == nullptr) {
    skip("gpsdecode cannot be run");
    return std::nullopt;
  }
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    text.append(buffer.data(), count);
  ::pclose(pipe);
  return gpsd_objects(text);
}

Comparison compare_with_gpsd(const std::vector<waymark::GeodeticFix>& fixes,
                             const std::vector<json>& objects) {
  Comparison result;
  result.ours = fixes.size();
  // A receiver's clock may step back, so that a time comes twice.
  const std::multimap<std::int64_t, Sighting> reports = sightings(objects);
  std::multimap<std::int64_t, json> accuracies;  // GST objects
  for (const json& object : objects) {
    if (!object.contains("time")) continue;
    const std::int64_t time = within_rollover(
        waymark::formats::stamp_from_iso8601(object.at("time").get<std::string>()).value().nanoseconds);
    if (object.at("class") == "GST") accuracies.emplace(time, object);
  }
  result.theirs = reports.size();
  for (const waymark::GeodeticFix& fix : fixes) {
    const std::int64_t time = within_rollover(fix.stamp.nanoseconds);
    const Sighting* nearest = nullptr;
    const auto end = reports.upper_bound(time + kMillisecond);
    for (auto report = reports.lower_bound(time - kMillisecond); report != end; ++report) {
      if (nearest == nullptr ||
          metres_between(fix, report->second.report) < metres_between(fix, nearest->report))
        nearest = &report->second;
    }
    if (nearest != nullptr) compare_one(fix, *nearest, result);
    const auto gst = accuracies.lower_bound(time - kMillisecond);
    if (gst == accuracies.end() || gst->first > time + kMillisecond || !gst->second.contains("lat")) continue;
    ++result.accuracies;
    enlarge(result.accuracy_m, number(gst->second, "lon") - std::sqrt(fix.covariance_en(0, 0)));
    enlarge(result.accuracy_m, number(gst->second, "lat") - std::sqrt(fix.covariance_en(1, 1)));
  }
  return result;
}

}  // namespace waymark_test

#include <waymark/tools/drive/description/frame_entries.hpp>

#include <cmath>
#include <cstdlib>
#include <string>

namespace waymark::drive {
namespace {

constexpr NumberRule kHeight{-1e4, 1e5, "metres above the ellipsoid"};

/// Reads 32, "32N" or "32S"; a plain number is north.
int read_zone(const YamlSection& frame) {
  std::string text;
  frame.read("utm_zone", text);
  bool north = true;
  if (!text.empty() && (text.back() == 'N' || text.back() == 'S')) {
    north = text.back() == 'N';
    text.pop_back();
  }
  int zone = 0;
  for (const char c : text) {
    const bool good = c >= '0' && c <= '9' && zone < 100;
    zone = good ? 10 * zone + (c - '0') : 100;
  }
  if (zone < 1 || zone > 60) frame.fail_value("utm_zone", "a zone such as 32N or 56S");
  return north ? zone : -zone;
}

}  // namespace

ZoneAndOrigin read_zone_and_origin(const YamlSection& frame) {
  ZoneAndOrigin stated;
  if (frame.has("utm_zone")) stated.zone = read_zone(frame);
  if (!frame.has("origin")) return stated;
  if (!stated.zone)
    frame.fail("origin", "needs a stated utm_zone, because it is in coordinates of that zone");
  Eigen::Vector2d origin;
  frame.read("origin", origin);
  stated.origin = origin;
  return stated;
}

std::optional<Frame> frame_of(const ZoneAndOrigin& stated) {
  if (!stated.zone) return std::nullopt;
  const Eigen::Vector2d origin = stated.origin.value_or(Eigen::Vector2d::Zero());
  return Frame{std::abs(*stated.zone), *stated.zone > 0, origin.x(), origin.y()};
}

void read_log_frame(const YamlSection& log, LogRequest& request) {
  const auto frame = log.section("frame", {"utm_zone", "origin", "enu_origin", "enu_height"});
  if (!frame) return;
  if (!frame->has("enu_origin")) {
    if (frame->has("enu_height")) frame->fail("enu_height", "belongs to enu_origin");
    request.metric_frame = frame_of(read_zone_and_origin(*frame));
    return;
  }
  if (frame->has("utm_zone")) frame->fail("utm_zone", "give either utm_zone or enu_origin");
  Eigen::Vector2d place;
  frame->read("enu_origin", place);
  if (!(std::abs(place.x()) <= 90 && std::abs(place.y()) <= 360))
    frame->fail_value("enu_origin", "latitude and longitude in degrees, [48.1, 11.5]");
  LocalOrigin origin{place.x(), place.y(), 0};
  frame->read("enu_height", origin.height_m, kHeight);
  request.local_origin = origin;
}

}  // namespace waymark::drive

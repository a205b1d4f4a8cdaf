#include <waymark/formats/logs/detail/ubx/ubx.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_fixes.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_raw.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_sensors.hpp>

namespace waymark::formats {
namespace {

/// Tells whether the request asks for HNR-PVT.
bool wants_high_rate(const std::string& path, const LogRequest& request) {
  for (const auto& [quantity, column] : request.columns) {
    if (quantity != "position")
      throw InputError(
          fmt::format("{}: a UBX log has no column for '{}'; only 'position' may be stated, as "
                      "'NAV-PVT' (all navigation messages) or 'HNR-PVT'",
                      path, quantity));
    if (column.column == "HNR-PVT") return true;
    if (column.column != "NAV-PVT")
      throw InputError(
          fmt::format("{}: 'position' of a UBX log is 'NAV-PVT' (all navigation messages) or "
                      "'HNR-PVT', got '{}'",
                      path, column.column));
  }
  return false;
}

std::string channel_names() {
  std::string names;
  for (const UbxChannel& channel : kUbxChannels) {
    if (!names.empty()) names += ", ";
    names += channel.name;
  }
  return names;
}

void check_readings(const std::string& path, const LogRequest& request) {
  require_no_columns(path, request, "a UBX log of readings");
  bool any = false;
  for (const SensorColumn& wanted : request.readings) {
    const bool has = std::any_of(kUbxChannels.begin(), kUbxChannels.end(),
                                 [&](const UbxChannel& channel) { return wanted.name == channel.name; });
    if (!has && wanted.required)
      throw InputError(fmt::format("{}: a UBX log holds no '{}'; its ESF-MEAS messages may hold {}", path,
                                   wanted.name, channel_names()));
    any = any || has;
  }
  if (!any)
    throw InputError(
        fmt::format("{}: a UBX log holds none of the readings asked for; its ESF-MEAS messages "
                    "may hold {}",
                    path, channel_names()));
}

/// Tells whether the request is that of the plugin gnss_raw.
bool wants_raw(const LogRequest& request) {
  return request.stream == StreamKind::sensor &&
         std::any_of(request.readings.begin(), request.readings.end(),
                     [](const SensorColumn& column) { return column.name == "pseudorange"; });
}

bool holds_place(std::uint16_t key) {
  return key == ubx::kNavPvt || key == ubx::kNavPosllh || key == ubx::kNavHpposllh ||
         key == ubx::kNavPosecef || key == ubx::kNavSol || key == ubx::kHnrPvt || key == ubx::kRxmRawx;
}

}  // namespace

std::unique_ptr<LogDecoder> UbxReader::open(const std::string& path, const LogRequest& request) const {
  if (wants_raw(request)) {
    require_no_columns(path, request, "a UBX log of raw measurements");
    require_companions(path, request, "a UBX log of raw measurements", "navigation");
    return std::make_unique<UbxRawDecoder>(path, request);
  }
  require_companions(path, request, "a UBX log");
  if (request.gps_week < 0 || request.gps_week > kLastGpsWeek)
    throw InputError(fmt::format("{}: week {} is outside 0 .. {} (time: {{week: ...}})", path,
                                 request.gps_week, kLastGpsWeek));
  if (request.stream == StreamKind::gnss || request.stream == StreamKind::truth)
    return std::make_unique<UbxFixDecoder>(path, request, wants_high_rate(path, request));
  check_readings(path, request);
  return std::make_unique<UbxSensorDecoder>(path, request);
}

Recognition UbxReader::recognise(std::string_view head) const {
  UbxStretch stretch(head);
  std::size_t frames = 0;
  std::size_t positions = 0;
  std::size_t bytes = 0;
  std::size_t from = 0;
  for (;;) {
    const UbxFound found = find_ubx_frame(stretch, from);
    if (found.kind == UbxFound::Kind::nothing) break;
    from = found.begin + 2;
    if (found.kind != UbxFound::Kind::frame) continue;
    ++frames;
    if (holds_place(found.frame.key)) ++positions;
    bytes += found.end - found.begin;
    from = found.end;
  }
  if (frames == 0) return {};
  const std::string evidence =
      fmt::format("{} UBX frames with a right checksum, {} of them with a position or raw measurements",
                  frames, positions);
  if (frames >= 3 && positions > 0) return {1, evidence};
  return {0.9 * static_cast<double>(bytes) / static_cast<double>(head.size()), evidence};
}

}  // namespace waymark::formats

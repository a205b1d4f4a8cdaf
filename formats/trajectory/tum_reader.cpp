#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/byte_order_mark.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kTag = "TUM";

bool holds_pose(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first != std::string_view::npos && line[first] != '#';
}

/// Returns the yaw of a unit quaternion (x, y, z, w) in (-pi, pi], for the rotation order z-y-x.
double yaw(const std::array<double, 4>& q, const LineScanner& line) {
  const auto [x, y, z, w] = q;
  const double norm = std::hypot(std::hypot(x, y), std::hypot(z, w));
  if (!(std::abs(norm - 1) <= 0.01))
    line.fail(fmt::format("{}: expected a unit quaternion, got norm {:.6g}", kTag, norm));
  const double angle = std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
  return angle > -std::numbers::pi ? angle : std::numbers::pi;
}

StampedPose read_pose(LineScanner& line) {
  const std::string_view time = line.word();
  const std::optional<Stamp> stamp = stamp_from_decimal_seconds(time);
  if (!stamp) line.fail(fmt::format("{}: expected a number for 't', got '{}'", kTag, time));
  const double x = line.number({.tag = kTag, .field = "x"});
  const double y = line.number({.tag = kTag, .field = "y"});
  line.number({.tag = kTag, .field = "z"});
  std::array<double, 4> q{};
  constexpr std::array<std::string_view, 4> kFields{"qx", "qy", "qz", "qw"};
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = line.number({.tag = kTag, .field = kFields[i]});
  const double heading = yaw(q, line);
  line.end(kTag);
  return StampedPose{.stamp = *stamp, .pose = {x, y, heading}};
}

}  // namespace

std::vector<StampedPose> read_tum(std::string_view text, std::string_view name) {
  std::vector<StampedPose> poses;
  const std::string file(name);
  text = without_byte_order_mark(text);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    LineScanner line(text.substr(0, end), file, number);
    if (holds_pose(text.substr(0, end))) poses.push_back(read_pose(line));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (poses.empty()) throw InputError(fmt::format("{}: {}: no pose in it", name, kTag));
  return poses;
}

}  // namespace waymark::formats

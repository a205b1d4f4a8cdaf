#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>

namespace waymark {
namespace {

constexpr double kFarthestNode_s = 0.5;

/// Prints all digits, unlike Stamp::seconds(), without trailing zeros.
std::string seconds_text(Stamp stamp) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t size = std::abs(stamp.nanoseconds);
  std::string text = stamp.nanoseconds < 0 ? "-" : "";
  text += std::to_string(size / kSecond);
  if (size % kSecond == 0) return text;
  std::string fraction = std::to_string(size % kSecond);
  fraction.insert(0, 9 - fraction.size(), '0');
  fraction.erase(fraction.find_last_not_of('0') + 1);
  text += '.';
  return text += fraction;
}

}  // namespace

std::optional<ReadingPlace> find_place(const DriveNodes& nodes, Stamp moment) {
  const std::optional<NodeInTime> nearest = nearest_node(nodes, moment);
  if (!nearest || std::abs(nearest->ahead_s) > kFarthestNode_s) return std::nullopt;
  ReadingPlace place{nearest->node, nodes.poses[nearest->node], {}};
  if (!nodes.intervals.empty()) place.ahead = se2_exp<double>(motion_from_node(nodes, *nearest).way);
  return place;
}

std::vector<OptionInfo> mount_options() {
  return {
      {"mount_x", "0", "m", OptionRange{-100, 100}, "position of the sensor in the body frame, forward"},
      {"mount_y", "0", "m", OptionRange{-100, 100}, "position of the sensor in the body frame, to the left"},
      {"mount_deg", "0", "deg", OptionRange{-360, 360}, "heading of the sensor in the body frame"}};
}

Pose2<double> read_mount(const CheckedOptions& options) {
  return {options.number("mount_x"), options.number("mount_y"),
          options.number("mount_deg") * std::numbers::pi / 180};
}

double grid_scale_at(const SensorInput& input, Stamp moment) {
  if (input.fixes.empty()) return input.grid_scale;
  const auto after = std::lower_bound(input.fixes.begin(), input.fixes.end(), moment,
                                      [](const Fix& fix, Stamp stamp) { return fix.stamp < stamp; });
  if (after == input.fixes.begin()) return after->grid_scale;
  const auto before = after - 1;
  if (after == input.fixes.end()) return before->grid_scale;
  const bool later = seconds_between(moment, after->stamp) < seconds_between(before->stamp, moment);
  return later ? after->grid_scale : before->grid_scale;
}

void fail_reading(const SensorTable& readings, std::size_t row, std::string_view column,
                  const std::string& what) {
  std::string message = "row ";
  message += std::to_string(row + 1);
  message += " (time ";
  message += seconds_text(readings.stamps[row]);
  message += "): column '";
  message += column;
  message += "': ";
  message += what;
  throw InputError(message);
}

double number_of_reading(const SensorTable& readings, std::size_t row, std::size_t column,
                         std::string_view name, double largest) {
  const double given = readings.at(row, column);
  if (std::abs(given) <= largest) return given;
  fail_reading(readings, row, name,
               "must lie in [-" + shortest(largest) + ", " + shortest(largest) + "], got " + shortest(given));
}

double sigma_of_reading(const SensorTable& readings, std::size_t row, std::size_t column,
                        std::string_view name, double otherwise) {
  const double given = readings.at(row, column);
  if (std::isnan(given)) return otherwise;
  if (!(given >= 1e-9 && given <= 1e9))
    fail_reading(readings, row, name, "a sigma must lie in [1e-9, 1e9], got " + shortest(given));
  return given;
}

}  // namespace waymark

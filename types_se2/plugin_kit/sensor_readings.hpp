/// Small steps that every sensor model takes: find the pose of a reading, read the fields of its
/// row, and report a bad row.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark {

/// The pose that a reading is tied to.
struct ReadingPlace {
  std::size_t node = 0;
  VertexIndex pose = -1;
  Pose2<double> ahead;  ///< from the node to the body at the moment of the reading, by the odometry
};

/// Finds the node nearest to a moment. The result is empty outside the drive. It is also empty if
/// the next node is more than half a second away: that is a gap of the odometry, and the motion in
/// a gap is unknown.
[[nodiscard]] std::optional<ReadingPlace> find_place(const DriveNodes& nodes, Stamp moment);

/// Returns the options mount_x, mount_y (m) and mount_deg: the position and heading of a sensor in
/// the body frame.
[[nodiscard]] std::vector<OptionInfo> mount_options();
[[nodiscard]] Pose2<double> read_mount(const CheckedOptions& options);

/// Returns grid metres per metre on the ground, taken from the fix nearest in time;
/// SensorInput::grid_scale without fixes.
[[nodiscard]] double grid_scale_at(const SensorInput& input, Stamp moment);

/// @throws InputError "row 3 (time 1003.2): column 'id': " followed by `what`. Rows count from 1,
/// ordered by time.
[[noreturn]] void fail_reading(const SensorTable& readings, std::size_t row, std::string_view column,
                               const std::string& what);

/// Bounds of plausible readings. A number beyond them is garbage or has another unit.
inline constexpr double kLargestLength_m = 1e7;
inline constexpr double kLargestAngle_rad = 1e4;

/// Returns a number of a row. @throws InputError if it is beyond +-largest
[[nodiscard]] double number_of_reading(const SensorTable& readings, std::size_t row, std::size_t column,
                                       std::string_view name, double largest);

/// Returns a standard deviation of a row, or `otherwise` if the row gives none. @throws InputError
/// if it is outside [1e-9, 1e9]
[[nodiscard]] double sigma_of_reading(const SensorTable& readings, std::size_t row, std::size_t column,
                                      std::string_view name, double otherwise);

}  // namespace waymark

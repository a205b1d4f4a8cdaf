/// Small steps that every sensor model takes: where a reading meets the poses, what its row says, what is
/// wrong with it.
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
  Pose2<double> ahead;  ///< from the node to the body at the reading's own moment, by the odometry
};

/// The nearest node of a moment. Empty outside the drive, and where the next node is more than half a second
/// away: in a gap of the odometry no motion is known.
[[nodiscard]] std::optional<ReadingPlace> find_place(const DriveNodes& nodes, Stamp moment);

/// The options mount_x, mount_y (m) and mount_deg: where a sensor sits in the body frame, and its heading.
[[nodiscard]] std::vector<OptionInfo> mount_options();
[[nodiscard]] Pose2<double> read_mount(const CheckedOptions& options);

/// Grid metres per metre on the ground at a moment: that of the fix nearest in time; 1 without fixes.
[[nodiscard]] double grid_scale_at(const SensorInput& input, Stamp moment);

/// @throws InputError "row 3 (time 1003.2): column 'id': " and what is wrong; rows count from 1, in order of
/// time
[[noreturn]] void fail_reading(const SensorTable& readings, std::size_t row, std::string_view column,
                               const std::string& what);

/// Bounds of what a reading can be: beyond them a number is garbage or in another unit.
inline constexpr double kLargestLength_m = 1e7;
inline constexpr double kLargestAngle_rad = 1e4;

/// A number of a row. @throws InputError: beyond +-largest
[[nodiscard]] double number_of_reading(const SensorTable& readings, std::size_t row, std::size_t column,
                                       std::string_view name, double largest);

/// A standard deviation of a row, or `otherwise` where the row gives none. @throws InputError: outside
/// [1e-9, 1e9]
[[nodiscard]] double sigma_of_reading(const SensorTable& readings, std::size_t row, std::size_t column,
                                      std::string_view name, double otherwise);

}  // namespace waymark

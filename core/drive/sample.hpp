/// Time-stamped samples: what log readers deliver, what the drive tools and the GNSS modelings work on. Plain
/// structs; units and frames in the names or beside them. Angles are radians unless a name says otherwise.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>

namespace waymark {

/// One reading of the vehicle's odometry at the body point (default: rear axle).
struct OdometrySample {
  Stamp stamp;
  double speed_mps = 0;       ///< forward velocity, m/s; negative is reversing
  double yaw_rate_radps = 0;  ///< counter-clockwise seen from above, rad/s
};

/// The motion between two neighbouring nodes of a drive: constant speed and yaw rate over dt.
struct Interval {
  double speed_mps = 0;  ///< grid metres per second (grid scale applied); negative is reversing
  double yaw_rate_radps = 0;
  double dt_s = 0;
  bool bridged = false;  ///< lies in a gap of the odometry

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// One GNSS reading as a receiver gives it: WGS84, true-north axes.
struct GeodeticFix {
  Stamp stamp;
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = std::numeric_limits<double>::quiet_NaN();   ///< NaN where not given
  Eigen::Matrix2d covariance_en = Eigen::Matrix2d::Identity();  ///< m^2; axes east, north (true)
  std::optional<double> course_rad;                             ///< clockwise from true north
  std::optional<double> course_sigma_rad;
  std::optional<double> speed_mps;
  std::optional<double> speed_sigma_mps;
  int source = 0;        ///< index of the receiver in the drive
  std::size_t line = 0;  ///< line in its log, 1-based
};

/// One reading of the reference system.
struct GeodeticTruth {
  Stamp stamp;
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> heading_rad;  ///< counter-clockwise from true east
};

/// What became of a fix.
enum class FixStatus {
  accepted,  ///< in the graph
  rejected,  ///< by the outlier gate
  withheld   ///< kept out of the graph on purpose, to evaluate against
};

[[nodiscard]] std::string_view to_string(FixStatus status);
[[nodiscard]] std::optional<FixStatus> fix_status_from_string(std::string_view word);

/// A GNSS fix in the metric frame (Frame), with the gate's verdict.
struct Fix {
  Stamp stamp;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< antenna, frame coordinates, m
  Eigen::Matrix2d covariance =
      Eigen::Matrix2d::Identity();    ///< m^2, frame axes (x east, y north on the grid)
  std::optional<double> heading_rad;  ///< course as a heading: counter-clockwise from grid east
  std::optional<double> heading_sigma_rad;
  std::optional<double> speed_mps;
  std::optional<double> speed_sigma_mps;
  double height_m = std::numeric_limits<double>::quiet_NaN();
  double grid_scale = 1;     ///< grid metres per metre on the ground at this place (UTM point scale)
  int epoch = 0;             ///< running number of the fix in the drive
  int source = 0;            ///< index of the receiver
  std::int64_t vertex = -1;  ///< id of the pose vertex at this epoch, -1 before the graph is built

  FixStatus status = FixStatus::accepted;
  std::string reason = "unjudged";  ///< one word, see tools/drive/nodes/gate.hpp
  double chord_angle_rad = std::numeric_limits<double>::quiet_NaN();  ///< gate's angle error, NaN: not formed
  double displacement_m =
      std::numeric_limits<double>::quiet_NaN();  ///< gate's displacement error, NaN: not formed
};

/// A pose of the reference system in the metric frame.
struct TruthPose {
  Stamp stamp;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< truth reference point, frame coordinates, m
  std::optional<double> heading_rad;                   ///< counter-clockwise from grid east
};

/// A column that a sensor's log must or may have.
struct SensorColumn {
  std::string name;      ///< quantity, and the column's default name
  std::string unit;      ///< the SI unit its numbers come in: "m", "m/s", "m/s^2", "s", "rad", "rad/s" or "1"
  std::string sense;     ///< of rad: "" a size, "ccw" an angle or turn, "ccw_from_east" a heading (given from
                         ///< true east, it comes as one in the frame); of rad/s: "ccw"; else ""
  bool required = true;  ///< where it is not, NaN stands for a missing column or value
  std::string description;  ///< one sentence
};

/// The log of a sensor: rows of readings in time, one number per SensorColumn.
struct SensorTable {
  std::vector<Stamp> stamps;   ///< sorted
  std::vector<double> values;  ///< row by row, `columns` numbers each; SI units
  std::size_t columns = 0;

  [[nodiscard]] std::size_t size() const { return stamps.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * columns + column];
  }
};

/// An estimated pose of the body point at a stamp: (x, y, heading) in the frame.
struct StampedPose {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
};

}  // namespace waymark

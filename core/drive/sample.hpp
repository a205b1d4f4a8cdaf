/// Time-stamped samples. Log readers deliver them; the drive tools and the GNSS modelings use them.
/// They are plain structs, with units and frames in the names or beside them. Angles are radians
/// unless a name says otherwise.
///
/// They own their data; copies share nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace WAYMARK_EXPORT waymark {

/// One reading of the vehicle's odometry at the body point (default: rear axle).
struct OdometrySample {
  Stamp stamp;
  double speed_mps = 0;       ///< forward velocity, m/s; negative is reversing
  double yaw_rate_radps = 0;  ///< counter-clockwise seen from above, rad/s
  /// not measured: a stand-in for a sensor that failed; its intervals are bridged
  bool assumed = false;
  /// the vehicle turns without moving, slower than Interval::stands() can tell from one reading
  bool turns_on_spot = false;
  /// Error of the turn that this reading itself has, as white noise, rad^2/s: that of a yaw rate from the readings
  /// of a direction. The noise of the odometry's model comes on top.
  double turn_variance_per_s = 0;
  /// Error of the distance that this reading itself has, m^2/s: that of a speed where the sensor shows none.
  double distance_variance_per_s = 0;
};

/// The motion between two consecutive nodes of a drive. Speed and yaw rate are means over dt.
struct Interval {
  double speed_mps = 0;  ///< grid metres per second (grid scale applied); negative is reversing
  double yaw_rate_radps = 0;
  double dt_s = 0;
  bool bridged = false;  ///< the interval lies in a gap of the odometry, or its motion is assumed
  double gap_s = 0;      ///< time between the readings around a bridged interval, all its parts together
  double speed_change_mps = 0;  ///< from beginning to end: speed and yaw rate are linear in between
  double yaw_rate_change_radps = 0;
  /// Standard deviations of distance and turn as integrals: between readings the rates are not known.
  double distance_sigma_m = 0;
  double turn_sigma_rad = 0;
  bool turns_on_spot = false;  ///< as OdometrySample::turns_on_spot

  /// Tells whether the vehicle stands: it is slower than `below_mps`, and does not turn on the spot. Faster
  /// than 0.1 rad/s is more than any gyro at rest reads.
  [[nodiscard]] bool stands(double below_mps) const {
    constexpr double kTurns_radps = 0.1;
    return !turns_on_spot && std::abs(speed_mps) < below_mps && std::abs(yaw_rate_radps) < kTurns_radps;
  }

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// How a receiver computed a fix.
enum class FixQuality {
  unknown,        ///< not told
  single,         ///< from code ranges alone
  differential,   ///< with corrections for code ranges (SBAS, DGNSS)
  floating,       ///< RTK or PPP, carrier phases with real-valued ambiguities
  fixed,          ///< RTK, carrier phases with integer ambiguities
  dead_reckoned,  ///< extrapolated, by its motion or inertial sensors
  manual,         ///< entered by hand
  simulated       ///< by a simulator
};
/// Every quality, in the order of the enumeration.
inline constexpr std::array kFixQualities{
    FixQuality::unknown, FixQuality::single,        FixQuality::differential, FixQuality::floating,
    FixQuality::fixed,   FixQuality::dead_reckoned, FixQuality::manual,       FixQuality::simulated};

/// "unknown", "single", "differential", "float", "fixed", "dead_reckoned", "manual", "simulated".
[[nodiscard]] std::string_view to_string(FixQuality quality);
[[nodiscard]] std::optional<FixQuality> fix_quality_from_string(std::string_view word);

/// What a receiver tells of a fix besides its accuracy.
struct FixDetails {
  FixQuality quality = FixQuality::unknown;
  int satellites = -1;  ///< used in the fix; -1: not told
  double hdop = 0;      ///< horizontal dilution of precision; 0: not told
  /// age of the corrections; NaN: not told, or none were used
  double correction_age_s = std::numeric_limits<double>::quiet_NaN();
};

/// One GNSS reading of a receiver: WGS84, true-north axes.
struct GeodeticFix {
  Stamp stamp;
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = std::numeric_limits<double>::quiet_NaN();   ///< NaN if not given
  Eigen::Matrix2d covariance_en = Eigen::Matrix2d::Identity();  ///< m^2; axes east, north (true)
  bool accuracy_claimed = true;      ///< false: the covariance is a stated stand-in, not the receiver's claim
  std::optional<double> course_rad;  ///< clockwise from true north
  std::optional<double> course_sigma_rad;
  std::optional<double> speed_mps;
  std::optional<double> speed_sigma_mps;
  int source = 0;        ///< index of the receiver in the drive
  std::size_t line = 0;  ///< line in its log, 1-based
  FixDetails told = {};
};

/// One reading of the reference system.
struct GeodeticTruth {
  Stamp stamp;
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> heading_rad;  ///< counter-clockwise from true east
};

/// The status of a fix.
enum class FixStatus {
  accepted,  ///< in the graph
  rejected,  ///< the outlier gate rejected it
  withheld   ///< left out of the graph on purpose, for evaluation
};

[[nodiscard]] std::string_view to_string(FixStatus status);
[[nodiscard]] std::optional<FixStatus> fix_status_from_string(std::string_view word);

/// A GNSS fix in the metric frame (Frame), with the verdict of the gate.
struct Fix {
  Stamp stamp;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< antenna, frame coordinates, m
  Eigen::Matrix2d covariance =
      Eigen::Matrix2d::Identity();  ///< m^2, frame axes (x east, y north on the grid)
  bool accuracy_claimed = true;     ///< as GeodeticFix::accuracy_claimed
  /// Returns the standard deviation along an axis, in the mean of both [m].
  [[nodiscard]] double accuracy_m() const { return std::sqrt(0.5 * covariance.trace()); }
  std::optional<double> heading_rad;  ///< course as a heading: counter-clockwise from grid east
  std::optional<double> heading_sigma_rad;
  std::optional<double> speed_mps;
  std::optional<double> speed_sigma_mps;
  double height_m = std::numeric_limits<double>::quiet_NaN();
  double grid_scale = 1;  ///< grid metres per metre on the ground at this place (UTM point scale)
  int epoch = 0;          ///< running number of the fix in the drive
  int source = 0;         ///< index of its source in the drive, a receiver
  VertexId vertex{-1};    ///< pose vertex at this epoch; -1 before the graph is built

  FixStatus status = FixStatus::accepted;
  std::string reason = "unjudged";  ///< one word, see tools/drive/nodes/gate.hpp
  /// angle error in the gate; NaN: not computed
  double chord_angle_rad = std::numeric_limits<double>::quiet_NaN();
  /// displacement error in the gate; NaN: not computed
  double displacement_m = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector2d antenna_m{0, 0};  ///< of its receiver in the body frame (x forward, y left)
  /// where its receiver has the antenna beside where it is, because it smooths
  Eigen::Vector2d smoothed_m{0, 0};
  /// lasting jumps of its receiver so far: fixes of two levels share no slow error
  int level = 0;
  double jump_sigma_m = 0;  ///< per axis, of the part of the slow error that the jumps beside it leave open
  FixDetails told = {};

  /// Returns where its receiver has the antenna, in the body frame.
  [[nodiscard]] Eigen::Vector2d antenna_seen_m() const { return antenna_m + smoothed_m; }
};

/// A pose of the reference system in the metric frame.
struct TruthPose {
  Stamp stamp;
  /// truth reference point, frame coordinates, m
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  std::optional<double> heading_rad;  ///< counter-clockwise from grid east
  /// above the ellipsoid, of a point of the vehicle; NaN: not given
  double height_m = std::numeric_limits<double>::quiet_NaN();
};

/// A column that the log of a sensor must or may have.
struct SensorColumn {
  std::string name;  ///< the quantity, and the default name of the column
  std::string unit;  ///< SI unit of its numbers: "m", "m/s", "m/s^2", "s", "rad", "rad/s" or "1"
  /// sense of the numbers. For rad: "" is a size, "ccw" an angle or turn, "ccw_from_east" a heading
  /// (given from true east, delivered in the frame). For rad/s: "" is a size, "ccw" a turning rate. For m/s:
  /// "body" is that of a vehicle.
  /// For m: "x", "y" and "height" are the coordinates of a place, delivered in the frame (x and y
  /// together). A user may give them as latitude and longitude, as easting and northing, or as ECEF,
  /// by the unit of the column. Otherwise ""
  std::string sense;
  bool required = true;     ///< if false, NaN stands for a missing column or value
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

/// Where a sensor places the vehicle by one epoch of its readings alone.
struct RoughPosition {
  Stamp stamp;
  Eigen::Vector3d ecef = Eigen::Vector3d::Zero();       ///< Earth-centred, Earth-fixed, m
  Eigen::Vector2d antenna_m = Eigen::Vector2d::Zero();  ///< what is placed, in the body frame
  double sigma_m = 10;                                  ///< per horizontal axis
};

/// An estimated pose of the body point at a stamp: (x, y, heading) in the frame.
struct StampedPose {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
};

}  // namespace waymark

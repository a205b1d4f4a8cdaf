/// What the plugins may know of a drive besides their own input: its frame, the vehicle, and the logs
/// of the other sources.
///
/// All of it belongs to the caller and is valid during the call that gets it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace WAYMARK_EXPORT waymark {

/// WGS84, degrees.
struct GeodeticPoint {
  double latitude_deg = 0;
  double longitude_deg = 0;
};

/// A point in the frame, and the orientation of the grid there.
struct GridPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< frame coordinates, m
  /// meridian convergence: bearing of grid north, clockwise from true north
  double convergence_rad = 0;
  double scale = 1;  ///< grid metres per metre on the ellipsoid
};

/// A point in the frame with its height.
struct PointWithHeight {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< frame coordinates, m
  double height_m = 0;                                 ///< above the ellipsoid
};

/// Converts places between the frame of a drive, WGS84, and Earth-centred, Earth-fixed coordinates
/// (ECEF: m, z through the north pole, x through Greenwich).
class Geodesy {
 public:
  virtual ~Geodesy();

  [[nodiscard]] virtual const Frame& frame() const = 0;
  /// @throws InputError if the point is no place, or is 30 degrees of longitude or more from the
  /// meridian of the zone
  [[nodiscard]] virtual GridPoint to_grid(const GeodeticPoint& point) const = 0;
  /// The inverse of to_grid. @throws InputError far outside the zone
  [[nodiscard]] virtual GeodeticPoint to_geodetic(const Eigen::Vector2d& position) const = 0;
  /// @throws InputError as to_geodetic
  [[nodiscard]] virtual Eigen::Vector3d to_ecef(const PointWithHeight& point) const = 0;
  /// The inverse of to_ecef. @throws InputError as to_grid
  [[nodiscard]] virtual PointWithHeight from_ecef(const Eigen::Vector3d& point) const = 0;
};

/// What a drive.yaml states of the vehicle (`odometry: {vehicle: ...}`). 0: not stated.
struct Vehicle {
  double track_width_m = 0;
  double wheelbase_m = 0;
  double steering_ratio = 1;  ///< angle of the steering wheel over that of the front wheels
  double metres_per_tick = 0;
};

/// A source of the drive, with what it has measured in the whole of it. Members that its kind does not
/// have are empty.
struct DriveSource {
  std::string name;
  std::string kind;                            ///< "odometry", "gnss", or the name of a sensor model
  Eigen::Vector2d antenna_m{0, 0};             ///< of a receiver, body frame
  std::span<const OdometrySample> odometry{};  ///< on the clock of the drive, sorted
  std::span<const Fix> fixes{};                ///< in the frame, sorted, with the verdict of the gate
  const SensorTable* readings = nullptr;       ///< in SI units and the frame; sorted
};

/// The drive around an input.
struct DriveContext {
  /// null for a frame without a known place
  const Geodesy* geodesy = nullptr;
  TimeScale scale = TimeScale::gps;  ///< of all stamps
  Vehicle vehicle{};
  /// all sources: relative ones, receivers, further sensors
  std::span<const DriveSource> sources{};

  /// Returns the source of a name. @throws UsageError for an unknown one; it lists those that exist
  [[nodiscard]] const DriveSource& source(std::string_view name) const;
  /// @throws UsageError for a frame without a known place
  [[nodiscard]] const Geodesy& require_geodesy() const;

  /// Returns the context of an input that has none: no place, no sources.
  [[nodiscard]] static const DriveContext& none();
};

}  // namespace waymark

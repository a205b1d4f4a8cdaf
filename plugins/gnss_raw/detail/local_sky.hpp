/// The satellites as they are seen from a place of the drive.
#pragma once

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/plugins/gnss_raw/detail/epochs.hpp>

namespace waymark::plugins::gnss_raw {

/// Metres from a reference point: x and y along the axes of the grid there, z upwards. The plane and
/// the grid part by 1 cm in 300 m.
class LocalSky {
 public:
  /// @param reference near the antenna
  /// @param turned whether satellites are in the axes of the moment of reception already
  LocalSky(const PointWithHeight& reference, bool turned, const Geodesy& geodesy);

  /// x and y in the frame, height, m.
  [[nodiscard]] const Eigen::Vector3d& reference() const { return reference_; }
  /// Metres on the ground per grid metre.
  [[nodiscard]] double ground() const { return ground_; }
  /// Returns a satellite in these axes, m, turned by the rotation of the Earth on the signal's way.
  [[nodiscard]] Eigen::Vector3d local(const Eigen::Vector3d& satellite) const;
  /// Returns its velocity in these axes, m/s. @param range_m to it
  [[nodiscard]] Eigen::Vector3d local_velocity(const Eigen::Vector3d& velocity, double range_m) const;
  /// Returns the median of pseudorange minus range: about the clock. NaN without pseudoranges.
  [[nodiscard]] double common_offset_m(const Epoch& epoch) const;

 private:
  Eigen::Vector3d reference_;
  Eigen::Vector3d ecef_;
  Eigen::Matrix3d axes_;  ///< rows: the axes in ECEF
  double ground_ = 1;
  bool turned_;
};

}  // namespace waymark::plugins::gnss_raw

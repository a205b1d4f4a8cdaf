/// Odometry laid on the fixes of a time, without what drifts in its yaw rate.
#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// A vehicle that is slower stands, or may.
inline constexpr double kMoves_mps = 0.5;

/// How the fixes of a time lie to the odometry.
struct LaidTime {
  std::complex<double> turn;  ///< of length 1: from the odometry's frame to that of the fixes
  double weight_m = 0;        ///< way, at most 100 m; 0: the fixes do not have the shape of the odometry
};

/// How the yaw rate of an odometry drifts from that of the vehicle.
struct YawDrift {
  double radps = 0;  ///< bias of a gyro
  double radpm = 0;  ///< turns of wheels whose radii differ, or of a steering angle that is off
};

/// The way of an odometry, beside the fixes of its drive.
class LaidOdometry {
 public:
  /// Removes the yaw rate at rest.
  /// @param odometry sorted by stamp; it must outlive this
  /// @param fixes sorted by stamp; those of the first receiver that are not withheld are used
  LaidOdometry(std::span<const OdometrySample> odometry, std::span<const Fix> fixes);

  /// Removes the drift too that turns short times against those before them. It may turn the way after a stop
  /// against the one before, whichever way the vehicle drives.
  [[nodiscard]] static LaidOdometry without_drift(std::span<const OdometrySample> odometry,
                                                  std::span<const Fix> fixes);

  /// Tells whether the fixes about a time are as near to each other as they claim.
  [[nodiscard]] bool stays(Stamp from, Stamp to) const;

  /// Tells whether the odometry is silent for long before a sample: how it turned then is not known.
  /// @pre sample > 0
  [[nodiscard]] bool is_silent_before(std::size_t sample) const;

  /// Returns the way between two samples.
  [[nodiscard]] double length_m(std::size_t first, std::size_t last) const;

  /// Lays the odometry of a time on its fixes. Ways that are shorter than about 5 m, or than twice the accuracy of
  /// the fixes, have no alignment.
  [[nodiscard]] LaidTime alignment(Stamp from, Stamp to) const;

  /// Returns how far the fixes after a time lie from where the odometry leads those before it: 20 s before, and 20 s
  /// that begin 5 s after. Empty: the fixes do not have the shape of the odometry there, or there are too few.
  [[nodiscard]] std::optional<double> displacement_m(Stamp from, Stamp to) const;

 private:
  /// Fixes of a time, and the odometry's places beside them.
  struct Pairs {
    std::span<const Fix> fixes;
    std::vector<std::complex<double>> places;
  };
  [[nodiscard]] Pairs pairs(Stamp from, Stamp to) const;

  /// How far the odometry turned from the fixes, between two times.
  struct Drifted {
    double turn_rad = 0;
    double duration_s = 0;
    double length_m = 0;
  };
  [[nodiscard]] std::vector<Drifted> drifted() const;
  [[nodiscard]] static YawDrift drift_of(std::span<const Drifted> turns, bool has_bias);
  void remove(const YawDrift& more);
  void reckon();
  [[nodiscard]] std::vector<Fix>::const_iterator first_since(Stamp moment) const;
  [[nodiscard]] std::complex<double> position_at(Stamp stamp) const;

  std::span<const OdometrySample> odometry_;
  std::vector<Fix> fixes_;
  double silence_s_;
  YawDrift drift_;
  std::vector<std::complex<double>> positions_;  // of the odometry at its samples, from the origin
};

}  // namespace waymark::drive

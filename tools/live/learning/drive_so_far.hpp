/// What the sources have said lately, as the logs of a drive: what is done with a whole drive can be done with
/// it, on a copy.
#pragma once

#include <deque>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/live/estimator/intake.hpp>

namespace waymark::live {

class DriveSoFar {
 public:
  /// @param description of the drive @param kept_s older samples are forgotten
  DriveSoFar(const drive::DriveDescription& description, double kept_s);

  /// Takes a sample without its stated delay.
  void take(const Sample& sample);
  void clear();
  /// Forgets what was before its last part. @param length_s of that
  void keep_last(double length_s);
  /// Tells that the drive was interrupted. @param until when it went on @param length_s of the interruption
  void pause(Stamp until, double length_s) { pauses_.push_back({until, length_s}); }
  /// Returns the time from the first to the last sample of the odometries, without the pauses.
  [[nodiscard]] double length_s() const;
  /// Returns odometry and fixes; the logs of sensors are empty. @param description of the drive
  [[nodiscard]] drive::DriveLogs logs(const drive::DriveDescription& description) const;
  /// Returns the samples of an odometry. @param source index in the description
  [[nodiscard]] const std::deque<OdometrySample>& odometry(std::size_t source) const {
    return odometries_[source];
  }
  /// Returns the readings of each sensor, in the frame.
  [[nodiscard]] std::vector<SensorTable> readings() const;

 private:
  void keep_since(Stamp oldest);

  struct Pause {
    Stamp stamp;  // of its end
    double length_s = 0;
  };

  std::vector<std::deque<OdometrySample>> odometries_;
  std::vector<std::deque<GeodeticFix>> fixes_;       // by receiver
  std::vector<std::deque<SensorReading>> readings_;  // by sensor
  std::deque<Pause> pauses_;
  double kept_s_;
};

/// Returns the description that fits these logs: nothing of them is cut off, late or withheld.
/// @param frame of the estimate
[[nodiscard]] drive::DriveDescription described_so_far(drive::DriveDescription description,
                                                       const Frame& frame);

}  // namespace waymark::live

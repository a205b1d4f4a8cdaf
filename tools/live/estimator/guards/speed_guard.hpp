/// Wheels that lock or spin while driving: the speed leaps away faster than any vehicle accelerates. In a batch
/// run tools/drive/mending finds such times from both of their ends; here only the beginning is known.
#pragma once

#include <deque>
#include <optional>

#include <waymark/core/drive/sample.hpp>

namespace waymark::live {

/// One odometry.
class SpeedGuard {
 public:
  /// Judges the next sample, in order of the stamps. From a leap (drive::is_speed_leap) to the leap back, for 5 s
  /// at most, the speed before it is held and marked as assumed. Where more than one sample in 20 is in such
  /// times (after 5 s of them), the speed is rough, and believed while that holds.
  [[nodiscard]] OdometrySample judged(OdometrySample sample);
  /// Returns the sample before the leap, while one lasts.
  [[nodiscard]] const std::optional<OdometrySample>& before_leap() const { return before_; }

 private:
  void remember(const OdometrySample& sample);
  [[nodiscard]] double usual_change() const;
  [[nodiscard]] std::optional<OdometrySample> leapt_from(const OdometrySample& sample) const;
  [[nodiscard]] bool has_repeated(const OdometrySample& sample) const;
  [[nodiscard]] bool is_rough() const;
  [[nodiscard]] bool is_late_return(const OdometrySample& sample, const OdometrySample& from) const;
  [[nodiscard]] bool is_back(const OdometrySample& sample, const OdometrySample& from) const;

  std::deque<OdometrySample> recent_;  // as read, those of a leap's duration
  std::deque<double> changes_;         // of the speed from one to the next, m/s
  std::optional<OdometrySample> before_;
  std::optional<Stamp> changed_;  // the speed, for the last time
  std::optional<Stamp> back_;     // when the last leap back began
  double seen_s_ = 0;
  double held_s_ = 0;
  double given_up_ = 0;  // the change of a leap that did not come back in time; 0: none
};

}  // namespace waymark::live

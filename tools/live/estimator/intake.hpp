/// Samples in order of time, whatever the order of their arrival within a stated bound.
///
/// Time is what the stamps of the odometries say. A sample is released when the odometry is later by the
/// bound. So no sample of another source can move the time: one stamp in the future waits, and does no
/// harm.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::live {

/// A row of a further sensor.
struct SensorReading {
  Stamp stamp;
  std::size_t sensor = 0;  ///< index in DriveDescription::sensors
  std::vector<double> values;
};

/// A sample of a further odometry. An OdometrySample is one of the first.
struct FurtherOdometry {
  Stamp stamp;
  std::size_t source = 1;  ///< index in DriveDescription::odometry
  double speed_mps = 0;
  double yaw_rate_radps = 0;
};

using Sample = std::variant<OdometrySample, GeodeticFix, SensorReading, FurtherOdometry>;
[[nodiscard]] Stamp stamp_of(const Sample& sample);

/// What the intake does with a sample.
enum class Arrival {
  taken,
  late,        ///< older than what is released already; only fixes are of use then
  duplicate,   ///< of the same stamp and source as another one
  not_finite,  ///< some number is not finite
  future,      ///< stamped so far ahead that it cannot be
  suspended    ///< odometry whose stamp has jumped; the next ones decide whether the clock has
};

/// A jump of the clock of the odometry, after which everything begins anew.
struct ClockJump {
  Stamp from;
  Stamp to;
};

class Intake {
 public:
  /// @param reorder_s how long samples wait for earlier ones
  /// @param longest_gap_s a longer step of the odometry needs a second sample that agrees
  Intake(double reorder_s, double longest_gap_s) : reorder_s_(reorder_s), longest_gap_s_(longest_gap_s) {}

  /// Takes a sample. @returns what it does with it. A late fix is released by the next call of next().
  Arrival take(Sample sample);
  /// Returns a jump of the clock since the last call. Samples that waited are gone.
  [[nodiscard]] std::optional<ClockJump> jump();
  /// Returns the next sample in order of time, if there is one.
  [[nodiscard]] std::optional<Sample> next();
  /// Ends the waiting: all samples are released.
  void finish() { finished_ = true; }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    Sample sample;
    Stamp stamp;
    std::size_t order;  // samples of one stamp: odometry, sensors, fixes by source
  };
  Arrival take_odometry(const OdometrySample& sample);
  Arrival take_further(const FurtherOdometry& sample);
  void insert(Sample sample, std::size_t order);
  [[nodiscard]] bool is_duplicate(const Sample& sample, std::size_t order) const;

  double reorder_s_;
  double longest_gap_s_;
  std::deque<Waiting> waiting_;  // by stamp and order
  std::deque<Sample> late_;
  std::optional<Stamp> newest_;    // of the odometry
  std::optional<Stamp> released_;  // of the last one
  std::optional<Stamp> released_odometry_;
  std::vector<OdometrySample> suspended_;
  std::optional<ClockJump> jump_;
  bool finished_ = false;
};

}  // namespace waymark::live

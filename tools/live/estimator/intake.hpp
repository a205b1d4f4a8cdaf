/// Samples in order of time, whatever the order of their arrival within a stated bound.
///
/// Time is what the stamps of the odometries say. A sample is released when the odometry is later by the
/// bound. So no sample of another source can move the time: one stamp in the future waits, and does no
/// harm.
///
/// If the clock of the odometry steps while fixes go on as before, its stamps are moved back by the step from then on.
/// The next fix tells; samples of the odometry wait for it, for the time in which it should come.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/live/estimator/guards/clock_relation.hpp>

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
  double turn_variance_per_s = 0;  ///< as OdometrySample::turn_variance_per_s
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
  bool to_fixes = false;  ///< the stamps of the odometry are moved to those of the fixes from here on
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
  /// Returns a step of the odometry's clock alone since the last call, s: by this its stamps are moved back.
  [[nodiscard]] std::optional<double> step() { return std::exchange(step_s_, std::nullopt); }
  /// Returns the next sample in order of time, if there is one.
  [[nodiscard]] std::optional<Sample> next();
  /// Ends the waiting: all samples are released.
  void finish();
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    Sample sample;
    Stamp stamp;
    std::size_t order;  // samples of one stamp: odometry, sensors, fixes by source
  };
  Arrival take_odometry(OdometrySample sample);
  Arrival suspend(const OdometrySample& sample);
  [[nodiscard]] bool is_plausible(double ahead_s) const;
  [[nodiscard]] bool is_silence(double ahead_s) const;
  [[nodiscard]] bool waits_for_fix() const;
  void hear(const GeodeticFix& fix);
  void decide();
  void begin_at_suspended();
  void take_suspended(double moved_s);
  void move_to_fixes(double moved_s);
  Arrival take_further(FurtherOdometry sample);
  void insert(Sample sample, std::size_t order);
  [[nodiscard]] bool is_duplicate(const Sample& sample, std::size_t order) const;

  double reorder_s_;
  double longest_gap_s_;
  std::deque<Waiting> waiting_;  // by stamp and order
  std::deque<Sample> late_;
  std::optional<Stamp> newest_;  // of the odometries
  std::optional<Stamp> newest_of_first_;
  std::optional<Stamp> released_;  // of the last one
  std::optional<Stamp> released_odometry_;
  std::vector<OdometrySample> suspended_;
  std::optional<ClockJump> jump_;
  ClockRelation relation_;
  double interval_s_ = 0;         // of the odometry, the last one
  std::int64_t moved_ns_ = 0;     // that the stamps of the odometry are moved by
  std::optional<double> told_s_;  // by the first fix after a step: by how much the odometry is to be moved
  std::optional<double> step_s_;
  bool finished_ = false;
};

}  // namespace waymark::live

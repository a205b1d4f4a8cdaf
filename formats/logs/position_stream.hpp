/// Where the positions of a receiver's log go: fixes or truth, on the clock and with the accuracy that were
/// asked for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <waymark/core/log_reader.hpp>

namespace waymark {

/// What a log says about a position's accuracy.
struct StatedAccuracy {
  std::optional<Eigen::Matrix2d> covariance_en;  ///< 1 sigma, m^2; empty: none
  double hdop = 0;                               ///< used where there is no covariance; 0: none
};

/// Positions of a gnss or truth stream. What it counts goes into the notes once, at the end.
class PositionStream {
 public:
  PositionStream(const std::string& path, const LogRequest& request);

  /// The stamp on the request's scale with the request's offset; empty where it does not fit.
  [[nodiscard]] std::optional<Stamp> stamp(Stamp given, TimeScale scale) const;
  [[nodiscard]] bool wants_truth() const { return truth_; }

  /// Takes a position into data.fixes, or data.truth, which needs no accuracy.
  /// @param fix      its covariance is set here
  /// @param heading  of the truth, counter-clockwise from east
  /// @return null, or why it is not usable (then nothing was taken)
  [[nodiscard]] const char* add(LogData& data, GeodeticFix fix, const StatedAccuracy& accuracy,
                                std::optional<double> heading_rad = std::nullopt);
  /// The closing notes.
  void finish(LogData& data) const;

 private:
  [[nodiscard]] const char* set_covariance(GeodeticFix& fix, const StatedAccuracy& accuracy);

  std::string path_;
  TimeScale scale_;
  std::int64_t offset_ = 0;
  AccuracyMeaning meaning_;
  double variance_factor_;
  double default_sigma_m_;
  double range_error_m_;
  int source_;
  bool truth_;
  std::size_t from_covariance_ = 0;
  std::size_t from_hdop_ = 0;
  std::size_t defaulted_ = 0;
};

/// Refuses what a receiver's log cannot give. @param format  for the complaint: "an RTKLIB solution"
/// @throws InputError for the odometry and sensor streams, a column map, companions
void require_positions(const std::string& path, const LogRequest& request, const char* format);

/// Speed and course with their sigmas from a velocity (east, north) and its covariance in (m/s)^2. A course
/// whose sigma exceeds a radian says nothing and is left out. @param covariance  null: not known
void set_velocity(GeodeticFix& fix, const Eigen::Vector2d& velocity_en, const Eigen::Matrix2d* covariance);

}  // namespace waymark

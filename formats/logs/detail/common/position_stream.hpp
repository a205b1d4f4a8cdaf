/// Where the positions of a log go: fixes or truth, on the clock and with the accuracy that were asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// What a log says about a position's accuracy.
struct StatedAccuracy {
  /// Squares of the figures east and north, and their covariance if they have one, m^2. Empty: no figures.
  std::optional<Eigen::Matrix2d> squares_en = std::nullopt;
  /// What the figures mean where the request does not say; empty: 1 sigma, whatever the request says.
  std::optional<AccuracyMeaning> usual_meaning = AccuracyMeaning::one_sigma;
  double hdop = 0;  ///< used where there are no figures; 0: none
};

/// Positions of a gnss or truth stream. What it counts goes into the notes once, at the end.
class PositionStream {
 public:
  /// @param figures  name of the accuracy figures, for the note on what they are read as; null: the reader
  /// writes that note itself
  PositionStream(const std::string& path, const LogRequest& request, const char* figures);

  /// The stamp on the request's scale with the request's offset; empty where it does not fit.
  [[nodiscard]] std::optional<Stamp> stamp(Stamp given, TimeScale scale) const;
  [[nodiscard]] bool wants_truth() const { return truth_; }

  /// Sets the covariance: from the figures; else HDOP times the stated range error; else the stated default.
  /// Truth needs none. @return null, or why the position is not usable
  [[nodiscard]] const char* set_covariance(GeodeticFix& fix, const StatedAccuracy& accuracy);
  /// Takes a position into data.fixes or data.truth. @param fix  with its covariance
  /// @param heading_rad  of the truth, counter-clockwise from east
  void give(LogData& data, const GeodeticFix& fix, std::optional<double> heading_rad = std::nullopt) const;
  /// Both. @return null, or why the position is not usable (then nothing was taken)
  [[nodiscard]] const char* add(LogData& data, GeodeticFix fix, const StatedAccuracy& accuracy,
                                std::optional<double> heading_rad = std::nullopt);
  /// The closing notes.
  void finish(LogData& data) const;

 private:
  [[nodiscard]] const char* stand_in(GeodeticFix& fix, double hdop);

  std::string path_;
  const char* figures_;
  TimeScale scale_;
  std::int64_t offset_ = 0;
  AccuracyMeaning stated_;
  double default_sigma_m_;
  double range_error_m_;
  int source_;
  bool truth_;
  std::size_t with_figures_ = 0;                          ///< whose meaning may be stated
  AccuracyMeaning meaning_ = AccuracyMeaning::automatic;  ///< of them
  bool usual_ = false;                                    ///< that meaning is the usual one
  std::size_t from_hdop_ = 0;
  std::size_t defaulted_ = 0;
};

/// Speed and course with their sigmas from a velocity (east, north) and its covariance in (m/s)^2. A course
/// whose sigma exceeds a radian says nothing and is left out. @param covariance  null: not known
void set_velocity(GeodeticFix& fix, const Eigen::Vector2d& velocity_en, const Eigen::Matrix2d* covariance);

}  // namespace waymark::formats

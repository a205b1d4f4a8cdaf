/// Collects the positions of a log as fixes or truth, on the requested clock and with the
/// requested accuracy.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// The accuracy of a position as the log states it.
struct StatedAccuracy {
  /// Squares of the figures for east and north, and their covariance if there is one, in m^2.
  /// Empty: there are no figures.
  std::optional<Eigen::Matrix2d> squares_en = std::nullopt;
  /// The meaning of the figures if the request does not state one. Empty: 1 sigma, even if the
  /// request states another one.
  std::optional<AccuracyMeaning> usual_meaning = AccuracyMeaning::one_sigma;
};

/// Positions of a gnss or truth stream. Its counts go into the notes once, at the end.
class PositionStream {
 public:
  /// @param figures name of the accuracy figures, for the note about their meaning; null: the
  /// reader writes that note itself
  PositionStream(const std::string& path, const LogRequest& request, const char* figures);

  /// Returns the stamp on the requested scale, with the requested offset. Empty if it does not fit.
  [[nodiscard]] std::optional<Stamp> stamp(Stamp given, TimeScale scale) const;
  [[nodiscard]] bool wants_truth() const { return truth_; }

  /// Sets the covariance: from the figures; else the sigma stated for the quality; else, for fixed and
  /// float, the usual sigma; else HDOP times the stated range error; else the stated default; else the
  /// usual sigma of the quality. Truth needs none.
  /// @param fix with what is told of it @return null, or the reason why the position is unusable
  [[nodiscard]] const char* set_covariance(GeodeticFix& fix, const StatedAccuracy& accuracy);
  /// Adds a position to data.fixes or data.truth.
  /// @param fix with its covariance
  /// @param heading_rad heading of the truth, counter-clockwise from east
  void give(LogData& data, const GeodeticFix& fix, std::optional<double> heading_rad = std::nullopt);
  /// Calls set_covariance and give. @return null, or the reason why the position is unusable (then
  /// nothing was added)
  [[nodiscard]] const char* add(LogData& data, GeodeticFix fix, const StatedAccuracy& accuracy,
                                std::optional<double> heading_rad = std::nullopt);
  /// Adds the final notes.
  void finish(LogData& data) const;

 private:
  [[nodiscard]] const char* stand_in(GeodeticFix& fix);
  [[nodiscard]] const char* take_sigma(GeodeticFix& fix, double sigma_m, bool claimed,
                                       std::size_t& count) const;

  std::string path_;
  const char* figures_;
  TimeScale scale_;
  std::int64_t offset_ = 0;
  AccuracyMeaning stated_;
  double default_sigma_m_;
  double range_error_m_;
  std::map<FixQuality, double> sigma_by_quality_;  ///< stated
  int source_;
  bool truth_;
  /// those whose meaning a request may state
  std::size_t with_figures_ = 0;
  AccuracyMeaning meaning_ = AccuracyMeaning::automatic;  ///< their meaning
  bool usual_ = false;                                    ///< the meaning is the usual one
  std::size_t from_hdop_ = 0;
  std::size_t defaulted_ = 0;
  /// fixes with the sigma stated for their quality, and with the usual one; by FixQuality
  std::array<std::size_t, kFixQualities.size()> stated_quality_{};
  std::array<std::size_t, kFixQualities.size()> usual_quality_{};
  std::array<std::size_t, kFixQualities.size()> usual_hdop_{};  ///< times HDOP
  std::array<std::size_t, kFixQualities.size()> qualities_{};   ///< of all fixes
};

/// Computes speed and course with their sigmas from a velocity (east, north) and its covariance in
/// (m/s)^2. A course with a sigma above one radian is useless and left out. @param covariance
/// null: not known
void set_velocity(GeodeticFix& fix, const Eigen::Vector2d& velocity_en, const Eigen::Matrix2d* covariance);

}  // namespace waymark::formats

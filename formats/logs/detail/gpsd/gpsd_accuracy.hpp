/// The meaning of the accuracy figures of a gpsd log.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/gpsd/gpsd_report.hpp>

namespace waymark::formats {

/// Chooses between epx and epy, eph, and the GST object. At the end it reports how it read them.
class GpsdAccuracy {
 public:
  /// @param gst the GST object of the same time and device, or null
  /// @param stated the meaning of the figures that the request states
  [[nodiscard]] StatedAccuracy of(const GpsdReport& report, const GpsdReport* gst, AccuracyMeaning stated);
  /// @param release version of gpsd from its VERSION object; empty: the log has none
  /// @param meaning as in the request
  [[nodiscard]] std::vector<std::string> notes(const std::string& release, AccuracyMeaning meaning) const;

 private:
  [[nodiscard]] std::optional<Eigen::Matrix2d> covariance_from_gst(const GpsdReport& gst);
  [[nodiscard]] std::string dialect(const std::string& release) const;

  std::size_t from_gst_ = 0;
  std::size_t from_ellipse_ = 0;
  std::size_t per_axis_ = 0;
  std::size_t per_axis_equal_ = 0;
  std::size_t per_axis_with_radial_ = 0;
  std::size_t radial_ = 0;
  double per_axis_sum_m_ = 0;  ///< sum of (epx + epy) / 2
  double radial_sum_m_ = 0;    ///< sum of eph in the same reports
};

}  // namespace waymark::formats

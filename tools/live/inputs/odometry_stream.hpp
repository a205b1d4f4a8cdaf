/// Odometry that comes in parts, while it comes: speed from one stream, yaw rate from another.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/parts/odometry_parts.hpp>

namespace waymark::live {

/// Assembles the last seconds anew with every piece, as a batch run assembles the whole. A sample is ready
/// when all its parts are there: it is late by one interval of the slowest part.
class OdometryStream {
 public:
  /// @param parts how many streams there are
  OdometryStream(std::size_t parts, drive::OdometryAssembly how, double gap_s)
      : parts_(parts), how_(how), gap_s_(gap_s) {
    how_.goes_on = true;
  }

  /// Takes the next readings of a part. @returns the samples that are ready
  [[nodiscard]] std::vector<OdometrySample> take(std::size_t part, const SensorTable& rows);
  /// Returns why nothing can be assembled yet; empty if it can.
  [[nodiscard]] const std::string& obstacle() const { return obstacle_; }
  /// Returns the source of the yaw rate, one of drive::kYawRateSources; empty before anything is assembled.
  [[nodiscard]] std::string_view yaw_rate_from() const { return yaw_rate_from_; }

 private:
  void forget_before(Stamp moment);

  std::vector<drive::OdometryPart> parts_;
  drive::OdometryAssembly how_;
  double gap_s_;
  std::optional<Stamp> last_;
  std::string obstacle_;
  std::string_view yaw_rate_from_;
};

}  // namespace waymark::live

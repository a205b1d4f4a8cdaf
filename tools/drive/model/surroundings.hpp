/// What plugins may know of a drive besides their own input (core/drive/drive_context.hpp).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Owns what a DriveContext shows. Coarse drives and graphs of one drive share it.
class DriveSurroundings {
 public:
  /// @param fixes of the drive, with the verdict of the gate
  DriveSurroundings(const PreparedDrive& drive, std::vector<Fix> fixes);
  DriveSurroundings(const DriveSurroundings&) = delete;
  DriveSurroundings& operator=(const DriveSurroundings&) = delete;

  [[nodiscard]] const DriveContext& context() const { return context_; }

 private:
  void add_odometry(const std::string& name, std::span<const OdometrySample> samples);
  void add_receivers(const PreparedDrive& drive);
  void add_sensors(const PreparedDrive& drive);

  std::vector<std::vector<OdometrySample>> odometry_;  ///< of each relative source
  std::vector<std::vector<Fix>> fixes_;                ///< of each receiver
  std::vector<SensorTable> readings_;                  ///< of each further sensor
  std::vector<DriveSource> sources_;
  std::optional<Projection> projection_;
  DriveContext context_;
};

/// Returns the context that surroundings show; null: none.
[[nodiscard]] const DriveContext& context_of(const std::shared_ptr<const DriveSurroundings>& surroundings);

}  // namespace waymark::drive

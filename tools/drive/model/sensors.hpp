/// The further sensors of a drive and their models.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// The models of the sensors. Errors of a model get the place of its sensor in the drive.yaml.
class SensorModels {
 public:
  /// @throws UsageError for an unknown sensor or option
  SensorModels(std::span<const PreparedSensor> sensors, const TypeRegistry& registry);

  /// Judges a whole drive. @param fixes accepted ones @throws InputError from a model
  void check_drive(std::span<const PreparedSensor> sensors, std::span<const Fix> fixes) const;

  /// Calls the model of one sensor to add its vertices and edges.
  /// @param index of the sensor in the constructor's list
  /// @param sensor the same one, with its next readings
  /// @param fixes the next accepted ones
  /// @param antenna_m of the first receiver, in the body frame
  /// @param grid_scale at the last fix before these
  /// @throws InputError from the model
  void extend(std::size_t index, const PreparedSensor& sensor, const DriveNodes& nodes,
              std::span<const Fix> fixes, const Eigen::Vector2d& antenna_m, double grid_scale, Graph& graph);

 private:
  std::vector<std::unique_ptr<SensorModel>> models_;
};

/// Returns a warning for each sensor without a reading within the drive.
[[nodiscard]] std::vector<std::string> warnings_of_sensors_apart(std::span<const PreparedSensor> sensors,
                                                                 const DriveNodes& nodes);

}  // namespace waymark::drive

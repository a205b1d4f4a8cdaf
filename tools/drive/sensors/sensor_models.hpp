/// The further sensors of a drive and their models.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// The models of the sensors. Errors of a model get the place of its sensor in the drive.yaml.
class SensorModels {
 public:
  /// @param settings from decided(), with the estimated noise
  /// @throws UsageError for an unknown sensor, option or loss
  SensorModels(std::span<const PreparedSensor> sensors, const FusionSettings& settings,
               const TypeRegistry& registry);

  /// Judges a whole drive. @param fixes accepted ones @throws InputError from a model
  void check_drive(std::span<const PreparedSensor> sensors, std::span<const Fix> fixes) const;

  /// Calls the model of one sensor to add its vertices and edges.
  /// @param index of the sensor in the constructor's list
  /// @param place of the sensor in the drive.yaml
  /// @throws InputError from the model
  void extend(std::size_t index, const std::string& place, const SensorInput& input, Graph& graph);

  /// Returns the loss of its measurements, if they have one.
  [[nodiscard]] const std::optional<Loss>& loss(std::size_t index) const { return models_[index].loss; }

 private:
  struct Model {
    std::string name;
    std::unique_ptr<SensorModel> model;
    std::optional<Loss> loss;
  };
  std::vector<Model> models_;
};

/// Returns the options of a sensor: its own, and those that are estimated for its source.
[[nodiscard]] Options options_of(const PreparedSensor& sensor, const FusionSettings& settings);

/// Returns a warning for each sensor without a reading within the drive.
[[nodiscard]] std::vector<std::string> warnings_of_sensors_apart(std::span<const PreparedSensor> sensors,
                                                                 const DriveNodes& nodes);

}  // namespace waymark::drive

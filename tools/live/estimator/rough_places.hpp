/// Where the readings of sensors place a vehicle that has no receiver of positions.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/live/estimator/intake.hpp>

namespace waymark::live {

class RoughPlaces {
 public:
  /// Drives with a receiver need none. @param registry must outlive the object
  RoughPlaces(const drive::DriveDescription& description, const TypeRegistry& registry);

  /// Tells whether there is a sensor that may place the vehicle.
  [[nodiscard]] bool any() const { return !has_receiver_ && !sensors_.empty(); }
  /// Returns why a reading cannot be, by its sensor; empty if it may be. A graph must not meet it.
  [[nodiscard]] std::string error_of(const SensorReading& reading) const;
  void take(const SensorReading& reading);
  /// Returns the positions by readings before a moment (SensorModel::rough_positions), in order of time.
  /// Each reading counts once.
  [[nodiscard]] std::vector<RoughPosition> before(Stamp moment);

 private:
  struct Sensor {
    std::size_t index = 0;  ///< in DriveDescription::sensors
    std::unique_ptr<SensorModel> model;
    SensorTable waiting{};
  };

  bool has_receiver_;
  std::vector<Sensor> sensors_;
};

}  // namespace waymark::live

#include <waymark/tools/drive/model/model.hpp>

#include <utility>

namespace waymark::drive {

DriveConfig config_for(const GnssModelingType& modeling, DriveConfig config) {
  if (!config.gate_stated) config.gate.enabled = !modeling.complete;
  if (!config.calibration_stated) {
    config.calibration.clear();
    if (modeling.complete) config.calibration = default_calibration();
  }
  if (!config.estimates_noise) config.estimates_noise = modeling.complete;
  return config;
}

Options options_for(const GnssModelingType& modeling, const DriveConfig& config, const Options& given) {
  Options all = config.modeling == modeling.name ? config.modeling_options : Options();
  for (const auto& [name, value] : given) all[name] = value;
  return with_calibration(std::move(all), config, modeling.options);
}

ModeledDrive model_drive(const PreparedDrive& drive, const DriveConfig& given, const std::string& modeling,
                         const Options& options, const TypeRegistry& registry,
                         const std::optional<Loss>& loss) {
  const GnssModelingType& type = registry.gnss_modeling(modeling);
  ModeledDrive modeled;
  modeled.modeling = modeling;
  DriveConfig& config = modeled.config = config_for(type, given);
  modeled.options = options_for(type, config, options);

  const PlacedDrive placed = place_drive(drive, config, registry);
  if (*config.estimates_noise) {
    modeled.noise =
        estimate_noise(placed, config, modeling, modeled.options, registry, drive.antenna_m, loss);
    config.odometry_options = with_noise(config.odometry_options, modeled.noise, config.odometry_model);
    modeled.options = with_noise(modeled.options, modeled.noise, modeling);
  }
  DriveSkeleton skeleton = build_skeleton(placed, drive, config, registry);
  modeled.document = add_modeling(skeleton, modeling, modeled.options, registry, loss);
  modeled.gate = std::move(skeleton.gate);
  modeled.start = std::move(skeleton.start);
  modeled.warnings = std::move(skeleton.warnings);
  modeled.distance_m = skeleton.distance_m;
  return modeled;
}

}  // namespace waymark::drive

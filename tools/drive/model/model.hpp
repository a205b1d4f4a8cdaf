/// A drive under one error model: what a GNSS modeling brings along, the estimated noise, the graph.
#pragma once

#include <optional>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/model/assemble.hpp>
#include <waymark/tools/drive/model/noise.hpp>

namespace waymark::drive {

/// The drive.yaml, and where it is silent what belongs to the modeling: for a complete error model
/// (GnssModelingType::complete) no gate, all calibration states, noise estimated; else the gate, none of the
/// states, noise as stated.
[[nodiscard]] DriveConfig config_for(const GnssModelingType& modeling, DriveConfig config);

/// The options of a modeling: those given, over the drive.yaml's where that names it, and the calibration
/// states that it knows.
[[nodiscard]] Options options_for(const GnssModelingType& modeling, const DriveConfig& config,
                                  const Options& given);

/// A drive as one modeling sees it.
struct ModeledDrive {
  std::string modeling;
  DriveConfig config;  ///< as config_for gives it
  Options options;     ///< of the modeling: stated, of the calibration, estimated
  GateSummary gate;
  Start start;
  std::vector<std::string> warnings;
  double distance_m = 0;            ///< driven, by the odometry
  NoiseEstimate noise;              ///< no parameters where it is as stated
  formats::GraphDocument document;  ///< at the start
};

/// Places the nodes, estimates the noise and builds the graph.
/// @param options  stated for the modeling, over those of the drive.yaml where that names it
/// @param loss     of the fixes
/// @throws what the steps throw
[[nodiscard]] ModeledDrive model_drive(const PreparedDrive& drive, const DriveConfig& config,
                                       const std::string& modeling, const Options& options,
                                       const TypeRegistry& registry,
                                       const std::optional<Loss>& loss = std::nullopt);

}  // namespace waymark::drive

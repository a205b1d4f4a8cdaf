/// What a drive.yaml says. Every member has its default; `load_drive_config` checks all of it before any log
/// is read.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/drive/logs/odometry_parts.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

/// One log of a stream: which reader, which file, how to read it.
struct LogConfig {
  std::string file;  ///< as resolved against the folder of the logs
  std::string format =
      "csv";           ///< name of a registered log reader; "auto": the one that knows the log's content
  LogRequest request;  ///< without the text of companions
  std::map<std::string, std::string> companions;  ///< files that belong to the log, resolved, by key ("dbc")
  std::string place;                              ///< "drive.yaml:12:5: " of the entry, for messages
};

/// The log of a receiver, and the one that holds its velocity where that is another.
struct GnssConfig : LogConfig {
  std::optional<LogConfig> velocity;
};

/// A further sensor of the vehicle.
struct SensorConfig {
  std::string name;              ///< of a registered sensor model
  std::optional<LogConfig> log;  ///< where it has one
  std::map<std::string, std::string> options;
  std::string place;  ///< "drive.yaml:12:5: " of the entry, for messages
};

/// Artificial outages: of every `every_s` seconds after the first fix the last `length_s` have no fix.
struct OutagePattern {
  double length_s = 0;  ///< 0: none
  double every_s = 0;   ///< above length_s
};

/// A drive to be fused.
struct DriveConfig {
  std::string path;                 ///< of the drive.yaml itself
  std::string name;                 ///< default: the file's name without ".yaml"
  std::string folder;               ///< where relative log names are looked up
  std::vector<LogConfig> odometry;  ///< one, or the parts that odometry is put together from
  OdometryAssembly assembly;
  double speed_delay_s = 0;  ///< how late the odometry's speed is stamped; subtracted
  double yaw_rate_delay_s = 0;
  std::vector<GnssConfig> gnss;  ///< at least one
  std::optional<LogConfig> truth;
  std::vector<SensorConfig> sensors;
  std::vector<std::string> plugins;  ///< modules to load, resolved against the drive.yaml's own folder

  TimeScale time_scale = TimeScale::gps;  ///< the drive's own scale; logs on others are converted
  bool time_scale_stated = false;         ///< where it is not, what is assumed is told
  std::optional<int> utm_zone;            ///< signed: negative is south; default: zone of the first good fix
  std::optional<Eigen::Vector2d>
      utm_origin;                   ///< easting, northing of the local origin; default: near the first fix
  Eigen::Vector2d antenna_m{0, 0};  ///< GNSS antenna in the body frame (x forward, y left)
  Eigen::Vector2d truth_reference_m{0, 0};  ///< truth reference point in the body frame
  double gnss_period_s = 0;                 ///< thin fixes to one per period (0: keep all)
  double gnss_delay_s = 0;                  ///< subtracted from fix stamps: how late the receiver stamps
  int withhold_every = 0;                   ///< every n-th fix is kept out of the graph (0: none)
  OutagePattern outage;                     ///< fixes in it are kept out of the graph too
  std::optional<double> from_s;             ///< seconds after the drive's first stamp
  std::optional<double> to_s;

  TimelineOptions timeline;
  GateOptions gate;
  StartOptions start;
  std::string modeling = "correlated";  ///< registered GNSS modeling
  std::map<std::string, std::string> modeling_options;
  std::string loss;  ///< of the fixes, "cauchy:1": a registered loss and its scale; empty: none
  std::string odometry_model = "constant_twist";        ///< registered odometry model
  std::map<std::string, std::string> odometry_options;  ///< of the odometry model, checked by its plugin
  /// States to estimate with the poses: options that go to the odometry model or the GNSS modeling, whichever
  /// has them.
  std::map<std::string, std::string> calibration;
  bool calibration_stated = false;      ///< where it is not, the modeling decides, as for the next two
  bool gate_stated = false;             ///< whether the gate is to run
  std::optional<bool> estimates_noise;  ///< options with a prior, from the drive itself (noise.hpp)
  /// "drive.yaml:12:5: " of what only a plugin can check: "modeling", "modeling.options.NAME",
  /// "modeling.loss", "odometry.model", "odometry.options.NAME", "calibration.NAME".
  std::map<std::string, std::string> places;
};

/// A drive is known by its name, .yaml or .yml: a graph or truth file never has it, whatever its format.
[[nodiscard]] bool is_drive_file(std::string_view path);
/// Whether a plugin is named by its file; a word without folder and ending is looked up by whoever loads it.
[[nodiscard]] bool is_plugin_file(std::string_view plugin);

/// What `calibration: on` stands for: all states that the built-in plugins know.
[[nodiscard]] std::map<std::string, std::string> default_calibration();

/// Reads and checks a drive.yaml (keys: tools/drive/DRIVE_YAML.md). Logs are not opened.
/// @param data_folder  where relative log names are looked up, instead of the file's own `folder` (empty:
/// that one)
/// @throws InputError "drive.yaml:12:5: unknown key 'colums'; did you mean 'columns'?" and the like.
[[nodiscard]] DriveConfig load_drive_config(const std::string& path, const std::string& data_folder = "");

/// The same from text. @param path  the file's name, for messages and as the anchor of relative folders
[[nodiscard]] DriveConfig parse_drive_config(const std::string& text, const std::string& path,
                                             const std::string& data_folder = "");

}  // namespace waymark::drive

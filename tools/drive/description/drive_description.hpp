/// The logs of a drive, and their place in time and space: everything that is known before the
/// fusion. fusion_settings.hpp defines how the drive is fused.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/tools/drive/logs/memory_log.hpp>
#include <waymark/tools/drive/logs/parts/odometry_parts.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

/// One log of a stream: its reader, its file, and how it is read.
struct LogConfig {
  std::string file;  ///< resolved against the folder of the logs
  /// name of a registered log reader; "auto": the reader that recognises the content of the log
  std::string format = "auto";
  LogRequest request;  ///< without the text of companion files
  /// files that belong to the log, resolved, by key ("dbc")
  std::map<std::string, std::vector<std::string>> companions;
  std::string place;  ///< "drive.yaml:12:5: " of the entry, for messages
  /// The log itself, which is then not read: `file` is its name for messages, and `format` means nothing.
  std::shared_ptr<const MemoryLog> samples{};
};

/// A place of a log at which the stamps rise or fall by more than they usually do.
struct StampStep {
  std::size_t row = 0;  ///< the first one behind it, in the order of the log
  Stamp before;         ///< of the row above it
  double by_s = 0;      ///< the stamp of the row less what it would be after a usual interval
};

/// A relative source: the logs of speed and yaw rate.
struct OdometryConfig {
  std::string name = "odometry";  ///< of the source
  std::vector<LogConfig> logs;    ///< one, or the parts that odometry is assembled from
  OdometryAssembly assembly;
  double speed_delay_s = 0;  ///< how late the stamps of the speed are; subtracted
  double yaw_rate_delay_s = 0;
  std::string delay_place{};  ///< "drive.yaml:12:5: " of a stated delay, for messages
  bool gives_nodes = false;   ///< stated: the nodes of the graph are at its stamps
  /// at which the clock of its only log was set (clock_steps.hpp): found, and taken back
  std::vector<StampStep> clock_steps{};
};

/// An absolute source: the log of its positions, and the log of its velocity if that is another one.
struct GnssConfig : LogConfig {
  std::optional<LogConfig> velocity{};
  std::string name = "gnss";        ///< of the source
  Eigen::Vector2d antenna_m{0, 0};  ///< body frame (x forward, y left)
  bool antenna_is_stated = false;   ///< be it at zero
  double delay_s = 0;               ///< how late its stamps are; subtracted
  std::string delay_place{};        ///< "drive.yaml:12:5: " of a stated delay, for messages
  /// time of its filter (ReceiverFilter), s; 0: it does not smooth; empty: not known
  std::optional<double> smoothing_s{};
  double period_s = 0;     ///< its fixes are thinned to one per period (0: keep all)
  int withhold_every = 0;  ///< every n-th of its fixes is left out of the graph (0: none)
  bool withheld = false;   ///< all of its fixes are left out of the graph
};

/// A further sensor of the vehicle.
struct SensorConfig {
  std::string name;              ///< of a registered sensor model
  std::optional<LogConfig> log;  ///< empty: the sensor has no log
  Options options;
  std::string place;        ///< "drive.yaml:12:5: " of the entry, for messages
  std::string source = {};  ///< name of the source, if one is stated

  /// Returns the name of the source; that of the sensor model if none is stated.
  [[nodiscard]] const std::string& source_name() const { return source.empty() ? name : source; }
};

/// The pose of the body point at the first node, as it is stated.
struct StatedPose {
  std::optional<GeodeticPoint> place{};         ///< if it is stated as such
  std::optional<Eigen::Vector2d> position_m{};  ///< in the frame
  std::optional<double> heading_rad{};          ///< counter-clockwise from true east
  double sigma_m = 1;                           ///< per axis
  double sigma_rad = 0.1;
};

/// Artificial outages. Time after the first fix is divided into periods of `every_s` seconds; the
/// last `length_s` of each have no fixes.
struct OutagePattern {
  double length_s = 0;  ///< 0: none
  double every_s = 0;   ///< above length_s
};

/// The logs of a drive, their clocks, the frame, and the places of the sensors on the vehicle.
struct DriveDescription {
  std::string path;                      ///< of the drive.yaml, for messages; may be empty
  std::string name;                      ///< default: name of the file without ".yaml"
  std::string environment;               ///< a word that groups drives of a fleet: urban; may be empty
  std::string folder;                    ///< the folder for relative names of logs
  std::vector<OdometryConfig> odometry;  ///< relative sources, at least one
  std::vector<GnssConfig> gnss;          ///< absolute sources; none: further sensors say where it is
  std::optional<LogConfig> truth;
  std::vector<SensorConfig> sensors;
  std::optional<StatedPose> first_pose;
  /// modules to load, resolved against the folder of the drive.yaml
  std::vector<std::string> plugins;

  /// scale of the drive; logs on others are converted. Empty: gps is assumed
  std::optional<TimeScale> time_scale;
  std::optional<double> from_s;  ///< seconds after the first stamp of the drive
  std::optional<double> to_s;
  TimelineOptions timeline;  ///< how samples become nodes in time
  /// false: timeline.gap_s grows with the usual interval of the odometry
  bool states_gap = false;

  std::optional<int> utm_zone;  ///< signed: negative is south; empty: zone of the first good fix
  /// easting, northing of the local origin; empty: near the first fix
  std::optional<Eigen::Vector2d> utm_origin;
  Eigen::Vector2d truth_reference_m{0, 0};  ///< reference point of the truth in the body frame

  OutagePattern outage;  ///< fixes in it are left out of the graph, for evaluation

  [[nodiscard]] TimeScale scale() const { return time_scale.value_or(TimeScale::gps); }
  /// States a frame that is known; one without a zone says nothing.
  void state_frame(const Frame& frame) {
    if (frame.zone == 0) return;
    utm_zone = frame.north ? frame.zone : -frame.zone;
    utm_origin = Eigen::Vector2d(frame.origin_easting_m, frame.origin_northing_m);
  }
};

}  // namespace waymark::drive

/// From logs to one drive on one clock: sorted, cleaned, projected, and a report of everything that was done.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>

namespace waymark::drive {

/// Where a stream says nothing for longer than it should.
struct GapReport {
  Stamp start;  ///< last sample before the gap
  double length_s = 0;
};

/// What became of the records of one stream. used = read - non_finite - duplicates - what the rules for fixes
/// take.
struct StreamReport {
  std::size_t records = 0;       ///< in the logs
  std::size_t corrupt = 0;       ///< of them unusable, see PrepareReport::corrupt_examples
  std::size_t read = 0;          ///< samples delivered by the readers
  std::size_t non_finite = 0;    ///< dropped: a number that is no number
  std::size_t out_of_order = 0;  ///< stamped before their predecessor in the log; sorted in, not dropped
  std::size_t duplicates_identical = 0;  ///< dropped: stamp and content of a sample before it
  std::size_t duplicates_conflicting =
      0;  ///< dropped: stamp of a sample before it, other content; the first is kept
  std::size_t used = 0;
  double median_interval_s = 0;
  std::vector<GapReport> gaps;  ///< odometry: above timeline.gap_s; others: above 2.5 median intervals
};

/// What the messages of a log say of the clock that stamped them.
struct ClockReport {
  std::string file;
  std::size_t messages = 0;
  double ahead_s = 0;   ///< median of stamp minus the time told; positive: the stamps are ahead
  double spread_s = 0;  ///< median absolute deviation from it
};

struct PrepareReport {
  StreamReport odometry;
  StreamReport gnss;
  StreamReport truth;
  StreamReport sensor;        ///< of all further sensors: records and corrupt ones
  std::size_t reversing = 0;  ///< odometry samples with negative speed: no error
  std::size_t odometry_outside_window = 0;
  std::size_t fixes_outside_odometry =
      0;                            ///< dropped: before the first or after the last odometry sample used
  std::size_t fixes_thinned = 0;    ///< dropped: not the nearest to a multiple of gnss_period_s
  std::size_t fixes_withheld = 0;   ///< kept, but out of the graph
  std::vector<ClockReport> clocks;  ///< of logs that hold their own stamps and GNSS time
  std::vector<std::string> notes;   ///< the readers' assumptions and what was concluded here, in sentences
  std::vector<std::string> corrupt_examples;
};

/// The readings of a further sensor.
struct PreparedSensor {
  std::string name;        ///< of a registered sensor model
  Options options{};       ///< of the model
  std::string place{};     ///< of its entry in the drive.yaml, for messages
  SensorTable readings{};  ///< empty for a sensor without a log
};

/// A file that a drive was read from.
struct InputFile {
  std::string path;
  std::string fingerprint;  ///< of its content, which is the same compressed or not: "fnv1a64:" and 16 digits
};

/// A drive in its frame on its clock. Every stream is sorted by stamp.
struct PreparedDrive {
  std::string name;
  Frame frame;
  TimeScale scale = TimeScale::gps;
  std::vector<OdometrySample> odometry;     ///< stamps unique; at least 2
  std::vector<Fix> fixes;                   ///< stamp and source unique; at least 1; `epoch` counts from 0
  std::vector<TruthPose> truth;             ///< stamps unique; may be empty
  std::vector<PreparedSensor> sensors;      ///< as DriveDescription::sensors
  Eigen::Vector2d antenna_m{0, 0};          ///< body frame
  Eigen::Vector2d truth_reference_m{0, 0};  ///< body frame
  TimelineOptions timeline;                 ///< how samples become nodes
  std::vector<InputFile> inputs;  ///< in the order of the description, each log before its companions
  PrepareReport report;
};

/// The logs of a drive as read: one entry per file, stamps on the scale of its request.
struct DriveLogs {
  struct Log {
    LogData data;
    TimeScale scale = TimeScale::gps;
    std::string file;                 ///< for messages
    std::vector<InputFile> inputs{};  ///< the log and the companions that the description names
  };
  std::vector<Log> odometry;  ///< in the order of DriveDescription::odometry
  std::vector<Log> gnss;      ///< in the order of DriveDescription::gnss
  std::vector<Log> velocity;  ///< as gnss; readings as velocity_channels(), nothing in it where there is none
  std::vector<Log> truth;     ///< none or one
  std::vector<Log> sensors;   ///< as DriveDescription::sensors; nothing in it for one without a log
  std::vector<std::string> notes;  ///< what was done to all of them (synchronise.hpp)
};

/// Puts logs onto one clock and into one frame. Pure.
///
/// In this order: scales are converted; non-finite samples dropped; each stream sorted (stable) and
/// duplicates of a stamp dropped (fixes: stamp and source; the first in the log is kept); gnss_delay_s
/// subtracted; the odometry cut to [from_s, to_s] after its first stamp; fixes outside the odometry's span
/// dropped; fixes thinned per source to the one nearest to each whole multiple of gnss_period_s on the
/// drive's scale (the earlier of two equally near); epochs numbered; epochs n-1, 2n-1, ... withheld for
/// withhold_every = n (one epoch: fixes of one stamp), and those in an outage; all projected.
/// @throws InputError with the remedy for: fewer than two odometry samples, no fix, no fix within the
/// odometry's span, truth that does not overlap the odometry, a log of seconds of week that would need a
/// date.
[[nodiscard]] PreparedDrive prepare_drive(const DriveLogs& logs, const DriveDescription& description);

/// A log of truth on the drive's clock and in a frame that is given: cleaned as in a drive. Pure.
[[nodiscard]] std::vector<TruthPose> prepare_truth(const DriveLogs::Log& log, TimeScale scale,
                                                   const Frame& frame);

/// Told while a log is read: its file, bytes done and in all (0: not known). May throw to stop.
using LogWatch = std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)>;

/// Reads the logs that a description names, each once.
/// @throws InputError for an unknown format, a missing file, an unusable log.
[[nodiscard]] DriveLogs read_drive_logs(const DriveDescription& description, const TypeRegistry& registry,
                                        const LogWatch& watch = {});

/// resolve_sensors (sensor_logs.hpp), read_drive_logs and prepare_drive.
[[nodiscard]] PreparedDrive load_drive(DriveDescription description, const TypeRegistry& registry,
                                       const LogWatch& watch = {});

/// The truth alone of a description, in a frame that is given: no other log is read.
/// @throws InputError for a description without truth, an unusable log
[[nodiscard]] std::vector<TruthPose> load_truth(const DriveDescription& description, const Frame& frame,
                                                const TypeRegistry& registry, const LogWatch& watch = {});

}  // namespace waymark::drive

/// Turns logs into one drive on one clock: sorted, cleaned and projected, with a report
/// of every step.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::drive {

/// A time in which a stream has no samples for longer than usual.
struct GapReport {
  Stamp start;  ///< last sample before the gap
  double length_s = 0;
};

/// What happened to the records of one stream. used = read - non_finite - duplicates - those that
/// the rules for fixes remove.
struct StreamReport {
  std::size_t records = 0;     ///< in the logs
  std::size_t corrupt = 0;     ///< unusable ones, see PrepareReport::corrupt_examples
  std::size_t read = 0;        ///< samples delivered by the readers
  std::size_t non_finite = 0;  ///< dropped: some number is not finite
  /// stamped before their predecessor in the log; sorted, not dropped
  std::size_t out_of_order = 0;
  std::size_t duplicates_identical = 0;  ///< dropped: same stamp and content as an earlier sample
  std::size_t duplicates_conflicting =
      0;  ///< dropped: same stamp as an earlier sample, other content; the first one is kept
  std::size_t used = 0;
  double median_interval_s = 0;
  /// odometry: above PreparedDrive::timeline.gap_s; others: above 2.5 median intervals
  std::vector<GapReport> gaps;
};

/// What the messages of a log reveal about the clock of its stamps.
struct ClockReport {
  std::string file;
  std::size_t messages = 0;
  double ahead_s = 0;   ///< median of stamp minus GNSS time; positive: the stamps are ahead
  double spread_s = 0;  ///< median absolute deviation from it
};

/// What an odometry measures.
enum class OdometryQuantity { speed, yaw_rate };

/// Readings that were late alone, and were moved to earlier stamps.
struct MovedQuantity {
  OdometryQuantity kind = OdometryQuantity::speed;
  double earlier_s = 0;
  double sigma_s = 0;  ///< of that; delays of the fixes are not known better
};

/// A warning that the clock of the odometry seems wrong. The fusion takes it back if it finds why.
struct ToldClock {
  std::string warning;
  double late_s = 0;
};

struct PrepareReport {
  StreamReport odometry;
  StreamReport gnss;
  StreamReport truth;
  StreamReport sensor;        ///< of all further sensors: records and corrupt ones
  std::size_t reversing = 0;  ///< odometry samples with negative speed; this is no error
  std::size_t odometry_outside_window = 0;
  /// dropped: before the first or after the last used odometry sample
  std::size_t fixes_outside_odometry = 0;
  /// dropped: another fix was nearer to a multiple of gnss_period_s
  std::size_t fixes_thinned = 0;
  std::size_t fixes_withheld = 0;   ///< kept, but left out of the graph
  std::vector<ClockReport> clocks;  ///< for logs with their own stamps and GNSS time
  /// the assumptions of the readers and conclusions of this step, in sentences
  std::vector<std::string> notes;
  /// sentences about readings that contradict each other
  std::vector<std::string> warnings;
  std::vector<StampStep> stamp_steps{};   ///< of the odometry, if it is the only one and of one log
  std::optional<ToldClock> told_clock{};  ///< the warning of which is among them
  /// of odometries whose yaw rates no vehicle has, as if deg/s were read as rad/s: what to state, by name
  std::map<std::string, std::string> impossible_turns{};
  std::set<std::string> left_out;  ///< names of odometries that the fixes contradict
  /// a warning says that one of speed and yaw rate is late, and nothing was moved: no offset of all stamps is right
  bool tells_late_quantity = false;
  /// the one of them whose readings were moved instead
  std::optional<MovedQuantity> moved_quantity{};
  std::vector<std::string> corrupt_examples;
};

/// The readings of a further sensor.
struct PreparedSensor {
  std::string name;        ///< of a registered sensor model
  Options options{};       ///< of the model
  std::string place{};     ///< of its entry in the drive.yaml, for messages
  SensorTable readings{};  ///< empty for a sensor without a log
  std::string source{};    ///< name of the source
  /// where it places the vehicle (SensorModel::rough_positions), sorted; in the frame. For the initial
  /// guess alone, and only without receivers
  std::vector<Fix> rough{};
};

/// A relative source: its own samples, on the clock of the drive.
struct PreparedOdometry {
  std::string name;
  std::vector<OdometrySample> samples;  ///< stamps unique
  double gap_s = 0;                     ///< it is silent between samples that are further apart
  YawRateAtRest yaw_rate_at_rest{};
};

/// An absolute source: Fix::source is its index.
struct PreparedReceiver {
  std::string name;
  Eigen::Vector2d antenna_m{0, 0};  ///< body frame
  bool antenna_is_stated = false;
  bool delay_is_stated = false;  ///< which was subtracted
  /// time of its filter (ReceiverFilter), s; 0: it does not smooth; empty: not known
  std::optional<double> smoothing_s{};
};

/// The pose of the body point at the first node, as it is stated; in the frame.
struct FirstPose {
  std::optional<Eigen::Vector2d> position;
  std::optional<double> heading_rad;  ///< counter-clockwise from grid east
  double sigma_m = 1;                 ///< per axis
  double sigma_rad = 0.1;
};

/// A file that a drive was read from.
struct InputFile {
  std::string path;
  /// fingerprint of its uncompressed content: "fnv1a64:" and 16 digits
  std::string fingerprint;
};

/// A drive in its frame on its clock. Every stream is sorted by stamp.
struct PreparedDrive {
  std::string name;
  std::string environment{};  ///< as the drive.yaml states it
  Frame frame;
  TimeScale scale = TimeScale::gps;
  /// The samples that nodes come from: those of one relative source, and those of others while it is
  /// silent. Stamps unique; at least 2.
  std::vector<OdometrySample> odometry;
  std::string odometry_name = "odometry";     ///< the relative source that nodes come from
  YawRateAtRest yaw_rate_at_rest;             ///< of it
  std::vector<PreparedOdometry> relative{};   ///< all relative sources if there are several; else empty
  std::vector<PreparedReceiver> receivers{};  ///< absolute sources
  /// stamp and source are unique together; at least 1 if there are receivers; `epoch` counts from 0
  std::vector<Fix> fixes;
  std::vector<TruthPose> truth;             ///< stamps unique; may be empty
  std::vector<PreparedSensor> sensors;      ///< as DriveDescription::sensors
  Eigen::Vector2d truth_reference_m{0, 0};  ///< body frame
  Vehicle vehicle{};                        ///< as stated for the first relative source
  std::optional<FirstPose> first_pose{};    ///< as stated
  TimelineOptions timeline;                 ///< how samples become nodes
  /// in the order of the description, each log before its companions
  std::vector<InputFile> inputs;
  PrepareReport report;
};

/// The logs of a drive as they were read: one entry per file, stamps on the scale of its request.
struct DriveLogs {
  struct Log {
    LogData data;
    TimeScale scale = TimeScale::gps;
    std::string file;                 ///< for messages
    std::vector<InputFile> inputs{};  ///< the log and the companions that the description names
    /// where the readings of a sensor place the vehicle, if the drive has no receiver
    std::vector<RoughPosition> rough{};
  };
  /// in the order of DriveDescription::odometry, and of the logs of each
  std::vector<std::vector<Log>> odometry;
  std::vector<Log> gnss;  ///< in the order of DriveDescription::gnss
  /// in the order of gnss; readings as in velocity_channels(), empty if there are none
  std::vector<Log> velocity;
  std::vector<Log> truth;  ///< none or one
  /// in the order of DriveDescription::sensors; empty for one without a log
  std::vector<Log> sensors;
  std::vector<std::string> notes;  ///< steps that concern all logs (synchronise.hpp)
  /// of sources that are left out because their logs hold nothing
  std::vector<std::string> warnings{};
};

/// Puts logs on one clock and into one frame. This is a pure function.
///
/// The steps, in this order:
/// 1. Scales are converted, and non-finite samples are dropped.
/// 2. Each stream is sorted (stable), and duplicates of a stamp are dropped. For fixes, stamp and
///    source count, and the first one in the log is kept.
/// 3. The delay of each receiver is subtracted.
/// 4. The odometry is cut to [from_s, to_s] after its first stamp. Where the source of the nodes is
///    silent, the samples of the next relative source that is not take its place. Fixes outside the
///    span of the odometry are dropped.
/// 5. Fixes are thinned per source to the one nearest to each whole multiple of its period on
///    the scale of the drive (the earlier of two equally near ones).
/// 6. Epochs are numbered; fixes with one stamp are one epoch. For withhold_every = n, the fixes n,
///    2n, ... of that receiver are withheld, and so are those in an outage and those of sources that are
///    withheld.
/// 7. Everything is projected.
/// 8. Odometry that is wrong is mended, or left out (mending/).
/// @throws InputError with the remedy for: fewer than two odometry samples, a receiver without a fix
/// within the span of the odometry, truth that does not overlap the odometry, and a log of seconds of week
/// that would need a date
[[nodiscard]] PreparedDrive prepare_drive(const DriveLogs& logs, const DriveDescription& description);

/// Converts a log of truth to the clock of the drive and to a given frame, with the same cleaning
/// as in a drive. This is a pure function.
[[nodiscard]] std::vector<TruthPose> prepare_truth(const DriveLogs::Log& log, TimeScale scale,
                                                   const Frame& frame);

/// Called while a log is read, with its file, bytes done and bytes in all (0: not known). It may
/// throw to stop.
using LogWatch = std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)>;

/// Reads each log of a description once.
/// @throws InputError for an unknown format, a missing file, or an unusable log
[[nodiscard]] DriveLogs read_drive_logs(const DriveDescription& description, const TypeRegistry& registry,
                                        const LogWatch& watch = {});

/// Calls resolve_sensors (sensor_logs.hpp), read_drive_logs and prepare_drive.
[[nodiscard]] PreparedDrive load_drive(DriveDescription description, const TypeRegistry& registry,
                                       const LogWatch& watch = {});

/// Reads only the truth of a description, in a given frame. No other log is read.
/// @throws InputError for a description without truth, and for an unusable log
[[nodiscard]] std::vector<TruthPose> load_truth(const DriveDescription& description, const Frame& frame,
                                                const TypeRegistry& registry, const LogWatch& watch = {});

}  // namespace waymark::drive

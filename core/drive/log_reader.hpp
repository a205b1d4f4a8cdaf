/// The interface of raw-log readers. A reader opens a decoder for one log. The decoder takes the
/// bytes of the log piece by piece and returns samples, so a log of any size needs little
/// memory. It never guesses silently: its assumptions go into `notes`, and it counts unusable
/// records in `corrupt`.
///
/// Ownership: a decoder belongs to the caller of open(), and so does data that is moved out of it.
/// Lifetime: a decoder may outlive its request, but not its reader. A piece given to take() is used
/// only during the call. Threads: a reader has no state, so any number of threads may use it; a
/// decoder may only be used by one thread at a time. Precondition: finish() is called once, after
/// the last take().
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace WAYMARK_EXPORT waymark {

/// The kind of samples that is requested from a log.
enum class StreamKind { odometry, gnss, truth, sensor };

/// The meaning of an accuracy figure of a log (see formats/logs/README.md). The reader resolves
/// `automatic` and notes the result.
enum class AccuracyMeaning {
  automatic,
  percent95,  ///< per-axis 95 % bound: sigma = a / 2 (the paper's rule)
  one_sigma,  ///< per-axis standard deviation
  drms,       ///< radial rms: sigma = a / sqrt(2)
  cep50       ///< radius of the 50 % circle: sigma = a / 1.1774
};

/// The place of a quantity in a table (or the signal that holds it), and its unit.
struct ColumnRequest {
  /// name in the header line, or 1-based number; for CAN frames SIGNAL or MESSAGE.SIGNAL
  std::string column;
  /// "km/h", "deg", ...; empty: the SI unit of the quantity (latitude, longitude: degrees)
  std::string unit;
  /// sense of an angle, e.g. "cw_from_north"; empty: the default of the quantity
  std::string convention;
  /// The number times this is the value in `unit` and `convention`: metres per radian of a wheel, frames per second.
  double scale = 1;
  /// A number that means "no value", as the log has it: before `scale` and `unit`.
  std::optional<double> missing{};
};

/// The rows of a table that belong to a stream: those whose column has a value, or has another one.
struct RowFilter {
  std::string column;  ///< name in the header line, or 1-based number
  std::string value;   ///< text of the field, without quotes
  bool equal = true;
};

/// The origin of a local plane of metres: east and north of it are along its tangent (ENU).
struct LocalOrigin {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;  ///< above the ellipsoid

  friend bool operator==(const LocalOrigin&, const LocalOrigin&) = default;
};

/// A file that belongs to a log and defines how it is read.
struct CompanionFile {
  std::string path;  ///< for messages
  std::string text;
};

/// Defines how one stream of one log is read.
struct LogRequest {
  StreamKind stream = StreamKind::gnss;
  /// by quantity (CSV, CAN); see formats/logs/README.md
  std::map<std::string, ColumnRequest> columns;
  /// The quantities of a sensor stream besides `time`. For the odometry stream of a log that holds
  /// odometry in parts, they are its sources (formats/logs/channels.hpp).
  std::vector<SensorColumn> readings;
  /// "dbc" for CAN frames (any number), "timestamps" for KITTI oxts (one)
  std::map<std::string, std::vector<CompanionFile>> companions;
  /// CSV field separator; ' ': any run of blanks and tabs; 0: found in the header and noted
  char separator = 0;
  AccuracyMeaning accuracy = AccuracyMeaning::automatic;
  double default_sigma_m = 0;  ///< per-axis sigma if the log gives none; 0: such a fix is corrupt
  double range_error_m =
      0;  ///< per-axis sigma = HDOP times this if the log gives only HDOP; 0: HDOP is not used
  /// scale of the stamps of the samples. It is that of the log, but stamps of a log that names
  /// its own scale (ISO 8601 dates are UTC) are converted
  TimeScale time_scale = TimeScale::gps;
  int gps_week = 0;  ///< added if the log counts seconds of week; 0: none
  /// UTC midnight before the first record, for logs that give only the time of day
  std::optional<Stamp> date;
  double time_offset_s = 0;  ///< added to every stamp of the log
  int source = 0;            ///< index of the receiver for all samples
  /// The frame of positions that a log gives in metres (`easting`, `northing`): they are its x
  /// and y. Empty: such a log cannot be read.
  std::optional<Frame> metric_frame;
  /// Per-axis sigma, m, of fixes of a quality whose log gives no accuracy. It comes before
  /// range_error_m and default_sigma_m.
  std::map<FixQuality, double> sigma_by_quality;
  /// of a table (CSV); other rows are not read
  std::optional<RowFilter> where;
  /// In place of metric_frame: `easting` and `northing` are metres east and north of this place, on its
  /// tangent plane.
  std::optional<LocalOrigin> local_origin;
  /// The samples are used before the log ends: what a reader concludes from the whole log otherwise, it concludes
  /// from the records so far.
  bool is_live = false;
};

/// One instant on two clocks: when the logger wrote a message, and the GNSS time in the message.
struct ClockPair {
  Stamp logged;  ///< on the clock of the logger, time_offset_s included
  Stamp told;    ///< on the request's time_scale
};

/// The result of a reader.
struct LogData {
  std::vector<OdometrySample> odometry;
  std::vector<GeodeticFix> fixes;
  std::vector<GeodeticTruth> truth;
  SensorTable readings;  ///< columns as in LogRequest::readings; NaN: not in this row
  /// for logs whose stamps are those of the logger and that also hold GNSS time
  std::vector<ClockPair> clocks;
  std::vector<std::string> notes;  ///< assumptions, one sentence each
  std::size_t records = 0;         ///< records that could hold a sample
  std::size_t without_fix = 0;     ///< those that the receiver marks as without a fix
  /// records that should hold a sample and are unusable
  std::size_t corrupt = 0;
  std::vector<std::string> corrupt_examples;  ///< the first few, "file:line:column: the error"
  /// number of messages of each kind: "GPRMC", "NAV-PVT"
  std::map<std::string, std::size_t> kinds;
  /// number of fixes of each quality
  std::map<FixQuality, std::size_t> qualities;
};

/// Decodes one log.
class LogDecoder {
 public:
  virtual ~LogDecoder() = default;
  /// Takes the next bytes of the log. A piece may end anywhere, also within a line or a frame.
  /// @throws InputError for errors that concern the whole log, such as a column that does not exist
  virtual void take(std::string_view piece) = 0;
  /// Call this after the last piece. It adds the samples that were held back, and the last notes.
  virtual void finish() = 0;
  /// The sender of a live stream pauses: a record that waits for its next part, as an epoch of NMEA for its
  /// next sentence, is complete. A decoder whose records are complete at once does nothing.
  virtual void pause() {}
  /// Returns the result so far. A caller with little memory takes the samples out between pieces;
  /// counts and notes stay.
  [[nodiscard]] LogData& data() { return data_; }

 protected:
  LogData data_;
};

/// How surely a reader recognises a log.
struct Recognition {
  double certainty = 0;  ///< 0 (not at all) .. 1 (beyond doubt)
  std::string evidence;  ///< "41 of 43 lines are NMEA sentences with a right checksum"
};

/// Reads one kind of log. Implementations have no state. A TypeRegistry registers them by name.
class LogReader {
 public:
  virtual ~LogReader() = default;
  /// @param path name of the log, for messages
  /// @throws InputError for a request that this kind of log cannot satisfy
  [[nodiscard]] virtual std::unique_ptr<LogDecoder> open(const std::string& path,
                                                         const LogRequest& request) const = 0;
  /// Recognises a log for `format: auto`. @param head the first bytes of the log (64 KiB, or all of
  /// a smaller one)
  [[nodiscard]] virtual Recognition recognise([[maybe_unused]] std::string_view head) const { return {}; }

  /// Reads a whole log at once.
  /// @throws InputError from the decoder, and if nothing in the log was usable
  [[nodiscard]] LogData read(std::string_view text, const std::string& path, const LogRequest& request) const;
};

/// The base of readers that need the whole text at once. It is for small logs.
class WholeLogReader : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const final;
  /// @param text the whole log (valid only during the call)
  /// @throws InputError if nothing in it was usable
  [[nodiscard]] virtual LogData read_whole(std::string_view text, const std::string& path,
                                           const LogRequest& request) const = 0;
};

/// A registered log reader.
struct LogReaderType {
  std::string name;         ///< the name for `format:` in a drive.yaml
  std::string description;  ///< one line
  /// without state; lives as long as the code that registered it
  const LogReader* reader = nullptr;
  /// The reader gives speed and yaw rate of one moment together unless channels are asked for. Otherwise odometry is
  /// read as channels (LogRequest::readings) and joined.
  bool whole_odometry = false;
};

/// At most this many corrupt records are described. All are counted.
inline constexpr std::size_t kCorruptExamples = 5;

/// Counts a corrupt record. The first few are kept as "path:line:column: what".
void add_corrupt(LogData& data, const std::string& path, std::size_t line, std::size_t column,
                 const std::string& what);

/// @throws InputError if there are no samples: "gnss.csv: the log holds no records", or
/// the first error
void require_samples(const LogData& data, const std::string& path);

}  // namespace waymark

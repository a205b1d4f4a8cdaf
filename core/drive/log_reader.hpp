/// The interface of raw-log readers. A reader opens a decoder for one log; the decoder takes the log's bytes
/// piece by piece, so that a log of any size passes through little memory, and leaves samples. It never
/// guesses silently: what it assumed goes into `notes`, what it could not use is counted in `corrupt`.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace waymark {

/// Which samples are wanted from a log.
enum class StreamKind { odometry, gnss, truth, sensor };

/// What the accuracy figure of a log means (see formats/logs/README.md). `automatic` is resolved by the
/// reader and noted.
enum class AccuracyMeaning {
  automatic,
  percent95,  ///< per-axis 95 % bound: sigma = a / 2 (the paper's rule)
  one_sigma,  ///< per-axis standard deviation
  drms,       ///< radial rms: sigma = a / sqrt(2)
  cep50       ///< radius of the 50 % circle: sigma = a / 1.1774
};

/// Where a quantity stands in a table (or which signal holds it) and in what unit.
struct ColumnRequest {
  std::string
      column;        ///< name in the header line, or 1-based number; of CAN frames: SIGNAL or MESSAGE.SIGNAL
  std::string unit;  ///< "km/h", "deg", ...; empty: the quantity's SI unit (latitude, longitude: degrees)
  std::string convention;  ///< sense of an angle, e.g. "cw_from_north"; empty: the quantity's default
};

/// A file that belongs to a log and says how to read it.
struct CompanionFile {
  std::string path;  ///< for messages
  std::string text;
};

/// How to read one stream of one log.
struct LogRequest {
  StreamKind stream = StreamKind::gnss;
  std::map<std::string, ColumnRequest> columns;  ///< by quantity (CSV, CAN); see formats/logs/README.md
  /// The quantities of a sensor stream, beside `time`. For the odometry stream: what odometry can be made of
  /// (formats/logs/channels.hpp), for readers whose log holds it in pieces.
  std::vector<SensorColumn> readings;
  std::map<std::string, CompanionFile> companions;  ///< "dbc": of CAN frames, "timestamps": of KITTI oxts
  char separator =
      0;  ///< CSV field separator; ' ': any run of blanks and tabs; 0: what the header shows, and noted
  AccuracyMeaning accuracy = AccuracyMeaning::automatic;
  double default_sigma_m = 0;  ///< per-axis sigma where the log gives none; 0: such a fix is corrupt
  double range_error_m =
      0;  ///< per-axis sigma = HDOP times this where the log gives HDOP only; 0: HDOP is not used
  TimeScale time_scale =
      TimeScale::gps;         ///< the scale of the samples' stamps: the log's own, except for logs
                              ///< that name theirs (ISO 8601 dates are UTC): those are converted
  int gps_week = 0;           ///< added where the log counts seconds of week; 0: none
  std::optional<Stamp> date;  ///< UTC midnight of the first record, for logs that give only the time of day
  double time_offset_s = 0;   ///< added to every stamp of the log
  int source = 0;             ///< index given to the samples' receiver
};

/// One instant on two clocks: when a logger wrote a message, and the GNSS time that the message tells.
struct ClockPair {
  Stamp logged;  ///< on the logger's clock, time_offset_s included
  Stamp told;    ///< on the request's time_scale
};

/// What a reader found.
struct LogData {
  std::vector<OdometrySample> odometry;
  std::vector<GeodeticFix> fixes;
  std::vector<GeodeticTruth> truth;
  SensorTable readings;            ///< columns as LogRequest::readings; NaN: not in this row
  std::vector<ClockPair> clocks;   ///< of logs that stamp by a logger's clock and hold GNSS time too
  std::vector<std::string> notes;  ///< assumptions made, one sentence each
  std::size_t records = 0;         ///< records that could have held a sample
  std::size_t without_fix = 0;     ///< of them, marked by the receiver as without a fix
  std::size_t corrupt = 0;         ///< records that should have held one and could not be used
  std::vector<std::string> corrupt_examples;  ///< the first few, "file:line:column: what was wrong"
  std::map<std::string, std::size_t>
      kinds;  ///< how many messages of each kind the log holds: "GPRMC", "NAV-PVT"
};

/// Takes one log.
class LogDecoder {
 public:
  virtual ~LogDecoder() = default;
  /// The next bytes of the log. Pieces may end anywhere, within a line or a frame.
  /// @throws InputError for what no record can mend, such as a column that does not exist
  virtual void take(std::string_view piece) = 0;
  /// After the last piece: adds what was held back, and the closing notes.
  virtual void finish() = 0;
  /// What was found so far. Whoever reads a log that does not fit into memory takes the samples out between
  /// pieces; counts and notes stay.
  [[nodiscard]] LogData& data() { return data_; }

 protected:
  LogData data_;
};

/// How surely a reader knows a log for its own.
struct Recognition {
  double certainty = 0;  ///< 0 (not at all) .. 1 (beyond doubt)
  std::string evidence;  ///< "41 of 43 lines are NMEA sentences with a right checksum"
};

/// Reads one kind of log. Implementations are stateless and registered by name in a TypeRegistry.
class LogReader {
 public:
  virtual ~LogReader() = default;
  /// @param path  the log's name, for messages
  /// @throws InputError for a request that this kind of log cannot meet
  [[nodiscard]] virtual std::unique_ptr<LogDecoder> open(const std::string& path,
                                                         const LogRequest& request) const = 0;
  /// For `format: auto`. @param head  the first bytes of a log (64 KiB, or all of a smaller one)
  [[nodiscard]] virtual Recognition recognise([[maybe_unused]] std::string_view head) const { return {}; }

  /// A whole log at once.
  /// @throws InputError what the decoder throws, and where nothing in the log was usable
  [[nodiscard]] LogData read(std::string_view text, const std::string& path, const LogRequest& request) const;
};

/// A reader of logs that are best read at once: it keeps all of the text. For small logs.
class WholeLogReader : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const final;
  /// @param text  the whole log (valid during the call only)
  /// @throws InputError when nothing in it was usable
  [[nodiscard]] virtual LogData read_whole(std::string_view text, const std::string& path,
                                           const LogRequest& request) const = 0;
};

/// A registered log reader.
struct LogReaderType {
  std::string name;                   ///< what `format:` of a drive.yaml says
  std::string description;            ///< one line
  const LogReader* reader = nullptr;  ///< stateless, lives as long as the code that registered it
};

/// So many corrupt records are described; all are counted.
inline constexpr std::size_t kCorruptExamples = 5;

/// Counts a corrupt record; the first few are kept as "path:line:column: what".
void add_corrupt(LogData& data, const std::string& path, std::size_t line, std::size_t column,
                 const std::string& what);

/// @throws InputError where no sample came out: "gnss.csv: the log holds no records", or the first complaint
/// repeated.
void require_samples(const LogData& data, const std::string& path);

}  // namespace waymark

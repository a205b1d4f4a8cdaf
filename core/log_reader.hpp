/// The interface of raw-log readers. A reader turns the text of one log into samples; it never guesses
/// silently: what it assumed goes into `notes`, what it could not use is counted in `corrupt`.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/sample.hpp>
#include <waymark/core/stamp.hpp>

namespace waymark {

/// Which samples are wanted from a log.
enum class StreamKind { odometry, gnss, truth, sensor };

/// What the accuracy figure of a log means (see formats/README.md). `automatic` is resolved by the reader and
/// noted.
enum class AccuracyMeaning {
  automatic,
  percent95,  ///< per-axis 95 % bound: sigma = a / 2 (the paper's rule)
  one_sigma,  ///< per-axis standard deviation
  drms,       ///< radial rms: sigma = a / sqrt(2)
  cep50       ///< radius of the 50 % circle: sigma = a / 1.1774
};

/// Where a quantity stands in a table and in what unit.
struct ColumnRequest {
  std::string column;  ///< name in the header line, or 1-based number
  std::string unit;    ///< "km/h", "deg", ...; empty: the quantity's SI unit (latitude, longitude: degrees)
  std::string convention;  ///< sense of an angle, e.g. "cw_from_north"; empty: the quantity's default
};

/// How to read one stream of one log.
struct LogRequest {
  StreamKind stream = StreamKind::gnss;
  std::map<std::string, ColumnRequest> columns;  ///< by quantity (CSV); see formats/csv_log.hpp
  std::vector<SensorColumn> readings;            ///< the quantities of a sensor stream, beside `time`
  char separator = ',';                          ///< CSV field separator; ' ': any run of blanks and tabs
  AccuracyMeaning accuracy = AccuracyMeaning::automatic;
  double default_sigma_m = 0;  ///< per-axis sigma where the log gives none; 0: such a fix is corrupt
  TimeScale time_scale =
      TimeScale::gps;        ///< the scale of the samples' stamps: the log's own, except for logs
                             ///< that name theirs (ISO 8601 dates are UTC): those are converted
  int gps_week = 0;          ///< added where the log counts seconds of week; 0: none
  double time_offset_s = 0;  ///< added to every stamp of the log
  int source = 0;            ///< index given to the samples' receiver
};

/// What a reader found.
struct LogData {
  std::vector<OdometrySample> odometry;
  std::vector<GeodeticFix> fixes;
  std::vector<GeodeticTruth> truth;
  SensorTable readings;                       ///< columns as LogRequest::readings
  std::vector<std::string> notes;             ///< assumptions made, one sentence each
  std::size_t records = 0;                    ///< records that could have held a sample
  std::size_t corrupt = 0;                    ///< records that should have held one and could not be used
  std::vector<std::string> corrupt_examples;  ///< the first few, "file:line:column: what was wrong"
};

/// Reads one kind of log. Implementations are stateless and registered by name in a TypeRegistry.
class LogReader {
 public:
  virtual ~LogReader() = default;
  /// @param text  the whole log (valid during the call only)
  /// @param path  its name, for messages
  /// @throws InputError when nothing in it was usable, or when a column the request names does not exist.
  [[nodiscard]] virtual LogData read(std::string_view text, const std::string& path,
                                     const LogRequest& request) const = 0;
};

}  // namespace waymark

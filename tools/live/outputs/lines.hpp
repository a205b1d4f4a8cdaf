/// Reports in the formats of others: lines of JSON, sentences of NMEA 0183, rows of CSV, MCAP.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/live/estimator/reports.hpp>

namespace waymark::live {

/// What a report needs to be read without the drive.
struct Surroundings {
  const drive::Projection* projection = nullptr;  ///< null: the frame is not known yet
  TimeScale scale = TimeScale::gps;
};

/// Writes reports in one format. It keeps no reference.
class ReportWriter {
 public:
  virtual ~ReportWriter() = default;
  /// Returns what comes before the first report, for each reader that connects.
  [[nodiscard]] virtual std::string header() const { return {}; }
  /// Returns the lines of a report; empty if the format has none for it.
  [[nodiscard]] virtual std::string write(const Report& report, const Surroundings& around) = 0;
  /// Returns what comes after the last report.
  [[nodiscard]] virtual std::string footer() const { return {}; }
};

/// One object per line: tools/program/JSON.md, "waymark-live".
[[nodiscard]] std::unique_ptr<ReportWriter> make_json_writer();
/// GGA, RMC and GST of every pose, in UTC. @param talker two capital letters @throws UsageError
[[nodiscard]] std::unique_ptr<ReportWriter> make_nmea_writer(const std::string& talker);
/// The poses as a table with a header.
[[nodiscard]] std::unique_ptr<ReportWriter> make_csv_writer();

/// Messages of JSON with their schemas in the container that Foxglove reads (mcap.dev/spec): a topic for each
/// kind of line, and /location on the map.
[[nodiscard]] std::unique_ptr<ReportWriter> make_mcap_writer();

/// Returns "*5B": the checksum of a sentence from '$' on.
[[nodiscard]] std::string nmea_checksum(const std::string& sentence);

}  // namespace waymark::live

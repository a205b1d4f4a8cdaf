/// Logs of Android's GnssLogger.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "gnss_logger": the lines "Fix,..." of the text logs of Google's GnssLogger, by the names in
/// the comment "# Fix,Provider,LatitudeDegrees,...". Streams gnss and truth.
///
/// Of several providers the fixes of GPS are read; `request.where` chooses another one ("Provider ==
/// FLP"). Stamps are Unix milliseconds, UTC. AccuracyMeters is the radius of 68 % (Android's
/// Location.getAccuracy) and is read as drms.
///
/// @throws InputError (from finish) if the log has no fix, or none of that provider
class GnssLoggerReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

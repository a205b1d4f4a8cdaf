/// Racelogic's VBO files.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "vbo": the table below "[data]" by the names below "[column names]" (Racelogic, "VBO file
/// format"). Streams gnss and truth.
///
/// Latitude and longitude are minutes of arc, the longitude positive to the west. Stamps are UTC times
/// of day; the date is `request.date` or that of the first line ("File created on 26/07/2021 ..."),
/// which is local. The number of satellites is `sats` without its flags (64 and more); rows with none
/// are without a fix.
class VboReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

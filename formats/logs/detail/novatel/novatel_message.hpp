/// The framing of NovAtel's ASCII messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {

/// "#NAME,header;body*checksum", or "%NAME,week,seconds;body*checksum" with the short header, as
/// views into the line.
struct NovatelMessage {
  std::string_view name;         ///< "BESTPOSA"
  std::string_view time_status;  ///< "FINESTEERING"; empty in short headers
  std::string_view week;
  std::string_view seconds;
  std::size_t body_column = 0;  ///< 1-based column of the first field of the body
  RecordFields body;
};

/// Returns the name of the message at the beginning of a line ("#BESTPOSA,": BESTPOSA). Empty if
/// there is none.
[[nodiscard]] std::string_view novatel_name(std::string_view line);

/// Splits a line whose name is known, and checks its checksum.
/// @return empty, or the error: no header, no checksum, wrong checksum
[[nodiscard]] std::string read_novatel(std::string_view line, NovatelMessage& message);

/// NovAtel's 32-bit CRC (OEM7 Commands and Logs, "32-Bit CRC"): reflected polynomial 0xEDB88320,
/// initial value 0, not inverted.
[[nodiscard]] std::uint32_t novatel_checksum(std::string_view text);

}  // namespace waymark::formats

/// NovAtel's ASCII messages: how they are framed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {

/// "#NAME,header;body*checksum", or with the short header "%NAME,week,seconds;body*checksum", as views into
/// its line.
struct NovatelMessage {
  std::string_view name;         ///< "BESTPOSA"
  std::string_view time_status;  ///< "FINESTEERING"; empty in short headers
  std::string_view week;
  std::string_view seconds;
  std::size_t body_column = 0;  ///< 1-based place of the body's first field
  RecordFields body;
};

/// The name of the message that a line begins with ("#BESTPOSA,": BESTPOSA); empty where it begins with none.
[[nodiscard]] std::string_view novatel_name(std::string_view line);

/// Takes a line apart whose name is known, and tests its checksum.
/// @return empty, or what is wrong: no header, no checksum, another checksum
[[nodiscard]] std::string read_novatel(std::string_view line, NovatelMessage& message);

/// NovAtel's 32-bit CRC (OEM7 Commands and Logs, "32-Bit CRC"): polynomial 0xEDB88320 reflected, from 0, not
/// inverted.
[[nodiscard]] std::uint32_t novatel_checksum(std::string_view text);

}  // namespace waymark::formats

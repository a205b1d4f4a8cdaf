/// CAN frames in lines of text, and the layout of candump (can-utils).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// This bit is set in the id of an extended (29-bit) frame, as in DBC files.
inline constexpr std::uint32_t kExtendedFrame = 0x8000'0000;

/// Ids of standard frames have 11 bits, those of extended ones 29.
inline constexpr std::uint32_t kMostStandardId = 0x7FF;
inline constexpr std::uint32_t kMostExtendedId = 0x1FFF'FFFF;

/// The largest number of bytes in a CAN FD frame.
inline constexpr std::size_t kMostFrameBytes = 64;

/// The kind of a line.
enum class FrameKind {
  data,
  remote,  ///< requests data and holds none
  error,   ///< a bus error, reported by the controller
  beside,  ///< no frame, and not meant as one: a head, another event
  none     ///< no frame: CanLine::what says why
};

/// The parts of a line, as views into it. The data are not decoded yet, because most frames of a
/// log are not needed.
struct CanLine {
  FrameKind kind = FrameKind::none;
  std::uint32_t id = 0;        ///< with kExtendedFrame
  std::string_view stamp;      ///< "1627274455.012500"
  std::string_view interface;  ///< "can0"
  std::string_view data;       ///< the bytes in hex, and the rest of the line
  int listed_size = -1;        ///< the announced number of bytes; -1: candump's log layout has none
  bool decimal = false;        ///< the bytes are decimal numbers
  std::size_t column = 0;      ///< 1-based column of the error if kind is `none`
  std::string_view what;       ///< the error
};

/// The bytes of a frame. Bytes beyond `size` may be read (a load of 8 bytes does so); they
/// have no meaning.
struct CanData {
  std::size_t size = 0;
  std::array<std::uint8_t, kMostFrameBytes + 16> bytes{};
};

/// Splits one line into its parts. It knows two layouts:
/// - `candump -l` or `-L`: `(1627274455.012500) can0 17F00010#2010` (classic), `123##1AABB` (CAN
///   FD, one digit of flags), `123#R` (remote);
/// - `candump -ta` on a console: ` (1627274455.012500)  can0  7E8   [8]  03 41 0D 00`,
///   also with `-x`.
///
/// Ids are 3 hex digits (standard) or 8 (extended; 20000000 marks an error frame).
[[nodiscard]] CanLine split_can_line(std::string_view line);

/// Reads the bytes of a data frame.
/// @return the error, or an empty text
[[nodiscard]] std::string_view read_can_data(const CanLine& line, CanData& data);

/// Reads the seconds of a line, exact to the nanosecond. Empty if they are no number.
[[nodiscard]] std::optional<Stamp> can_stamp(std::string_view text);

}  // namespace waymark::formats

/// CAN frames as candump (can-utils) writes them, one a line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// Set in the id of an extended (29-bit) frame, as DBC files do.
inline constexpr std::uint32_t kExtendedFrame = 0x8000'0000;

/// A CAN FD frame holds so many bytes at most.
inline constexpr std::size_t kMostFrameBytes = 64;

/// What a line is.
enum class FrameKind {
  data,
  remote,  ///< asks for data and holds none
  error,   ///< the controller's report of a bus error
  none     ///< no frame: see CanLine::what
};

/// A line taken apart, as views into it: its data are not looked at yet, as most frames of a log are of no
/// interest.
struct CanLine {
  FrameKind kind = FrameKind::none;
  std::uint32_t id = 0;        ///< with kExtendedFrame
  std::string_view stamp;      ///< "1627274455.012500"
  std::string_view interface;  ///< "can0"
  std::string_view data;       ///< the bytes in hex and what follows them
  int listed_size = -1;        ///< console layout: how many bytes are announced; -1: log layout
  std::size_t column = 0;      ///< 1-based place of the trouble where kind is `none`
  std::string_view what;       ///< the trouble
};

/// The bytes of a frame. Those behind `size` may be read (as one load of 8 bytes does) and have no meaning.
struct CanData {
  std::size_t size = 0;
  std::array<std::uint8_t, kMostFrameBytes + 16> bytes{};
};

/// Takes apart one line of
///  - `candump -l` or `-L`: `(1627274455.012500) can0 17F00010#2010` (classic), `123##1AABB` (CAN FD, one
///  digit
///    of flags), `123#R` (remote);
///  - `candump -ta` on a console: ` (1627274455.012500)  can0  7E8   [8]  03 41 0D 00`, with `-x` too.
///
/// Ids are 3 hex digits (standard) or 8 (extended; 20000000 marks an error frame).
[[nodiscard]] CanLine split_can_line(std::string_view line);

/// The bytes of a data frame.
/// @return what is wrong with them; empty where nothing is
[[nodiscard]] std::string_view read_can_data(const CanLine& line, CanData& data);

/// The seconds of a line, exact to the nanosecond; empty where they are no number.
[[nodiscard]] std::optional<Stamp> can_stamp(std::string_view text);

}  // namespace waymark::formats

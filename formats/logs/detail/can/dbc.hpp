/// DBC files: they define the signals of the messages of a CAN bus. Also extracts signals
/// from frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/logs/detail/can/can_frame.hpp>

namespace waymark::formats {

/// How the bits of a signal encode a number.
enum class SignalNumber { unsigned_integer, signed_integer, float32, float64 };

/// Values first .. last of a multiplexer.
struct MultiplexerRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// One signal: a number in some bits of a frame. value = factor * bits + offset. Only a signal
/// without trouble may be read.
struct DbcSignal {
  std::string name;
  std::string unit;  ///< as in the file, in UTF-8
  /// the least (Intel) or most (Motorola) significant bit, numbered as in the file
  unsigned start = 0;
  unsigned length = 1;  ///< bits, 1 .. 64
  /// Motorola: after a byte, the bits continue at the most significant bit of the next one
  bool big_endian = false;
  SignalNumber number = SignalNumber::unsigned_integer;
  double factor = 1;
  double offset = 0;
  bool multiplexes = false;  ///< its value selects other signals of the message
  /// index in the message of the signal that selects this one
  std::optional<std::size_t> multiplexer;
  std::vector<MultiplexerRange> when;  ///< the values that select this signal
  std::size_t line = 0;                ///< in the file, 1-based
  /// The error that prevents reading, "car.dbc:12:20: SG_ SPEED: ..."; empty if there is none. Real
  /// files have such signals in messages that nobody asks for.
  std::string trouble;

  /// Returns how many bytes a frame must have to hold the signal.
  [[nodiscard]] std::size_t bytes_needed() const;
  /// Extracts the bits, least significant first, from a frame that has bytes_needed().
  [[nodiscard]] std::uint64_t bits(const CanData& data) const;
  /// Returns the number in a frame. If factor and offset are short decimals, the result is the
  /// double nearest to the exact decimal: 1e-06 * 146100000 - 90 is 56.1, as a table made from the
  /// log would have it.
  [[nodiscard]] double value(const CanData& data) const;
  /// Returns value times `multiplier`, rounded to an integer. If factor and offset allow it, no
  /// double is used on the way. Empty if the result is no number or does not fit.
  [[nodiscard]] std::optional<std::int64_t> integer(const CanData& data, std::int64_t multiplier) const;

  /// Exactly: factor = numerator / denominator and offset = shift / denominator. Denominator 0:
  /// there is no such fraction.
  std::int64_t numerator = 0, shift = 0, denominator = 0;
};

/// Returns the parameter group of a J1939 id: without priority and sender, and without the receiver if
/// the group names one.
[[nodiscard]] constexpr std::uint32_t parameter_group(std::uint32_t id) {
  constexpr std::uint32_t kFirstBroadcast = 0xF0;
  const bool to_one = ((id >> 16U) & 0xFFU) < kFirstBroadcast;
  return id & (to_one ? 0x03FF'0000U : 0x03FF'FF00U);
}

/// One message: all frames with one id.
struct DbcMessage {
  std::uint32_t id = 0;  ///< with kExtendedFrame
  std::string name;
  std::size_t size = 0;  ///< bytes
  std::vector<DbcSignal> signals;
  std::size_t line = 0;
  /// a J1939 parameter group, which any sender may send: its id has the null address FE
  bool is_group = false;
  bool is_standard = false;  ///< of standard_messages(), not of a file

  /// Returns null for an unknown name.
  [[nodiscard]] const DbcSignal* find(std::string_view signal) const;
  /// Tells whether a frame holds the signal. It does not if the multiplexer selects another one.
  [[nodiscard]] bool holds(const DbcSignal& signal, const CanData& data) const;
  /// Tells whether the value of a signal that the frame holds is one. In a J1939 parameter group,
  /// bytes from FB on (the highest ones of longer numbers) mean "not available" or "error" (J1939-71).
  [[nodiscard]] bool is_available(const DbcSignal& signal, const CanData& data) const;
};

/// The messages of a DBC file.
///
/// The parser reads BO_ and SG_ with multiplexing (M, m3, m3M), SG_MUL_VAL_ (extended multiplexing)
/// and SIG_VALTYPE_ (floating-point signals). It skips everything else, also
/// VECTOR__INDEPENDENT_SIG_MSG.
struct Dbc {
  std::string path;                  ///< for messages
  std::vector<DbcMessage> messages;  ///< in the order of the file

  /// @throws InputError "car.dbc:12:20: SG_ SPEED: ..." for a BO_ or SG_ that is malformed, does
  /// not fit or appears twice, and for a file without messages
  [[nodiscard]] static Dbc parse(std::string_view text, const std::string& path);
};

}  // namespace waymark::formats

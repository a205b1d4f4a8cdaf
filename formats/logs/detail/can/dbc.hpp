/// DBC files: which signals the messages of a CAN bus hold, and how to read them out of a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/logs/detail/can/can_frame.hpp>

namespace waymark::formats {

/// How the bits of a signal are a number.
enum class SignalNumber { unsigned_integer, signed_integer, float32, float64 };

/// Values first .. last of a multiplexer.
struct MultiplexerRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// One signal: a number in some bits of a frame. value = factor * bits + offset. Only those without trouble
/// may be read.
struct DbcSignal {
  std::string name;
  std::string unit;     ///< as the file has it, in UTF-8
  unsigned start = 0;   ///< number of the least (Intel) or most (Motorola) significant bit, as in the file
  unsigned length = 1;  ///< bits, 1 .. 64
  bool big_endian = false;  ///< Motorola: bits run on towards the next byte's most significant one
  SignalNumber number = SignalNumber::unsigned_integer;
  double factor = 1;
  double offset = 0;
  bool multiplexes = false;  ///< others of the message depend on its value
  std::optional<std::size_t>
      multiplexer;  ///< index of the signal in the message that says when this one is there
  std::vector<MultiplexerRange> when;  ///< and for which of its values
  std::size_t line = 0;                ///< in the file, 1-based
  /// "car.dbc:12:20: SG_ SPEED: ..." where it cannot be read; empty where it can. Real files have such
  /// signals in messages that nobody asks for.
  std::string trouble;

  /// How many bytes a frame must have to hold it.
  [[nodiscard]] std::size_t bytes_needed() const;
  /// The bits, least significant first; of a frame that has bytes_needed().
  [[nodiscard]] std::uint64_t bits(const CanData& data) const;
  /// The number in a frame. Where factor and offset are short decimals, the result is the double nearest to
  /// the decimal number meant: 1e-06 * 146100000 - 90 is 56.1, as a table written from the log would have it.
  [[nodiscard]] double value(const CanData& data) const;
  /// value times `multiplier`, rounded to an integer without a double between where factor and offset allow;
  /// empty where that is no number or does not fit.
  [[nodiscard]] std::optional<std::int64_t> integer(const CanData& data, std::int64_t multiplier) const;

  /// factor = numerator / denominator and offset = shift / denominator exactly; denominator 0: not so.
  std::int64_t numerator = 0, shift = 0, denominator = 0;
};

/// One message: the frames of one id.
struct DbcMessage {
  std::uint32_t id = 0;  ///< with kExtendedFrame
  std::string name;
  std::size_t size = 0;  ///< bytes
  std::vector<DbcSignal> signals;
  std::size_t line = 0;

  /// Null for an unknown name.
  [[nodiscard]] const DbcSignal* find(std::string_view signal) const;
  /// Whether a frame holds the signal: not where its multiplexer says otherwise.
  [[nodiscard]] bool holds(const DbcSignal& signal, const CanData& data) const;
};

/// The messages of a DBC file.
///
/// Read are BO_ and SG_ with multiplexing (M, m3, m3M), SG_MUL_VAL_ (extended multiplexing) and SIG_VALTYPE_
/// (floating-point signals); all else is passed over, VECTOR__INDEPENDENT_SIG_MSG too.
struct Dbc {
  std::string path;                  ///< for messages
  std::vector<DbcMessage> messages;  ///< in the order of the file

  /// @throws InputError "car.dbc:12:20: SG_ SPEED: ..." for a BO_ or SG_ that is malformed, does not fit or
  /// is there twice, and for a file without messages
  [[nodiscard]] static Dbc parse(std::string_view text, const std::string& path);
};

/// The name by which this library knows a unit of a DBC file: "km/h" for "kph"; empty for an unknown one.
[[nodiscard]] std::string_view known_unit(std::string_view dbc_unit);

}  // namespace waymark::formats

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <waymark/formats/logs/detail/can/dbc.hpp>

namespace waymark::formats {
namespace {

__extension__ using Wide = __int128;

/// Loads eight bytes from `first` as a number. The first byte is the least (big_endian: the most)
/// significant one.
std::uint64_t load(const CanData& data, std::size_t first, bool big_endian) {
  std::uint64_t word = 0;
  std::memcpy(&word, data.bytes.data() + first, sizeof word);
  const bool native_big = std::endian::native == std::endian::big;
  return big_endian == native_big ? word : __builtin_bswap64(word);
}

/// Returns the place of the first bit in the order of a Motorola signal: the most significant bit
/// of byte 0 comes first.
unsigned motorola_place(unsigned start) {
  return start / 8 * 8 + 7 - start % 8;
}

std::int64_t sign_extended(std::uint64_t bits, unsigned length) {
  const unsigned unused = 64 - length;
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

}  // namespace

std::size_t DbcSignal::bytes_needed() const {
  const unsigned first = big_endian ? motorola_place(start) : start;
  return (first + length + 7) / 8;
}

std::uint64_t DbcSignal::bits(const CanData& data) const {
  // A signal of up to 64 bits may touch nine bytes. Eight come in one load; the ninth is loaded
  // only if needed.
  const unsigned place = big_endian ? motorola_place(start) : start;
  const std::size_t first = place / 8;
  const unsigned skipped = place % 8;
  const std::uint64_t word = load(data, first, big_endian);
  const std::uint64_t ninth = data.bytes[first + 8];
  if (big_endian) {
    std::uint64_t aligned = word << skipped;
    if (skipped + length > 64) aligned |= ninth >> (8 - skipped);
    return aligned >> (64 - length);
  }
  std::uint64_t aligned = word >> skipped;
  if (skipped + length > 64) aligned |= ninth << (64 - skipped);
  return length == 64 ? aligned : aligned & ((std::uint64_t{1} << length) - 1);
}

double DbcSignal::value(const CanData& data) const {
  const std::uint64_t raw = bits(data);
  double number_of_bits = 0;
  switch (number) {
    case SignalNumber::unsigned_integer:
      number_of_bits = static_cast<double>(raw);
      break;
    case SignalNumber::signed_integer:
      number_of_bits = static_cast<double>(sign_extended(raw, length));
      break;
    case SignalNumber::float32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(raw)) * factor + offset;
    case SignalNumber::float64:
      return std::bit_cast<double>(raw) * factor + offset;
  }
  if (denominator == 0) return number_of_bits * factor + offset;
  // Two exact integers (Dbc::parse ensures this) and one rounding.
  return (number_of_bits * static_cast<double>(numerator) + static_cast<double>(shift)) /
         static_cast<double>(denominator);
}

std::optional<std::int64_t> DbcSignal::integer(const CanData& data, std::int64_t multiplier) const {
  if (denominator == 0) {
    const double result = value(data) * static_cast<double>(multiplier);
    if (!(std::abs(result) < 9.2e18)) return std::nullopt;
    return std::llround(result);
  }
  const std::uint64_t raw = bits(data);
  const Wide whole = number == SignalNumber::signed_integer ? Wide{sign_extended(raw, length)} : Wide{raw};
  const Wide scaled = (whole * numerator + shift) * multiplier;
  const Wide result = (scaled + (scaled < 0 ? -1 : 1) * Wide{denominator} / 2) / denominator;
  if (result > std::numeric_limits<std::int64_t>::max() || result < std::numeric_limits<std::int64_t>::min())
    return std::nullopt;
  return static_cast<std::int64_t>(result);
}

const DbcSignal* DbcMessage::find(std::string_view signal) const {
  for (const DbcSignal& candidate : signals) {
    if (candidate.name == signal) return &candidate;
  }
  return nullptr;
}

bool DbcMessage::holds(const DbcSignal& signal, const CanData& data) const {
  const DbcSignal* inner = &signal;
  while (inner->multiplexer) {  // Dbc::parse refuses cycles
    const DbcSignal& outer = signals[*inner->multiplexer];
    if (data.size < outer.bytes_needed()) return false;
    const std::uint64_t now = outer.bits(data);
    bool there = false;
    for (const MultiplexerRange& range : inner->when)
      there = there || (range.first <= now && now <= range.last);
    if (!there) return false;
    inner = &outer;
  }
  return true;
}

bool DbcMessage::is_available(const DbcSignal& signal, const CanData& data) const {
  constexpr unsigned kByte = 8;
  const bool whole_bytes = signal.length % kByte == 0 && signal.length <= 4 * kByte;
  if (!is_group || !whole_bytes || signal.number != SignalNumber::unsigned_integer) return true;
  constexpr std::uint64_t kFirstReserved = 0xFB;
  return signal.bits(data) >> (signal.length - kByte) < kFirstReserved;
}

}  // namespace waymark::formats

/// What the subframes of D1 and D2 have in common (BDS-SIS-ICD, 5.2.4).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <waymark/formats/satellites/broadcast/message_bits.hpp>

namespace waymark::formats::satellites {

/// Returns the bits of a subframe; empty if it does not begin with the preamble.
/// @param words ten of 30 bits, each with its parity
[[nodiscard]] inline std::optional<MessageBits> beidou_subframe(std::span<const std::uint32_t, 10> words) {
  constexpr std::uint32_t kPreamble = 0x712;
  MessageBits subframe;
  for (const std::uint32_t word : words) subframe.append(word, 30);
  return subframe.whole(0, 11) == kPreamble ? std::optional(subframe) : std::nullopt;
}

/// Returns the second of the week of BeiDou at which a subframe begins.
[[nodiscard]] inline std::uint32_t second_of_week(const MessageBits& subframe) {
  return subframe.whole({18, 8}, {30, 12});
}

}  // namespace waymark::formats::satellites

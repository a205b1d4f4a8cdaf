/// Stamps as decimal seconds, exact to the nanosecond: a double holds seconds of this decade only to 2.4e-7
/// s.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// "1149206567.040000000": always nine decimals.
[[nodiscard]] std::string decimal_seconds(Stamp stamp);

/// Inverse of decimal_seconds, for any decimal number ("12", "-0.5", "1.149206567e+09"); digits below a
/// nanosecond are rounded half away from zero.
/// @return empty where the text is no decimal number or the instant does not fit a Stamp.
[[nodiscard]] std::optional<Stamp> stamp_from_decimal_seconds(std::string_view text);

}  // namespace waymark::formats

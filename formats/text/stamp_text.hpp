/// Stamps as decimal seconds, exact to the nanosecond. A double would hold seconds of this decade
/// only to 2.4e-7 s.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// Returns "1149206567.040000000", always with nine decimals.
[[nodiscard]] std::string decimal_seconds(Stamp stamp);

/// The inverse of decimal_seconds for any decimal number ("12", "-0.5", "1.149206567e+09"). Digits
/// below a nanosecond are rounded half away from zero.
/// @return empty if the text is no decimal number or the instant does not fit a Stamp
[[nodiscard]] std::optional<Stamp> stamp_from_decimal_seconds(std::string_view text);

}  // namespace waymark::formats

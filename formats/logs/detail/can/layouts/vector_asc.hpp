/// CAN frames as text by Vector's tools (.asc).
#pragma once

#include <memory>

#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>

namespace waymark::formats {

/// The layout of ASC logs, by Vector's "CAN ASC logging files" and the logs of other programs:
///
///     date Mon Jul 26 10:14:15.000 am 2021
///     base hex  timestamps absolute
///        0.015991 1  7E8             Rx   d 8 03 41 0D 00 00 00 00 00
///        0.020000 1  18FEF100x       Rx   d 8 FF ...                   (x: extended)
///        0.030000 CANFD   1 Rx  123  Name  1 0 d 32 AA BB ...
///
/// Numbers may be decimal ("base dec"), and stamps may count from the line before ("timestamps
/// relative"). Stamps are the date of the head plus the seconds of the line; that date is local time
/// without a zone. Lines that are no frames (triggers, statistics, other buses) are `beside`.
[[nodiscard]] std::unique_ptr<CanLayout> vector_asc();

}  // namespace waymark::formats

/// CAN frames as text by PEAK's tools (.trc).
#pragma once

#include <memory>

#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>

namespace waymark::formats {

/// The layout of TRC logs, by PEAK's "PCAN Trace File Formats", versions 1.0 to 1.3, 2.0 and 2.1:
///
///     ;$FILEVERSION=1.1
///     ;$STARTTIME=44403.4265625
///          1)        15.9  Rx         07E8  8  03 41 0D 00 00 00 00 00
///
///     ;$FILEVERSION=2.1
///     ;$COLUMNS=N,O,T,B,I,d,R,L,D
///           1        15.991 DT 1      07E8 Rx -  8    03 41 0D 00 00 00 00 00
///
/// Stamps are the start, in days since 1899-12-30, plus the milliseconds of the line; the start is
/// local time without a zone.
[[nodiscard]] std::unique_ptr<CanLayout> peak_trc();

}  // namespace waymark::formats

/// CAN logs of candump (can-utils) with a DBC file: odometry, fixes and sensor readings by signal name.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "candump". formats/logs/README.md has layouts, units and traps.
///
/// `request.companions["dbc"]` is the DBC; `request.columns` names the signal of every quantity: "SIGNAL",
/// "MESSAGE.SIGNAL", or either behind an interface, "can0:SIGNAL" (without one, frames of all interfaces are
/// read). A unit that is not stated is taken from the DBC and noted.
///
/// **Odometry and sensors**: every frame that carries a wanted signal is a row of `readings`, NaN in the
/// columns whose signals it does not carry.
///
/// **Fixes and truth**: see FixAssembler: a frame with the position makes a fix, other quantities come from
/// the frame nearest in time within 0.1 s. Accuracy as in CSV. Where `gnss_time` is mapped (seconds since
/// 1970, UTC), every frame of it is a ClockPair.
///
/// **Stamps** are the logger's, digit by digit, taken to be on `request.time_scale`; `time_offset_s` is
/// added.
///
/// **Corrupt**: lines that are no frames, and wanted frames with a garbled stamp, garbled data, or fewer
/// bytes than the signal needs. A value outside its quantity's range (often the bus's "not available") is
/// none, and counted in the notes; a position outside is corrupt. Frames of other ids are not looked at
/// beyond the id. Error and remote frames are passed over and counted.
///
/// @throws InputError from open for a missing or malformed DBC, a column that does not fit it, other
/// companions, fixes without any accuracy; from take for a Vector ASC log (the remedy is named)
class CandumpReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

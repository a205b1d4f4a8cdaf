/// Logs of CAN frames with DBC files: odometry, fixes and sensor readings by signal name.
#pragma once

#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Readers "candump", "asc" and "trc". formats/logs/README.md describes layouts, units and pitfalls.
///
/// The companions "dbc" of the request are the DBC files (see dbc_of()). `request.columns` names the signal of every
/// quantity: "SIGNAL", "MESSAGE.SIGNAL", or either of them after an interface, "can0:SIGNAL".
/// Without an interface, frames of all interfaces are read. If the request states no unit, the unit
/// of the DBC is used, and a note says so.
///
/// **Odometry and sensors**: every frame with a wanted signal is a row of `readings`. Columns whose
/// signals the frame does not carry are NaN.
///
/// **Fixes and truth** (see FixAssembler): a frame with the position makes a fix. The other
/// quantities come from the frame nearest in time, within 0.1 s. The rules for accuracy are those
/// of the CSV reader. If `gnss_time` is mapped (seconds since 1970, UTC), every frame with it is
/// a ClockPair.
///
/// **Stamps** are those of the logger, digit by digit, read as `request.time_scale`;
/// `time_offset_s` is added.
///
/// **Corrupt**: lines that are no frames, and wanted frames with a garbled stamp, garbled data
/// or too few bytes for the signal. A value outside the range of its quantity (often the "not
/// available" of the bus) is ignored and counted in the notes; a position outside its range is
/// corrupt. Of frames with other ids only the id is read. Error and remote frames are skipped
/// and counted.
///
/// @throws InputError from open for a malformed DBC, a column that does not fit it, other companions,
/// or fixes without any accuracy
class CanLogReader final : public LogReader {
 public:
  /// @param format of can_layout()
  explicit CanLogReader(std::string_view format = "candump") : format_(format) {}
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;

 private:
  std::string_view format_;
};

}  // namespace waymark::formats

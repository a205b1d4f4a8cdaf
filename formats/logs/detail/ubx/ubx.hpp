/// Logs of u-blox receivers in the UBX protocol, alone or mixed with NMEA, RTCM or anything else.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "ubx": reads fixes (gnss), positions (truth), and readings of ESF-MEAS
/// (odometry, sensor).
///
/// **Epochs.** Navigation messages with one iTOW belong together. NAV-EOE, another iTOW, or a
/// second position from the same message closes an epoch. The position comes from NAV-HPPOSLLH,
/// else NAV-PVT, else NAV-POSLLH; speed and course come from NAV-PVT, else NAV-VELNED. The state of
/// the fix comes from NAV-PVT, else NAV-SOL, else NAV-STATUS. It is no fix without gnssFixOK, with
/// type 0 (none) or 5 (time only), or with an invalid position. Dead reckoning (1) and its
/// combination with GNSS (4) are used and counted in the notes. HNR-PVT has positions that are
/// dead-reckoned between the epochs. They are skipped unless the column `position` names them,
/// `position: HNR-PVT`; then nothing else is read.
///
/// **Time** comes from the first of these: the date of NAV-PVT if fully resolved, the date of
/// NAV-TIMEUTC if valid, iTOW with the week of NAV-SOL or NAV-TIMEGPS, a valid date that is not
/// fully resolved (with the seconds of iTOW), iTOW in the week of the previous epochs or in
/// `request.gps_week`.
///
/// **Accuracy** is the covariance of NAV-COV if valid, or else hAcc, as drms unless stated. Speed
/// and course accuracies are read as one sigma. Heights are above the ellipsoid. The heading of
/// truth is headVeh if valid.
///
/// **Readings**: each ESF-MEAS message is one row, with columns by name (channels.hpp). A value
/// that the message does not hold is NaN. Tick counters become running counts; they fall while the
/// direction bit says backwards. The order of the messages places the clock of the sensors on GNSS
/// time; UbxSensorClock states its error.
///
/// **Raw measurements** (a sensor stream with the column `pseudorange`): RXM-RAWX on the first frequency of GPS,
/// Galileo, BeiDou and GLONASS; its time is that of the receiver's own clock. The ephemerides come from the companions
/// "navigation", or without them from RXM-SFRBX: LNAV of GPS with the ionosphere, I/NAV of Galileo, D1 of BeiDou. The
/// measurements of the first minute wait for them. RawRows has the rest.
///
/// **Corrupt**: frames with a wrong checksum or length, messages that are too short, positions
/// outside the globe, and positions without a known week or without accuracy.
class UbxReader final : public LogReader {
 public:
  /// @throws InputError for columns other than `position`, companion files, and readings that
  /// ESF-MEAS does not have
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// The confidence is 1 for at least three frames with right checksums that include a message with
  /// a position or raw measurements. So a log mixed with NMEA belongs to this reader, because the NMEA reader claims at
  /// most 0.95. Otherwise it is the share of bytes in frames, times 0.9.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

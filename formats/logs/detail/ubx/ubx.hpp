/// Logs of u-blox receivers in the UBX protocol, alone or mixed with NMEA, RTCM or anything else.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "ubx": fixes (gnss), positions (truth), and readings of ESF-MEAS (odometry, sensor).
///
/// **Epochs.** Navigation messages of one iTOW belong together; NAV-EOE, another iTOW or a second position of
/// the same message closes an epoch. Position: NAV-HPPOSLLH before NAV-PVT before NAV-POSLLH. Speed and
/// course: NAV-PVT, else NAV-VELNED. Fix: NAV-PVT, else NAV-SOL, else NAV-STATUS; without gnssFixOK, with
/// type 0 (none) or 5 (time only), or with an invalid position it is none. Dead reckoning (1) and its
/// combination with GNSS (4) are used and counted in the notes. HNR-PVT, positions dead-reckoned between the
/// epochs, are passed over unless the column `position` names them: `position: HNR-PVT`; then they alone are
/// read.
///
/// **Time**, in order: the date of NAV-PVT if fully resolved, that of NAV-TIMEUTC if valid, iTOW with the
/// week of NAV-SOL or NAV-TIMEGPS, a valid date that is not fully resolved (with the seconds of iTOW), iTOW
/// in the week of the epochs before or in `request.gps_week`.
///
/// **Accuracy**: NAV-COV's covariance where valid; else hAcc, as drms unless stated. Speed and course
/// accuracies are taken as one sigma. Heights are above the ellipsoid. Heading of truth: headVeh where valid.
///
/// **Readings**: one row per ESF-MEAS message, columns by name (channels.hpp), NaN for what it does
/// not hold. Tick counters become running counts that fall while the direction bit says backwards. The
/// sensors' clock is placed on GNSS time by the order of the messages: see UbxSensorClock for its error.
///
/// **Corrupt**: frames with a wrong checksum or length, messages too short, positions outside the globe,
/// without a known week or without accuracy.
class UbxReader final : public LogReader {
 public:
  /// @throws InputError for columns other than `position`, companion files, readings that ESF-MEAS has not
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// 1 for at least three frames with right checksums and a message with a position among them: a log mixed
  /// with NMEA is this reader's, too (that of NMEA never claims more than 0.95). Else the share of the bytes
  /// in frames, times 0.9.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

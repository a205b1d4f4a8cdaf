/// Logs of NMEA 0183 sentences. Nearly every receiver writes them.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "nmea": reads fixes (stream gnss) or reference positions (stream truth) from RMC, GGA,
/// GNS, GST, VTG, ZDA and GLL sentences of any talker.
///
/// **Epochs.** Consecutive sentences with the same time of day are one epoch, in any order. VTG
/// has no time and belongs to the current epoch. The position comes from GGA, else GNS, RMC, GLL;
/// speed and course come from RMC, else VTG. Sentences of a fix without a time of day are counted
/// and not used. A second sentence of one kind with another position begins a further epoch of that time.
///
/// **No fix**: RMC or GLL status V, GGA quality 0, or a mode indicator N (GNS: of all systems) in
/// any sentence of the epoch. 0 satellites in GGA or GNS also mean no fix if an earlier fix had
/// some (a frozen position).
///
/// **Corrupt**: a sentence of these kinds with a wrong checksum or a bad field, and a fix without
/// an accuracy. A sentence without a checksum is corrupt if an earlier one had a checksum, because
/// it was cut off; otherwise it is accepted. Each corrupt sentence is a record, and each epoch is
/// one. The notes count lines without a sentence.
///
/// **Date** comes from RMC with a fix and from ZDA, which takes precedence. Between dates it
/// advances if the time of day jumps back by more than 12 hours. Fixes before the first date wait
/// for it, at most 4096 of them. A log without any date needs `request.date`. **Time** is UTC; it
/// is converted to `request.time_scale`. Second 60 counts as the second after it.
///
/// **Height** is above the ellipsoid if altitude and geoid separation are given, or else above
/// mean sea level.
///
/// **Quality** comes from GGA's number, else from the mode letters of GNS, RMC or GLL; dead reckoned,
/// manual and simulated from any of them. GGA and GNS give satellites, HDOP and the age of corrections,
/// GSA the HDOP that they lack.
///
/// **Accuracy.** GST fields 6 and 7 are 1 sigma north and east, and `request.accuracy` overrides
/// this; the error ellipse gives the correlation. Fixes without GST: see PositionStream::set_covariance.
class NmeaReader final : public LogReader {
 public:
  /// @throws InputError for the odometry and sensor streams, a column map, or a companion file. The
  /// decoder throws one if neither the log nor the request has a date.
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// The confidence is the share of lines that hold a sentence with a right checksum.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

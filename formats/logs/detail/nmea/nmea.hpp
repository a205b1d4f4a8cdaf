/// Logs of NMEA 0183 sentences, as nearly every receiver writes them.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "nmea": fixes (stream gnss) or reference positions (stream truth) from RMC, GGA, GNS, GST, VTG, ZDA
/// and GLL sentences of any talker.
///
/// **Epochs.** Sentences of one time of day in a row are one epoch, whatever their order; VTG, which has no
/// time, belongs to the epoch at hand. A position comes from GGA, else GNS, RMC, GLL; speed and course from
/// RMC, else VTG. Sentences of a fix that lack the time of day are counted and not used.
///
/// **No fix**: RMC or GLL status V, GGA quality 0, a mode indicator N (GNS: of all systems), each in any
/// sentence of the epoch; also 0 satellites in GGA or GNS where an earlier fix had some (a frozen position).
/// **Corrupt**: a sentence of these kinds with a wrong checksum or a field that does not hold what it should,
/// or without a checksum where an earlier one had one (it broke off); a fix without an accuracy. Each is a
/// record, as is each epoch. Sentences without a checksum are believed where none before them had one. Lines
/// without a sentence are counted in the notes.
///
/// **Date** from RMC of a fix and from ZDA (which wins); between dates it advances where the time of day
/// jumps back by more than 12 hours. Fixes before the first date wait for it, at most 4096 of them. A log
/// without any needs `request.date`. **Time** is UTC and comes out on `request.time_scale`; second 60 counts
/// as the one after it.
///
/// **Height** above the ellipsoid where altitude and geoid separation are given, else above mean sea level.
///
/// **Accuracy.** GST fields 6 and 7 are 1 sigma north and east (`request.accuracy` overrides that); the
/// correlation is that of the error ellipse. Else HDOP times `request.range_error_m` where stated, else the
/// default sigma, else the record is corrupt.
class NmeaReader final : public LogReader {
 public:
  /// @throws InputError for the odometry and sensor streams, a column map, a companion file. Its decoder
  /// throws one for a log without a date where the request has none.
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// The share of lines that hold a sentence with a right checksum.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

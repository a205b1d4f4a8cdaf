/// Logs of gpsd: one JSON object a line, as `gpspipe -w` writes them (see man gpsd_json).
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "gpsd_json": fixes (stream gnss) or reference positions (stream truth) from TPV objects.
///
/// **Epochs.** Neighbouring TPVs of one device and one `time` are one epoch: a later one replaces the fields
/// it has and keeps the others (gpsd reports an epoch in parts where the receiver does). Where several
/// devices speak, the first one that reports a time is read and the others are counted in the notes.
///
/// **Not corrupt**, only counted in the notes: lines that are no JSON objects (comments, NMEA), a `mode`
/// below 2 or none (no fix), a fix without `time`. **Corrupt**: a line that starts as an object and is no
/// JSON (objects that name another class first, as gpsd's SKY do, are passed over unseen), a member of the
/// wrong type, a fix without `lat` and `lon` or outside their range, a `time` that is no ISO 8601 date.
///
/// **Time** is UTC and comes out on `request.time_scale`.
///
/// **Accuracy.** automatic: the GST object of the same device and time, whose errors are 1 sigma, with the
/// correlation of its error ellipse; else epx and epy at 95 % (the paper's rule); else eph as drms. A stated
/// meaning leaves GST aside: per-axis ones (95, 1sigma) read epx and epy, radial ones (drms, cep50) read eph;
/// each falls back on the other. gpsd changed what epx and epy are: before 3.11 the 3-D accuracy / sqrt 2,
/// in 3.11 to 3.18 u-blox' raw hAcc (drms is then the better reading), since 3.19 DOP x 15 m with hAcc in
/// eph. What version and values show of this is put into the notes, with the sigma that the fitting meaning
/// would give. No figure: the default sigma, counted in the notes; without one the record is corrupt.
///
/// **Course and speed**: track and speed with epd and eps (95 %). Height: altHAE, else alt (which is above
/// the geoid).
class GpsdJsonReader final : public LogReader {
 public:
  /// @throws InputError for the odometry and sensor streams, a column map, a companion file. Its decoder
  /// throws one for an empty log.
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// The share of lines that are gpsd's objects, the receiver's own sentences between them included.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

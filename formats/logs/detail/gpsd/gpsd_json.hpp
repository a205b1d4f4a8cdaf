/// Logs of gpsd: one JSON object per line, as `gpspipe -w` writes them (see man gpsd_json).
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "gpsd_json": reads fixes (stream gnss) or reference positions (stream truth) from
/// TPV objects.
///
/// **Epochs.** Adjacent TPVs of one device with the same `time` are one epoch, because gpsd
/// reports an epoch in parts if the receiver does so. A later TPV replaces the fields it has and
/// keeps the others. If there are several devices, the first one that reports a time is read. The
/// notes count the others.
///
/// **Not corrupt**, only counted in the notes: lines that are no JSON objects (comments, NMEA), a
/// `mode` that is missing or below 2 (no fix), a fix without `time`.
///
/// **Corrupt**: a line that starts like an object and is no JSON, a member of the wrong type, a fix
/// without `lat` and `lon` or outside their range, a `time` that is no ISO 8601 date. Objects that
/// name another class first, as gpsd's SKY objects do, are skipped unread.
///
/// **Time** is UTC; it is converted to `request.time_scale`.
///
/// **Accuracy.** With `automatic` the GST object of the same device and time is used. Its errors
/// are 1 sigma, and its error ellipse gives the correlation. Without it, epx and epy are used at 95
/// % (the rule of the paper), or else eph as drms. A stated meaning ignores GST: a per-axis meaning
/// (95, 1sigma) reads epx and epy, a radial one (drms, cep50) reads eph. Each falls back on the
/// other. gpsd has changed epx and epy over time. Before 3.11 they are the 3-D accuracy / sqrt 2.
/// From 3.11 to 3.18 they are the raw hAcc of u-blox; drms is then the better reading. Since 3.19
/// they are DOP x 15 m, and hAcc is in eph. The notes say which case the version and the values
/// indicate, and the sigma that the matching meaning would give. Without a figure the default sigma
/// is used, and the notes count these records; without a default the record is corrupt.
///
/// **Course and speed** are track and speed with epd and eps (95 %). The height is altHAE, or else
/// alt (above the geoid).
class GpsdJsonReader final : public LogReader {
 public:
  /// @throws InputError for the odometry and sensor streams, a column map, or a companion file. The
  /// decoder throws one for an empty log.
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// The confidence is the share of lines that are objects of gpsd. Sentences of the receiver
  /// between them count too.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

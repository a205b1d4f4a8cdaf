#include <waymark/formats/logs/detail/nmea/nmea.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/kind_tally.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/nmea/nmea_epoch.hpp>
#include <waymark/formats/logs/detail/nmea/nmea_notes.hpp>
#include <waymark/formats/logs/detail/nmea/nmea_sentence.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kMostUndated = 4096;  ///< fixes that wait for the first date

class NmeaDecoder final : public LineDecoder {
 public:
  NmeaDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request), positions_(path, request, nullptr) {
    if (request.date) day_ = request.date->nanoseconds / kDayNanoseconds;
    dated_ = request.date.has_value();
  }

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void pause() override { end_epoch(); }
  void end() override;
  void take_sentence(const NmeaSentence& sentence, std::string_view line, std::size_t number);
  [[nodiscard]] bool is_whole(const NmeaSentence& sentence, NmeaKind kind, std::size_t column,
                              std::size_t number);
  [[nodiscard]] bool begins_epoch(NmeaKind kind, std::optional<std::int64_t> time) const;
  void end_epoch();
  [[nodiscard]] bool rests_on_no_satellite(const NmeaEpoch& epoch);
  void count_days(const NmeaEpoch& epoch);
  void add_fix(const NmeaEpoch& epoch);
  [[nodiscard]] StatedAccuracy accuracy(const NmeaEpoch& epoch);
  void give(GeodeticFix fix);
  void release_undated();
  [[noreturn]] void fail_undated() const;

  PositionStream positions_;
  KindTally tally_;
  NmeaCounts counts_;
  bool checksums_ = false;        ///< a sentence had a right checksum
  bool satellites_told_ = false;  ///< a fix had satellites
  NmeaEpoch epoch_;

  /// The day of the last fix. It counts from 1970-01-01 if dated_, or else from the first fix.
  std::int64_t day_ = 0;
  bool dated_ = false;
  std::optional<std::int64_t> last_time_of_day_;
  std::vector<GeodeticFix> undated_;  ///< their stamps count from the midnight before the first fix
};

void NmeaDecoder::take_line(std::string_view line, std::size_t number) {
  std::string_view rest = line;
  std::size_t sentences = 0;
  while (const std::optional<NmeaSentence> sentence = next_nmea_sentence(rest)) {
    // Without a checksum a sentence counts only at the beginning of a line, because comments name
    // sentences too.
    const bool begins = sentence->address.data() == line.data() + 1;
    if (sentence->checksum == NmeaChecksum::none && !begins) continue;
    ++sentences;
    take_sentence(*sentence, line, number);
  }
  if (sentences == 0 && line.find_first_not_of(" \t\r") != std::string_view::npos) ++counts_.not_sentences;
}

void NmeaDecoder::take_sentence(const NmeaSentence& sentence, std::string_view line, std::size_t number) {
  const auto column_of = [&](std::string_view part) {
    return part.data() == nullptr ? 1 : static_cast<std::size_t>(part.data() - line.data()) + 1;
  };
  const NmeaKind kind = nmea_kind(sentence.address);
  if (!is_whole(sentence, kind, column_of(sentence.address), number)) return;
  tally_.add(sentence.address);
  if (kind == NmeaKind::other || (kind == NmeaKind::gsa && epoch_.hdop)) return;
  const NmeaFields fields(sentence.fields);
  try {
    const std::optional<std::int64_t> time = nmea_time(kind, fields);
    if (begins_epoch(kind, time) || places_elsewhere(kind, fields, epoch_)) {
      end_epoch();
      epoch_.time_of_day = time;
    }
    add_to_epoch(kind, fields, number, epoch_);
  } catch (const BadNmeaField& bad) {
    ++data_.records;
    corrupt(number, column_of(bad.field), fmt::format("{}: {}", sentence.address, bad.what));
  }
}

/// Checks the checksum. A damaged sentence is corrupt if it is of a kind that is read.
bool NmeaDecoder::is_whole(const NmeaSentence& sentence, NmeaKind kind, std::size_t column,
                           std::size_t number) {
  if (sentence.checksum == NmeaChecksum::right) {
    checksums_ = true;
    return true;
  }
  if (sentence.checksum == NmeaChecksum::none && !checksums_) {
    if (kind != NmeaKind::other) ++counts_.without_checksum;
    return true;
  }
  if (kind == NmeaKind::other || kind == NmeaKind::gsa) {
    ++counts_.other_wrong_checksums;
    return false;
  }
  ++data_.records;
  corrupt(number, column,
          sentence.checksum == NmeaChecksum::none
              ? fmt::format("{}: the sentence ends before its checksum", sentence.address)
              : fmt::format("{}: wrong checksum: the sentence states {:02X}, its characters give {:02X}",
                            sentence.address, sentence.expected, sentence.found));
  return false;
}

bool NmeaDecoder::begins_epoch(NmeaKind kind, std::optional<std::int64_t> time) const {
  if (time) return time != epoch_.time_of_day;
  // Receivers leave the time empty until they know it. Then a kind that comes again begins
  // a new epoch.
  const bool leads = kind == NmeaKind::rmc || kind == NmeaKind::gga || kind == NmeaKind::gns;
  if (epoch_.time_of_day) return leads;
  return (leads || kind == NmeaKind::gll) && epoch_.has(kind);
}

void NmeaDecoder::end_epoch() {
  const NmeaEpoch epoch = std::exchange(epoch_, {});
  if (!epoch.is_record()) return;
  ++data_.records;
  if (epoch.without_fix) {
    ++data_.without_fix;
  } else if (epoch.position.kind == NmeaKind::other) {
    ++data_.without_fix;  // GNS with a mode and an empty position
  } else if (rests_on_no_satellite(epoch)) {
    ++data_.without_fix;
    ++counts_.without_satellites;
  } else if (!epoch.time_of_day) {
    ++counts_.without_time;
  } else {
    count_days(epoch);
    add_fix(epoch);
  }
}

/// Some receivers keep stating a fix after they have lost all satellites, and repeat the last
/// position. The receiver in Munich's Petuelring tunnel did so for 19 s before it stated "no fix".
/// Converters that do not know the number always write 0; for them it means nothing.
bool NmeaDecoder::rests_on_no_satellite(const NmeaEpoch& epoch) {
  if (!epoch.satellites || epoch.quality >= FixQuality::dead_reckoned) return false;
  satellites_told_ = satellites_told_ || *epoch.satellites > 0;
  return satellites_told_ && *epoch.satellites == 0;
}

/// Sets day_ to the day of this epoch.
void NmeaDecoder::count_days(const NmeaEpoch& epoch) {
  const std::int64_t time = *epoch.time_of_day;
  if (last_time_of_day_ && *last_time_of_day_ - time > kDayNanoseconds / 2) {
    day_ = std::min(day_ + 1, kLastNmeaDay + 1);  // beyond it, add_fix refuses
    ++counts_.midnights;
  }
  last_time_of_day_ = time;
  if (time >= kDayNanoseconds) ++counts_.leap_seconds;
  if (!epoch.day) return;
  if (!dated_) {
    const std::int64_t first_day = *epoch.day - day_;
    for (GeodeticFix& fix : undated_) fix.stamp.nanoseconds += first_day * kDayNanoseconds;
    counts_.dated_backwards = undated_.size();
    dated_ = true;
    release_undated();
  }
  counts_.log_has_date = true;
  day_ = *epoch.day;
}

void NmeaDecoder::add_fix(const NmeaEpoch& epoch) {
  if (day_ > kLastNmeaDay || day_ < -kLastNmeaDay)
    return corrupt(epoch.position.line, 1, "so many midnights have passed that the date is after 2200");
  GeodeticFix fix;
  fix.told.quality = epoch.quality;
  if (epoch.satellites && *epoch.satellites >= 0 && *epoch.satellites < 1000)
    fix.told.satellites = static_cast<int>(*epoch.satellites);
  fix.told.hdop = epoch.hdop.value_or(0);
  fix.told.correction_age_s = epoch.correction_age_s.value_or(fix.told.correction_age_s);
  if (const char* complaint = positions_.set_covariance(fix, accuracy(epoch)))
    return corrupt(epoch.position.line, 1, complaint);
  fix.stamp.nanoseconds = day_ * kDayNanoseconds + *epoch.time_of_day;
  fix.latitude_deg = epoch.position.latitude_deg;
  fix.longitude_deg = epoch.position.longitude_deg;
  if (epoch.altitude_m) {
    fix.height_m = *epoch.altitude_m + epoch.geoid_separation_m.value_or(0);
    if (!epoch.geoid_separation_m) ++counts_.above_sea_level;
  }
  if (epoch.course_deg) fix.course_rad = *epoch.course_deg * kDegree;
  fix.speed_mps = epoch.speed_mps;
  fix.line = epoch.position.line;

  ++counts_.fixes;
  if (epoch.quality == FixQuality::dead_reckoned) ++counts_.dead_reckoning;
  if (epoch.quality > FixQuality::dead_reckoned) ++counts_.simulated;
  counts_.decimals = std::max(counts_.decimals, epoch.position.decimals);
  if (dated_) return give(fix);
  if (undated_.size() == kMostUndated) fail_undated();
  undated_.push_back(fix);
}

StatedAccuracy NmeaDecoder::accuracy(const NmeaEpoch& epoch) {
  if (!epoch.accuracy || positions_.wants_truth()) return {};
  const NmeaAccuracy& gst = *epoch.accuracy;
  ++counts_.from_gst;
  if (gst.has_ellipse) ++counts_.from_ellipse;
  if (gst.ellipse_disagrees) ++counts_.ellipse_disagrees;
  const double common = gst.correlation * gst.east_m * gst.north_m;
  Eigen::Matrix2d squares;
  squares << gst.east_m * gst.east_m, common, common, gst.north_m * gst.north_m;
  return {.squares_en = squares};
}

/// Delivers a fix whose stamp is UTC.
void NmeaDecoder::give(GeodeticFix fix) {
  const std::optional<Stamp> stamp = positions_.stamp(fix.stamp, TimeScale::utc);
  if (!stamp) return corrupt(fix.line, 1, "its time is too large for a stamp");
  fix.stamp = *stamp;
  positions_.give(data_, fix);
}

void NmeaDecoder::release_undated() {
  for (const GeodeticFix& fix : undated_) give(fix);
  undated_.clear();
  undated_.shrink_to_fit();
}

void NmeaDecoder::fail_undated() const {
  throw InputError(
      fmt::format("{}: none of the first {} fixes has a date (RMC and ZDA sentences give one); state that of "
                  "the first record, such as `time: {{date: 2009-04-01}}`",
                  path(), undated_.size()));
}

void NmeaDecoder::end() {
  end_epoch();
  if (!undated_.empty()) fail_undated();
  data_.kinds = tally_.counts();
  for (const std::string& text : nmea_notes(counts_, request())) note(text);
  positions_.finish(data_);
}

}  // namespace

std::unique_ptr<LogDecoder> NmeaReader::open(const std::string& path, const LogRequest& request) const {
  require_positions(path, request, "an NMEA log");
  return std::make_unique<NmeaDecoder>(path, request);
}

Recognition NmeaReader::recognise(std::string_view head) const {
  HeadLines lines(head);
  std::size_t right = 0;
  std::size_t bare = 0;
  while (lines.next()) {
    std::string_view line = lines.line();
    bool is_right = false;
    bool is_bare = false;
    while (const std::optional<NmeaSentence> sentence = next_nmea_sentence(line)) {
      is_right = is_right || sentence->checksum == NmeaChecksum::right;
      is_bare = is_bare ||
                (sentence->checksum == NmeaChecksum::none && nmea_kind(sentence->address) != NmeaKind::other);
    }
    right += is_right ? 1 : 0;
    bare += is_bare ? 1 : 0;
  }
  // Some loggers leave all checksums out.
  if (right == 0 && bare > 0)
    return lines.share(bare, "are NMEA sentences of known kinds without a checksum");
  return lines.share(right, "are NMEA sentences with a right checksum");
}

}  // namespace waymark::formats

#include <waymark/formats/logs/detail/gpsd/gpsd_json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/kind_tally.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/gpsd/gpsd_accuracy.hpp>
#include <waymark/formats/logs/detail/gpsd/gpsd_report.hpp>
#include <waymark/formats/logs/detail/nmea/nmea_sentence.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::formats {
namespace {

double required(const GpsdReport& report, GpsdNumber key, const char* name, double limit) {
  const std::optional<double> value = report.number(key);
  if (!value) throw BadGpsdMember{fmt::format("TPV: a fix without '{}'", name)};
  if (std::abs(*value) > limit)
    throw BadGpsdMember{fmt::format("TPV: '{}' {} is outside {} .. {}", name, *value, -limit, limit)};
  return *value;
}

std::optional<double> scaled(std::optional<double> value, double factor) {
  if (value) *value *= factor;
  return value;
}

std::optional<double> scaled_if_positive(std::optional<double> value, double factor) {
  return value && *value > 0 ? scaled(value, factor) : std::nullopt;
}

/// Returns a text that may be a release, "3.25" or "3.20.1~dev"; empty for others.
std::string release_text(const std::string& text) {
  constexpr std::size_t kLongest = 40;
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
  return plain && text.size() <= kLongest ? text : std::string();
}

/// Returns the number of a member in a line; NaN: it has none. A SKY has a list of satellites, and reading it
/// as JSON would take longer than all fixes.
double member_of(std::string_view line, std::string_view name_and_colon) {
  const std::size_t at = line.find(name_and_colon);
  if (at == std::string_view::npos) return kNoNumber;
  const std::string_view rest = line.substr(at + name_and_colon.size());
  return field_number(rest.substr(0, rest.find_first_of(",}"))).value_or(kNoNumber);
}

/// Returns what a SKY tells. gpsd may send the dilutions and the satellites in two of them.
FixDetails sky_of(std::string_view line, const FixDetails& before) {
  FixDetails told = before;
  constexpr std::size_t kBeforeSatellites = 300;  // the list follows, and is long
  line = line.substr(0, kBeforeSatellites);
  constexpr double kLargest = 99;  // 99.99: not known
  if (const double hdop = member_of(line, "hdop\":"); hdop > 0 && hdop < kLargest) told.hdop = hdop;
  if (const double used = member_of(line, "uSat\":"); used >= 0 && used < 1000)
    told.satellites = static_cast<int>(used);
  return told;
}

/// Counts for the notes.
struct Counts {
  std::size_t not_json = 0;
  std::size_t without_time = 0;
  std::size_t other_devices = 0;
  std::size_t dead_reckoning = 0;
  std::size_t simulated = 0;
  std::size_t above_sea_level = 0;
};

class GpsdDecoder final : public LineDecoder {
 public:
  GpsdDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request), positions_(path, request, nullptr) {}

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;
  void take_report(GpsdReport report, std::size_t line_number);
  void end_epoch();
  void add_sample(const GpsdReport& report, Stamp utc);
  void count_status(const GpsdReport& report);
  [[nodiscard]] FixDetails details_of(const GpsdReport& report) const;
  [[nodiscard]] const GpsdReport* gst_of(const GpsdReport& report) const;
  void add_notes();

  PositionStream positions_;
  KindTally tally_;
  Counts counts_;
  GpsdAccuracy accuracy_;
  bool empty_ = true;
  std::string release_;  ///< of gpsd, from VERSION
  std::string device_;   ///< the one that is read

  std::optional<GpsdReport> epoch_;  ///< the merged TPV of the current epoch
  std::size_t epoch_line_ = 0;
  /// The last two GST objects. The GST of an epoch comes before or after its TPV. If it comes
  /// after, the next GST may have come too.
  std::array<GpsdReport, 2> gst_;
  FixDetails sky_;  ///< HDOP and satellites of the last SKY
};

void GpsdDecoder::take_line(std::string_view line, std::size_t number) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string_view::npos) return;
  empty_ = false;
  if (line[start] != '{') {
    ++counts_.not_json;
    return;
  }
  // Most objects of a log are not read. In the form that gpsd writes, their class shows this
  // without parsing.
  const std::string_view named = gpsd_class(line);
  if (named == "SKY") sky_ = sky_of(line, sky_);
  if (!named.empty() && named != "TPV" && named != "GST" && named != "VERSION") return tally_.add(named);
  try {
    GpsdReport report = read_gpsd_report(line);
    if (!report.kind.empty()) tally_.add(report.kind);
    if (report.kind == "VERSION") release_ = release_text(report.release);
    if (report.kind == "TPV")
      take_report(std::move(report), number);
    else if (report.kind == "GST")
      gst_ = {std::move(report), std::move(gst_[0])};
  } catch (const BadGpsdLine& bad) {
    ++data_.records;
    corrupt(number, bad.column, bad.what);
  }
}

void GpsdDecoder::take_report(GpsdReport report, std::size_t line_number) {
  if (device_.empty() && !report.time.empty()) device_ = report.device;
  if (!report.device.empty() && !device_.empty() && report.device != device_) {
    ++counts_.other_devices;
    return;
  }
  if (epoch_ && !report.time.empty() && epoch_->time == report.time) {
    epoch_->update(report);
  } else {
    end_epoch();
    epoch_ = std::move(report);
  }
  epoch_line_ = line_number;
}

void GpsdDecoder::end_epoch() {
  if (!epoch_) return;
  const GpsdReport report = *std::exchange(epoch_, std::nullopt);
  ++data_.records;
  try {
    if (report.number(GpsdNumber::mode).value_or(0) < 2) {
      ++data_.without_fix;
      return;
    }
    if (report.time.empty()) {
      ++counts_.without_time;
      return;
    }
    const std::optional<Stamp> stamp = stamp_from_iso8601(report.time);
    if (!stamp)
      throw BadGpsdMember{
          fmt::format("TPV: expected an ISO 8601 date for 'time', got {}", quote_field(report.time))};
    add_sample(report, *stamp);
  } catch (const BadGpsdMember& bad) {
    corrupt(epoch_line_, 1, bad.what);
  }
}

void GpsdDecoder::add_sample(const GpsdReport& report, Stamp utc) {
  const std::optional<Stamp> stamp = positions_.stamp(utc, TimeScale::utc);
  if (!stamp) throw BadGpsdMember{"TPV: its time is too large for a stamp"};
  const double latitude = required(report, GpsdNumber::lat, "lat", 90);
  const double longitude = required(report, GpsdNumber::lon, "lon", 180);
  std::optional<double> height = report.number(GpsdNumber::alt_hae);
  const bool above_sea_level = !height;
  if (!height) height = report.number(GpsdNumber::alt);
  if (above_sea_level && height) ++counts_.above_sea_level;
  GeodeticFix fix;
  fix.stamp = *stamp;
  fix.latitude_deg = latitude;
  fix.longitude_deg = longitude;
  if (height) fix.height_m = *height;
  fix.course_rad = scaled(report.number(GpsdNumber::track), kDegree);
  fix.course_sigma_rad = scaled_if_positive(report.number(GpsdNumber::epd), kDegree / 2);
  fix.speed_mps = report.number(GpsdNumber::speed);
  fix.speed_sigma_mps = scaled_if_positive(report.number(GpsdNumber::eps), 0.5);
  fix.line = epoch_line_;
  fix.told = details_of(report);
  StatedAccuracy accuracy;
  if (!positions_.wants_truth()) accuracy = accuracy_.of(report, gst_of(report), request().accuracy);
  if (const char* complaint = positions_.add(data_, fix, accuracy))
    throw BadGpsdMember{fmt::format("TPV: {}", complaint)};
  count_status(report);
}

FixDetails GpsdDecoder::details_of(const GpsdReport& report) const {
  constexpr std::array kQualities{FixQuality::unknown, FixQuality::single,   FixQuality::differential,
                                  FixQuality::fixed,   FixQuality::floating, FixQuality::dead_reckoned,
                                  FixQuality::single,  FixQuality::manual,   FixQuality::simulated};
  FixDetails told = sky_;
  // gpsd leaves out a normal fix's status: it is not told.
  const double status = report.number(GpsdNumber::status).value_or(0);
  if (status >= 0 && status < kQualities.size()) told.quality = kQualities[static_cast<std::size_t>(status)];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  told.correction_age_s = report.number(GpsdNumber::dgps_age).value_or(nan);
  return told;
}

void GpsdDecoder::count_status(const GpsdReport& report) {
  constexpr double kDeadReckoning = 5;
  constexpr double kSimulated = 8;
  const double status = report.number(GpsdNumber::status).value_or(0);
  if (status == kDeadReckoning) ++counts_.dead_reckoning;
  if (status == kSimulated) ++counts_.simulated;
}

const GpsdReport* GpsdDecoder::gst_of(const GpsdReport& report) const {
  for (const GpsdReport& gst : gst_) {
    if (gst.time == report.time && gst.device == report.device) return &gst;
  }
  return nullptr;
}

void GpsdDecoder::end() {
  if (empty_) throw EmptyLogError(fmt::format("{}: the log is empty", path()));
  end_epoch();
  data_.kinds = tally_.counts();
  add_notes();
}

void GpsdDecoder::add_notes() {
  for (const std::string& text : accuracy_.notes(release_, request().accuracy)) note(text);
  if (counts_.above_sea_level > 0)
    note(fmt::format("{} heights are above mean sea level (no altHAE)", counts_.above_sea_level));
  if (counts_.not_json > 0)
    note(fmt::format("{} lines that are no JSON objects were skipped", counts_.not_json));
  if (counts_.without_time > 0)
    note(fmt::format("{} fixes without a time were skipped", counts_.without_time));
  if (counts_.dead_reckoning > 0)
    note(fmt::format("{} fixes are dead reckoning of the receiver, not measured", counts_.dead_reckoning));
  if (counts_.simulated > 0) note(fmt::format("{} fixes are marked as simulated", counts_.simulated));
  if (counts_.other_devices > 0)
    note(fmt::format("{} reports of other devices than {} were skipped", counts_.other_devices,
                     quote_field(device_)));
  positions_.finish(data_);
}

// gpspipe -r and the regression outputs of gpsd contain the receiver's sentences between
// the objects.
}  // namespace

std::unique_ptr<LogDecoder> GpsdJsonReader::open(const std::string& path, const LogRequest& request) const {
  require_positions(path, request, "a gpsd log");
  return std::make_unique<GpsdDecoder>(path, request);
}

Recognition GpsdJsonReader::recognise(std::string_view head) const {
  HeadLines lines(head);
  std::size_t objects = 0;
  std::size_t sentences = 0;
  bool positions = false;
  while (lines.next()) {
    std::string_view line = lines.line();
    if (const std::string_view kind = gpsd_class(line); !kind.empty()) {
      ++objects;
      positions = positions || kind == "TPV";
    } else if (const auto sentence = next_nmea_sentence(line);
               sentence && sentence->checksum == NmeaChecksum::right) {
      ++sentences;
    }
  }
  if (!positions || sentences == 0) return lines.share(objects, "are gpsd's JSON objects");
  // gpspipe -r and gpsd's regression outputs have the receiver's sentences between the objects
  // made of them.
  return lines.share(objects + sentences,
                     fmt::format("are gpsd's JSON objects, or NMEA sentences between them ({})", sentences));
}

}  // namespace waymark::formats

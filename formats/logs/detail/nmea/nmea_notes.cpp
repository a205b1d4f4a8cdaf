#include <waymark/formats/logs/detail/nmea/nmea_notes.hpp>

#include <cmath>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/accuracy.hpp>

namespace waymark::formats {
namespace {

void note_dates(const NmeaCounts& counts, const LogRequest& request, std::vector<std::string>& notes) {
  if (counts.dated_backwards > 0)
    notes.push_back(
        fmt::format("{} fixes before the first date take the day from it", counts.dated_backwards));
  if (request.date && counts.fixes > 0)
    notes.emplace_back(
        counts.log_has_date
            ? "the log gives its date itself; the stated one counts before the log's first only"
            : "the log gives no date, the stated one is that of its first fix");
  if (counts.midnights > 0)
    notes.push_back(
        fmt::format("the time of day jumps back by more than 12 h {} times, which is taken for midnight",
                    counts.midnights));
  if (counts.leap_seconds > 0)
    notes.push_back(
        fmt::format("{} fixes in a leap second are stamped as one second later", counts.leap_seconds));
  if (counts.without_time > 0)
    notes.push_back(fmt::format("{} fixes without a time of day were skipped", counts.without_time));
}

void note_accuracy(const NmeaCounts& counts, const LogRequest& request, std::vector<std::string>& notes) {
  if (counts.from_gst > 0)
    notes.push_back(fmt::format(
        "{} fixes with GST read as {}; {} of them with the correlation of its error ellipse", counts.from_gst,
        request.accuracy == AccuracyMeaning::automatic ? "1sigma" : to_string(request.accuracy),
        counts.from_ellipse));
  if (counts.ellipse_disagrees > 0)
    notes.push_back(fmt::format("{} error ellipses contradict the errors beside them and were ignored",
                                counts.ellipse_disagrees));
}

void note_quality(const NmeaCounts& counts, std::vector<std::string>& notes) {
  if (counts.without_satellites > 0)
    notes.push_back(fmt::format("{} fixes use no satellite and count as records without a fix",
                                counts.without_satellites));
  if (counts.dead_reckoning > 0)
    notes.push_back(
        fmt::format("{} fixes are dead reckoning of the receiver, not measured", counts.dead_reckoning));
  if (counts.simulated > 0)
    notes.push_back(fmt::format("{} fixes are marked as simulated or typed in", counts.simulated));
  if (counts.above_sea_level > 0)
    notes.push_back(
        fmt::format("{} heights are above mean sea level (no geoid separation)", counts.above_sea_level));
  constexpr double kMinute = 1852;              // m along a meridian
  constexpr std::size_t kDecimalsOfAMetre = 4;  // 0.0001' is 0.19 m
  if (counts.fixes > 0 && counts.decimals < kDecimalsOfAMetre)
    notes.push_back(fmt::format("positions are given in steps of {:.2g} m ({} decimals of a minute)",
                                kMinute * std::pow(10, -static_cast<double>(counts.decimals)),
                                counts.decimals));
  if (counts.without_checksum > 0)
    notes.push_back(fmt::format("{} sentences have no checksum and are used", counts.without_checksum));
  if (counts.other_wrong_checksums > 0)
    notes.push_back(fmt::format("{} sentences of unused kinds are damaged (wrong checksum or none)",
                                counts.other_wrong_checksums));
  if (counts.not_sentences > 0)
    notes.push_back(fmt::format("{} lines that hold no NMEA sentence were skipped", counts.not_sentences));
}

}  // namespace

std::vector<std::string> nmea_notes(const NmeaCounts& counts, const LogRequest& request) {
  std::vector<std::string> notes;
  note_dates(counts, request, notes);
  note_accuracy(counts, request, notes);
  note_quality(counts, notes);
  return notes;
}

}  // namespace waymark::formats

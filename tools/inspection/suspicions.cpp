#include <waymark/tools/inspection/suspicions.hpp>

#include <array>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/inspection/log_clock.hpp>

namespace waymark::inspection {
namespace {

constexpr double kRollover = 1024 * 604800.0;
constexpr double kGpsEpoch = 315964800;  // in seconds since the Unix epoch
constexpr double kLeapSeconds = 18;
constexpr double kYear = 365.25 * 86400;
constexpr double kYear2000 = 946684800;
constexpr std::size_t kFewComparisons = 20;
constexpr double kHighest = 6000, kLowest = -500;  // m, limits for roads

/// Returns "line 12, 2021-07-26T04:40:55.124Z".
std::string place(const Sighting& seen, const LogClock& clock) {
  const std::string when = date_text(seen.stamp, clock);
  return seen.line == 0 ? "at " + when : fmt::format("in record {}, {}", seen.line, when);
}

std::string times(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

void judge_clock(const StampSeries& stamps, const LogInspection& log, const std::string& what,
                 std::vector<std::string>& sentences) {
  const LogClock& clock = log.clock;
  if (const Sighting& back = stamps.backwards(); back.count > 0)
    sentences.push_back(fmt::format("the clock of the {} goes backwards {}, first {} by {:.6g} s", what,
                                    times(back.count), place(back, clock), back.amount));
  if (const Sighting& twice = stamps.duplicates(); twice.count > 0)
    sentences.push_back(fmt::format("a stamp of the {} equals the one before {}, first {}", what,
                                    times(twice.count), place(twice, clock)));
  if (const Sighting& jump = stamps.jumps(); jump.count > 0)
    sentences.push_back(fmt::format("the clock of the {} jumps by more than an hour {}, first {} by {:.6g} s",
                                    what, times(jump.count), place(jump, clock), jump.amount));
}

void judge_date(const LogInspection& log, Stamp now, std::vector<std::string>& sentences) {
  const StampSeries* span = log.span();
  if (span == nullptr || !log.clock.dated) return;
  const double first = on_scale(span->earliest(), log.clock.scale, TimeScale::utc).seconds();
  const double latest = now.seconds() + kYear;
  if (first >= kYear2000 && first <= latest) return;
  std::string sentence = fmt::format("the first stamp is {}, {}", date_text(span->earliest(), log.clock),
                                     first < kYear2000 ? "before 2000" : "in the future");
  const double other = first + (first < kYear2000 ? kRollover : -kRollover);
  if (other >= kYear2000 && other <= latest) {
    const LogClock utc;
    sentence += fmt::format(": if the receiver is wrong by 1024 weeks, the date is {}",
                            date_text(Stamp::from_seconds(other), utc));
  }
  sentences.push_back(sentence);
}

void judge_places(const FixSummary& fixes, const LogClock& clock, std::vector<std::string>& sentences) {
  if (fixes.zero.count > 0)
    sentences.push_back(fmt::format("{} fixes are at latitude 0, longitude 0, first {}", fixes.zero.count,
                                    place(fixes.zero, clock)));
  if (fixes.far.count > 0)
    sentences.push_back(
        fmt::format("{} fixes are more than 1000 km from the others, first {}, {:.0f} km away",
                    fixes.far.count, place(fixes.far, clock), fixes.far.amount / 1000));
  const bool never_elsewhere = fixes.repeated == fixes.repeated_in_frozen;
  if (fixes.frozen_moving.count > 0) {
    sentences.push_back(fmt::format(
        "the position is constant for 5 fixes or more although the receiver's speed is above 1 m/s "
        "{}, first {} for {:.0f} fixes",
        times(fixes.frozen_moving.count), place(fixes.frozen_moving, clock), fixes.frozen_moving.amount));
  } else if (fixes.frozen.count > 0 && never_elsewhere && fixes.with_speed == 0 &&
             4 * fixes.repeated < fixes.fixes) {
    sentences.push_back(
        fmt::format("the position is constant for 5 fixes or more {}, first {} for {:.0f} fixes, "
                    "and changes with every other fix: the receiver repeats its last position, or "
                    "the vehicle stands",
                    times(fixes.frozen.count), place(fixes.frozen, clock), fixes.frozen.amount));
  }
  if (fixes.height.count > 0 && (fixes.height.largest > kHighest || fixes.height.smallest < kLowest))
    sentences.push_back(fmt::format("heights reach from {:.1f} to {:.1f} m, beyond all roads",
                                    fixes.height.smallest, fixes.height.largest));
  if (fixes.resolution_m >= 1)
    sentences.push_back(
        fmt::format("positions are written in steps of {:.2g} m (to the north): they have too few digits",
                    fixes.resolution_m));
}

void judge_accuracy(const FixSummary& fixes, bool is_named, std::vector<std::string>& sentences) {
  if (fixes.with_accuracy < kFewComparisons) return;
  if (fixes.accuracy_constant)
    sentences.push_back(fmt::format("the accuracy never changes: sigma is {:.4g} m in all {} fixes",
                                    fixes.east.median, fixes.with_accuracy));
  else if (fixes.axes_equal && !is_named)
    sentences.emplace_back(
        "east and north have the same accuracy in every fix, so it is a radius and no sigma per "
        "axis; state its 'meaning' under 'accuracy'");
  if (fixes.east.median < 0.02)
    sentences.push_back(fmt::format("half of the fixes claim a sigma below {:.3g} m, which only RTK reaches",
                                    std::max(fixes.east.median, 1e-3)));
}

struct SpeedUnit {
  double factor;
  const char* text;
};

void judge_speed(const FixSummary& fixes, std::vector<std::string>& sentences) {
  static constexpr std::array kMistakenUnits{
      SpeedUnit{3.6, "km/h were read as m/s"},       SpeedUnit{1 / 3.6, "m/s were read as km/h"},
      SpeedUnit{1.943844, "knots were read as m/s"}, SpeedUnit{0.514444, "m/s were read as knots"},
      SpeedUnit{2.236936, "mph were read as m/s"},   SpeedUnit{0.44704, "m/s were read as mph"}};
  if (fixes.speed_comparisons < kFewComparisons) return;
  for (const SpeedUnit& unit : kMistakenUnits) {
    if (std::abs(fixes.speed_factor / unit.factor - 1) > 0.06) continue;
    sentences.push_back(
        fmt::format("the receiver's speed is {:.3g} times the speed of its positions (median of {}): {}",
                    fixes.speed_factor, fixes.speed_comparisons, unit.text));
    return;
  }
  if (fixes.speed_factor > 1.4 || fixes.speed_factor < 1 / 1.4)
    sentences.push_back(
        fmt::format("the receiver's speed is {:.3g} times the speed of its positions (median of {})",
                    fixes.speed_factor, fixes.speed_comparisons));
}

void judge_odometry(const OdometrySummary& odometry, std::vector<std::string>& sentences) {
  if (odometry.yaw_rate_driving > 1)
    sentences.push_back(fmt::format(
        "{} exceeds {:.3g} rad/s ({:.3g} deg/s) in 5 % of the drive: probably deg/s are read as rad/s",
        odometry.yaw_channel, odometry.yaw_rate_driving, odometry.yaw_rate_driving * 57.29578));
  for (const ChannelSummary& channel : odometry.channels) {
    if (channel.name == "speed" && channel.percent95 > 75)
      sentences.push_back(fmt::format(
          "speed exceeds {:.3g} m/s in 5 % of the drive: probably km/h are read as m/s", channel.percent95));
  }
}

}  // namespace

std::vector<std::string> suspicions_of(const LogInspection& log, Stamp now) {
  std::vector<std::string> sentences;
  judge_date(log, now, sentences);
  if (log.fixes) {
    const FixSummary& fixes = *log.fixes;
    judge_clock(fixes.stamps, log, "fixes", sentences);
    if (2 * log.without_fix > log.records)
      sentences.push_back(
          fmt::format("the receiver has no fix in {} of {} records", log.without_fix, log.records));
    judge_places(fixes, log.clock, sentences);
    const bool is_named =
        named_meaning(proposed_columns(log, StreamKind::gnss)) != AccuracyMeaning::automatic;
    judge_accuracy(fixes, is_named, sentences);
    judge_speed(fixes, sentences);
  }
  if (log.odometry) {
    const bool same_rows = log.table && log.fixes;
    if (!same_rows) judge_clock(log.odometry->stamps, log, "odometry", sentences);
    judge_odometry(*log.odometry, sentences);
  } else if (log.can && !log.fixes) {
    const Sighting& back = log.can->stamps.backwards();
    if (back.count > 0)
      sentences.push_back(fmt::format("the logger's clock goes backwards {}, first {} by {:.6g} s",
                                      times(back.count), place(back, log.clock), back.amount));
  }
  if (10 * log.corrupt > log.records)
    sentences.push_back(fmt::format("{} of {} records are corrupt", log.corrupt, log.records));
  if (log.logger_ahead_s && std::abs(*log.logger_ahead_s) > 0.5)
    sentences.push_back(fmt::format("the logger's clock is {:.3f} s {} of the GNSS time in the log (median)",
                                    std::abs(*log.logger_ahead_s),
                                    *log.logger_ahead_s > 0 ? "ahead" : "behind"));
  return sentences;
}

std::string suspicion_between(const LogInspection& log, const LogInspection& other) {
  const StampSeries* a = log.span();
  const StampSeries* b = other.span();
  if (a == nullptr || b == nullptr) return {};
  if (log.clock.dated != other.clock.dated)
    return fmt::format("its stamps cannot be compared with the stamps of {}: only one of the logs has dates",
                       other.path);
  const auto seconds = [](Stamp stamp, const LogClock& clock) {
    return (clock.dated ? on_scale(stamp, clock.scale, TimeScale::utc) : stamp).seconds();
  };
  const double behind = seconds(a->earliest(), log.clock) - seconds(b->latest(), other.clock);
  const double before = seconds(b->earliest(), other.clock) - seconds(a->latest(), log.clock);
  if (behind <= 0 && before <= 0) return {};
  const double start = seconds(a->earliest(), log.clock) - seconds(b->earliest(), other.clock);
  std::string sentence = fmt::format(
      "it does not overlap with {}: it {} {:.3f} s {} that {}, and its start is {:.3f} s {}", other.path,
      behind > 0 ? "begins" : "ends", std::max(behind, before), behind > 0 ? "after" : "before",
      behind > 0 ? "ends" : "begins", std::abs(start), start > 0 ? "later" : "earlier");
  const double length = std::max(a->span_s(), b->span_s());
  const auto near = [&](double shift) { return std::abs(std::abs(start) - shift) <= length; };
  if (near(kGpsEpoch))
    sentence += " (315964800 s lie between the GPS epoch of 1980 and the Unix epoch of 1970)";
  else if (near(kRollover))
    sentence += " (GPS weeks restart after 1024 weeks, which are 619315200 s)";
  else if (std::abs(std::abs(start) - kLeapSeconds) < 2)
    sentence += " (GPS time is 18 s ahead of UTC since 2017)";
  return sentence;
}

}  // namespace waymark::inspection

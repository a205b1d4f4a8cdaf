#include <waymark/tools/drive/clocks/odometry_check.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include <waymark/tools/drive/clocks/lag_search.hpp>
#include <waymark/tools/drive/clocks/late_quantity.hpp>
#include <waymark/tools/drive/clocks/offset_names.hpp>
#include <waymark/tools/drive/comparison/misreading.hpp>
#include <waymark/tools/drive/comparison/plausibility.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {
namespace {

/// The default model finds fixes that are late by less than the first of these itself. Odometry that is late it
/// finds in part only, because receivers are not early.
constexpr double kLateFixes_s = 0.3;
constexpr double kLateOdometry_s = 0.2;
constexpr double kFits = 0.5;  // correlation

bool is_near_zero(double late_s) {
  return late_s > -kLateFixes_s && late_s < kLateOdometry_s;
}

/// Returns the offset of the clock of an odometry to that of a receiver, wherever it is; empty near zero.
std::optional<ClockOffset> offset_to(const std::vector<OdometrySample>& odometry,
                                     const std::vector<Fix>& fixes) {
  const std::optional<ClockOffset> offset = estimate_clock_offsets(odometry, fixes, {}).common();
  if (!offset || !offset->is_significant() || is_near_zero(offset->late_s)) return std::nullopt;
  return offset->correlation > kFits ? offset : std::nullopt;
}

/// Takes what one more receiver says. The best known one stands. @returns whether it is that of those before
bool take(const ClockOffset& offset, std::optional<ClockOffset>& shown) {
  if (shown && !shown->may_be(offset)) return false;
  if (!shown || offset.sigma_s < shown->sigma_s) shown = offset;
  return true;
}

/// Returns the fixes between the first and the last sample of an odometry whose stamps are late.
std::vector<Fix> within(const std::vector<OdometrySample>& samples, const std::vector<Fix>& fixes,
                        double late_s = 0) {
  std::vector<Fix> result;
  for (const Fix& fix : fixes) {
    const Stamp by_odometry = fix.stamp.later(late_s);
    if (by_odometry >= samples.front().stamp && by_odometry <= samples.back().stamp) result.push_back(fix);
  }
  return result;
}

/// What a receiver says of the clock of an odometry.
struct ClockVerdict {
  std::optional<ClockOffset> offset;  ///< empty: it shows none
  std::optional<Lag> near;            ///< the best fit near zero, if the motion of both tells
  bool fits = false;                  ///< near zero, and nowhere better
};

constexpr std::size_t kFewestCompared = 30;  // fixes, and samples

/// Compares the neighbourhood of zero with a minute about it, and with everything if nothing fits at zero.
ClockVerdict clock_verdict(const std::vector<OdometrySample>& odometry, const std::vector<Fix>& fixes) {
  constexpr double kFar_s = 60;
  constexpr double kLead = 12;
  if (odometry.size() < kFewestCompared || fixes.size() < kFewestCompared) return {};
  const auto [speeds, turns] = receiver_motion(of_one_receiver(fixes));
  const LagSearch search(odometry, speeds, turns);
  ClockVerdict verdict;
  verdict.near = search.best(-kLateFixes_s, kLateOdometry_s);
  const std::optional<Lag> far = search.best(-kFar_s, kFar_s);
  if (!verdict.near || !far) return verdict;
  const bool is_better = !is_near_zero(far->late_s) && far->score > verdict.near->score + kLead;
  verdict.fits =
      !is_better && std::max(verdict.near->speed_correlation, verdict.near->turn_correlation) > kFits;
  if (verdict.fits) return verdict;
  // Poor fixes spoil the fit where the clocks are right, and a drive that repeats itself fits elsewhere too. But by
  // the right clock logs of one drive share no less of it.
  constexpr double kAbout_s = 0.5;
  constexpr double kAsMany = 0.95;
  const std::optional<ClockOffset> offset = offset_to(odometry, fixes);
  if (!offset) return verdict;
  const std::optional<Lag> there = search.best(offset->late_s - kAbout_s, offset->late_s + kAbout_s);
  const auto shared = static_cast<double>(within(odometry, fixes, offset->late_s).size());
  if (there && there->score > verdict.near->score + kLead &&
      shared >= kAsMany * static_cast<double>(fixes.size()))
    verdict.offset = offset;
  return verdict;
}

using Receivers = std::map<int, std::vector<Fix>>;

/// Returns the fixes that count, by receiver.
Receivers receivers_of(const std::vector<Fix>& fixes) {
  Receivers receivers;
  for (const Fix& fix : fixes)
    if (fix.status != FixStatus::withheld) receivers[fix.source].push_back(fix);
  return receivers;
}

/// What each receiver says, by Fix::source.
using ClockVerdicts = std::map<int, ClockVerdict>;

ClockVerdicts clock_verdicts(const std::vector<OdometrySample>& odometry, const std::vector<Fix>& fixes) {
  ClockVerdicts verdicts;
  for (const auto& [source, receiver] : receivers_of(fixes))
    verdicts[source] = clock_verdict(odometry, receiver);
  return verdicts;
}

/// Returns the offset that all receivers show that tell; empty if the odometry fits one of them.
std::optional<ClockOffset> offset_in(const ClockVerdicts& verdicts) {
  std::optional<ClockOffset> shown;
  for (const auto& [source, verdict] : verdicts)
    if (verdict.fits || (verdict.offset && !take(*verdict.offset, shown))) return std::nullopt;
  return shown;
}

/// What the fixes say of one of several odometries.
struct Verdict {
  std::vector<std::string> sentences;
  bool contradicts = false;            ///< clock, unit or sign are wrong
  std::optional<ClockOffset> clock{};  ///< that is wrong
  std::optional<Lag> near{};           ///< how its motion fits near zero
  std::size_t covered = 0;             ///< fixes between its samples, by its right clock
};

/// Returns the offset of a clock that is so far off that it leaves few fixes within the odometry.
std::optional<ClockOffset> far_offset(const std::vector<OdometrySample>& samples,
                                      const Receivers& receivers) {
  std::optional<ClockOffset> shown;
  for (const auto& [source, fixes] : receivers) {
    if (fixes.size() < kFewestCompared) continue;
    const std::optional<ClockOffset> offset = offset_to(samples, fixes);
    if (!offset || !take(*offset, shown)) return std::nullopt;
  }
  return shown;
}

void add_shape(const PreparedOdometry& source, const std::vector<Fix>& receiver, Verdict& verdict) {
  const Timeline timeline = build_timeline(source.samples, receiver, {.gap_s = source.gap_s});
  if (const auto misreading = find_misreading(timeline, receiver, kStands_mps, {})) {
    verdict.sentences.push_back(source.name + ": " + *misreading);
    verdict.contradicts = true;
    return;
  }
  const Shape shape = compare_shapes(receiver, reckoned_antenna(timeline, receiver, kStands_mps));
  for (const std::string& sentence : shape.sentences)
    verdict.sentences.push_back(source.name + ": " + sentence);
  verdict.contradicts = shape.contradicts;
}

/// @param fixes of all receivers, without those withheld
Verdict verdict_on(const PreparedOdometry& source, const std::vector<Fix>& fixes) {
  const std::vector<OdometrySample>& samples = source.samples;
  const std::vector<Fix> compared = within(samples, fixes);
  Verdict verdict;
  const bool is_far = compared.size() < kFewestCompared;
  const ClockVerdicts clocks = clock_verdicts(samples, compared);
  verdict.clock = is_far ? far_offset(samples, receivers_of(fixes)) : offset_in(clocks);
  verdict.covered = within(samples, fixes, verdict.clock ? verdict.clock->late_s : 0).size();
  const auto late = is_far ? std::nullopt : late_quantity_shown(samples, compared, source.yaw_rate_at_rest);
  if (late) {
    verdict.contradicts = verdict.clock || late->late_s > kLateOdometry_s;
    verdict.clock.reset();
    verdict.sentences.push_back(late_quantity_warning(source.name, *late, late->increase()));
    return verdict;
  }
  if (verdict.clock) {
    verdict.contradicts = true;
    verdict.sentences.push_back(clock_warning(
        source.name, *verdict.clock,
        fmt::format("state 'time: {{offset: {:.2f}}}' for its log, or --sync", -verdict.clock->late_s)));
    return verdict;
  }
  if (!is_far && samples.size() >= kFewestCompared) {
    std::vector<Fix> receiver;
    for (const Fix* fix : of_one_receiver(compared)) receiver.push_back(*fix);
    verdict.near = clocks.at(receiver.front().source).near;
    add_shape(source, receiver, verdict);
  }
  // Turns that are far too large wind up, and the fixes no longer tell by how much.
  if (const std::string warning = warning_of_accelerations(samples);
      !verdict.contradicts && !warning.empty()) {
    verdict.sentences.push_back(source.name + ": " + warning);
    verdict.contradicts = true;
  }
  return verdict;
}

/// Tells whether one odometry shows by its own motion that the fault of another one is not that of the fixes.
bool stands_for(const Verdict& other, const Verdict& wrong) {
  constexpr double kAsMany = 0.95;
  if (other.contradicts || !other.near) return false;
  if (static_cast<double>(other.covered) < kAsMany * static_cast<double>(wrong.covered)) return false;
  // Late fixes and mirrored ones are those of both, though a poor odometry does not show it.
  return std::min(other.near->speed_correlation, other.near->turn_correlation) > kFits;
}

}  // namespace

std::optional<ClockOffset> offset_shown(const std::vector<OdometrySample>& odometry,
                                        const std::vector<Fix>& fixes) {
  return offset_in(clock_verdicts(odometry, fixes));
}

std::string clock_warning(const std::string& odometry, const ClockOffset& offset, const std::string& cure) {
  return fmt::format("{}'s clock seems {:.2f} +- {:.2f} s {} against the fixes{}, correlation {:.3f}: {}",
                     odometry, std::abs(offset.late_s), std::hypot(offset.sigma_s, kSmoothing_s),
                     offset.late_s < 0 ? "early" : "late", offset_in_words(offset), offset.correlation, cure);
}

OdometryCheck check_odometries(const PreparedDrive& drive, const std::set<std::string>& suspects) {
  std::vector<Fix> fixes = drive.fixes;
  std::erase_if(fixes, [](const Fix& fix) { return fix.status == FixStatus::withheld; });
  std::vector<Verdict> verdicts;
  for (const PreparedOdometry& source : drive.relative) {
    Verdict& verdict = verdicts.emplace_back(verdict_on(source, fixes));
    const auto turns = drive.report.impossible_turns.find(source.name);
    if (verdict.contradicts || turns == drive.report.impossible_turns.end()) continue;
    verdict.contradicts = true;
    verdict.sentences.push_back(source.name + ": " + turns->second);
  }
  OdometryCheck check;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    Verdict& wrong = verdicts[i];
    const bool is_suspect = suspects.contains(drive.relative[i].name);
    const auto other = std::find_if(verdicts.begin(), verdicts.end(), [&](const Verdict& verdict) {
      return is_suspect ? !verdict.contradicts && 2 * verdict.covered >= wrong.covered
                        : stands_for(verdict, wrong);
    });
    if (wrong.contradicts && other != verdicts.end()) {
      check.left_out.insert(drive.relative[i].name);
      const auto place = static_cast<std::size_t>(other - verdicts.begin());
      wrong.sentences.back() += fmt::format(". It is left out; {} fits", drive.relative[place].name);
    }
    check.warnings.insert(check.warnings.end(), wrong.sentences.begin(), wrong.sentences.end());
  }
  return check;
}

}  // namespace waymark::drive

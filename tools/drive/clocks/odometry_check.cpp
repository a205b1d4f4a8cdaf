#include <waymark/tools/drive/clocks/odometry_check.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <waymark/tools/drive/clocks/lag_search.hpp>
#include <waymark/tools/drive/clocks/offset_names.hpp>
#include <waymark/tools/drive/model/without_source.hpp>
#include <waymark/tools/drive/nodes/plausibility.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {
namespace {

/// The default model finds fixes that are late by less than the first of these itself. Odometry that is late it
/// finds in part only, because receivers are not early.
constexpr double kLateFixes_s = 0.3;
constexpr double kLateOdometry_s = 0.2;

bool is_near_zero(double late_s) {
  return late_s > -kLateFixes_s && late_s < kLateOdometry_s;
}

/// Compares the neighbourhood of zero with a minute about it, and with everything if nothing fits at zero.
bool fits_elsewhere(const LagSearch& search) {
  constexpr double kFar_s = 60;
  constexpr double kLead = 12;
  constexpr double kFits = 0.5;
  const std::optional<Lag> near = search.best(-kLateFixes_s, kLateOdometry_s);
  const std::optional<Lag> far = search.best(-kFar_s, kFar_s);
  if (!near || !far) return false;
  const bool better = !is_near_zero(far->late_s) && far->score > near->score + kLead;
  const bool fits = std::max(near->speed_correlation, near->turn_correlation) > kFits;
  return better || !fits;
}

constexpr std::size_t kFewestCompared = 30;  // fixes, and samples

/// Returns the offset of the clock of an odometry to that of a receiver, if it shows.
std::optional<ClockOffset> offset_to(const std::vector<OdometrySample>& odometry,
                                     const std::vector<Fix>& fixes) {
  if (odometry.size() < kFewestCompared) return std::nullopt;
  const auto [speeds, turns] = receiver_motion(of_one_receiver(fixes));
  if (!fits_elsewhere(LagSearch(odometry, speeds, turns))) return std::nullopt;
  const std::optional<ClockOffset> offset = estimate_clock_offsets(odometry, fixes, {}).common();
  if (!offset || !offset->is_significant() || is_near_zero(offset->late_s)) return std::nullopt;
  return offset;
}

/// Returns the offset of the clock of an odometry, if the fixes of every receiver show that it has one: one that
/// shows to some of them is theirs.
std::optional<ClockOffset> offset_shown(const std::vector<OdometrySample>& odometry,
                                        const std::vector<Fix>& fixes) {
  std::map<int, std::vector<Fix>> receivers;
  for (const Fix& fix : fixes) receivers[fix.source].push_back(fix);
  std::optional<ClockOffset> shown;
  for (const auto& [source, of_one] : receivers) {
    if (of_one.size() < kFewestCompared) continue;
    const std::optional<ClockOffset> offset = offset_to(odometry, of_one);
    if (!offset) return std::nullopt;
    if (!shown || offset->sigma_s < shown->sigma_s) shown = offset;
  }
  return shown;
}

/// @param odometry "the odometry" or the name of one of several @param cure what to do
std::string clock_warning(const std::string& odometry, const ClockOffset& offset, const std::string& cure) {
  return fmt::format("{}'s clock seems {:.2f} +- {:.2f} s late against the fixes{}, correlation {:.3f}: {}",
                     odometry, offset.late_s, std::hypot(offset.sigma_s, kSmoothing_s),
                     offset_in_words(offset), offset.correlation, cure);
}

/// What the fixes say against one of several odometries.
struct Verdict {
  std::vector<std::string> sentences;
  bool contradicts = false;  ///< clock, unit or sign are wrong
  bool is_shape = false;     ///< the sentences are those of compare_shapes()
  bool fits = false;         ///< none of them is, and enough fixes were compared
  std::size_t spans = 0;     ///< how many lie within it
};

Verdict on_clock(const PreparedOdometry& source, const ClockOffset& offset, std::size_t spans) {
  return {.sentences = {clock_warning(
              source.name, offset,
              fmt::format("state 'time: {{offset: {:.2f}}}' for its log, or --sync", -offset.late_s))},
          .contradicts = true,
          .spans = spans};
}

/// @param fixes of all receivers
Verdict verdict_on(const PreparedOdometry& source, const std::vector<Fix>& fixes) {
  const std::vector<OdometrySample>& samples = source.samples;
  std::vector<Fix> within;
  for (const Fix& fix : fixes)
    if (fix.stamp >= samples.front().stamp && fix.stamp <= samples.back().stamp) within.push_back(fix);
  Verdict verdict;
  verdict.spans = within.size();
  if (const std::optional<ClockOffset> offset = offset_shown(samples, within))
    return on_clock(source, *offset, verdict.spans);
  if (within.size() < kFewestCompared || samples.size() < kFewestCompared) {
    // A clock that is far off leaves no fix within.
    const std::optional<ClockOffset> far = estimate_clock_offsets(samples, fixes, {}).common();
    return far && far->is_significant() && !is_near_zero(far->late_s) ? on_clock(source, *far, verdict.spans)
                                                                      : verdict;
  }
  std::vector<Fix> receiver;
  for (const Fix* fix : of_one_receiver(within)) receiver.push_back(*fix);
  constexpr double kStands_mps = 0.01;
  const Timeline timeline = build_timeline(samples, receiver, {.gap_s = source.gap_s});
  const std::vector<Eigen::Vector3d> poses = dead_reckon(timeline, Eigen::Vector3d::Zero(), kStands_mps);
  Shape shape = compare_shapes(receiver, antenna_at_fixes(timeline, poses, receiver));
  verdict.is_shape = true;
  // Turns that are far too large wind up, and the fixes no longer tell by how much.
  if (std::string warning = warning_of_accelerations(samples); !shape.contradicts && !warning.empty()) {
    shape.sentences.push_back(std::move(warning));
    shape.contradicts = true;
    verdict.is_shape = false;
  }
  for (const std::string& sentence : shape.sentences)
    verdict.sentences.push_back(source.name + ": " + sentence);
  verdict.contradicts = shape.contradicts;
  verdict.fits = !shape.contradicts && receiver.size() >= kFewestCompared;
  return verdict;
}

/// Returns the one that fits and spans the most fixes, if it can stand for a source that does not fit.
const PreparedOdometry* stands_for(const Verdict& wrong, const std::vector<Verdict>& verdicts,
                                   const std::vector<PreparedOdometry>& relative) {
  constexpr double kAsMany = 0.95;
  const auto best =
      std::max_element(verdicts.begin(), verdicts.end(), [](const Verdict& a, const Verdict& b) {
        return (a.fits ? a.spans + 1 : 0) < (b.fits ? b.spans + 1 : 0);
      });
  const bool can =
      best->fits && static_cast<double>(best->spans) >= kAsMany * static_cast<double>(wrong.spans);
  return can ? &relative[static_cast<std::size_t>(best - verdicts.begin())] : nullptr;
}

void check_several(PreparedDrive& drive) {
  std::vector<Verdict> verdicts;
  for (const PreparedOdometry& source : drive.relative) verdicts.push_back(verdict_on(source, drive.fixes));
  std::vector<std::string> left_out;
  // Nodes come from the first that is kept. It is compared again when they are placed.
  bool has_nodes = false;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    Verdict& verdict = verdicts[i];
    const PreparedOdometry* other =
        verdict.contradicts ? stands_for(verdict, verdicts, drive.relative) : nullptr;
    if (other != nullptr) {
      left_out.push_back(drive.relative[i].name);
      verdict.sentences.back() += fmt::format(". It is left out; {} fits", other->name);
    } else if (!std::exchange(has_nodes, true) && verdict.is_shape) {
      continue;
    }
    for (std::string& sentence : verdict.sentences) drive.report.warnings.push_back(std::move(sentence));
  }
  for (const std::string& name : left_out) drive = without_source(drive, {name, "odometry"});
}

}  // namespace

void check_odometries(PreparedDrive& drive, const std::function<std::string(const ClockOffset&)>& remedy) {
  if (!drive.relative.empty()) return check_several(drive);
  if (const std::optional<ClockOffset> offset = offset_shown(drive.odometry, drive.fixes))
    drive.report.warnings.push_back(clock_warning("the odometry", *offset, remedy(*offset)));
}

}  // namespace waymark::drive

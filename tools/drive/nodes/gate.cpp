#include <waymark/tools/drive/nodes/gate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/comparison/chords.hpp>
#include <waymark/tools/drive/comparison/frozen_fixes.hpp>
#include <waymark/tools/drive/comparison/jumps.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The vehicle stood if the odometry displacement over a chord is below this. It is below the
/// resolution of every log.
constexpr double kStandstillChord = 0.02;

/// A GNSS chord without direction means a frozen receiver if the odometry's chord is this many
/// times as long as the shortest chord with a direction. If it is shorter, slow driving and noise
/// look the same.
constexpr double kFrozenRatio = 2;

/// The fixes of one receiver that take part, in the order of the walk (either direction of time).
struct Track {
  std::span<const Fix> fixes;
  std::span<const Eigen::Vector3d> odometry;
  std::vector<std::size_t> members;  ///< indices into `fixes`
};

/// A reference and a judged fix: indices into Track::members.
struct Chord {
  Eigen::Vector2d gnss;
  Eigen::Vector2d odometry;
  double duration_s = 0;  ///< > 0 in both directions of time
};

struct Verdict {
  FixStatus status = FixStatus::accepted;
  std::string reason;
  double angle_rad = kNone;
  double displacement_m = kNone;
};

void check(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
           const GateOptions& options) {
  if (fixes.size() != dead_reckoned.size())
    throw UsageError("gate: one dead-reckoned pose per fix is needed");
  const auto later = [](const Fix& a, const Fix& b) { return a.stamp > b.stamp; };
  if (std::adjacent_find(fixes.begin(), fixes.end(), later) != fixes.end())
    throw UsageError("gate: fixes must be sorted by stamp");
  if (!(options.max_angle_rad > 0)) throw UsageError("gate: max_angle must be > 0");
  if (!(options.max_displacement_m > 0)) throw UsageError("gate: max_displacement_m must be > 0");
  if (!(options.chord_s > 0)) throw UsageError("gate: chord_s must be > 0");
  if (!(options.max_chord_s >= options.chord_s)) throw UsageError("gate: max_chord_s must be >= chord_s");
  if (!(options.min_chord_m > 0)) throw UsageError("gate: min_chord_m must be > 0");
}

double apart_s(const Track& track, std::size_t i, std::size_t j) {
  return std::abs(seconds_between(track.fixes[track.members[i]].stamp, track.fixes[track.members[j]].stamp));
}

Chord chord(const Track& track, std::size_t from, std::size_t to) {
  const std::size_t i = track.members[from];
  const std::size_t j = track.members[to];
  return Chord{.gnss = track.fixes[j].position - track.fixes[i].position,
               .odometry = track.odometry[j].head<2>() - track.odometry[i].head<2>(),
               .duration_s = apart_s(track, from, to)};
}

/// Returns the fix nearest to `chord_s` before member `i`, at least half of that and at most
/// max_chord_s away. Its status does not matter: see README, "The reference after a rejection".
std::optional<std::size_t> reference(const Track& track, std::size_t i, const GateOptions& options) {
  std::optional<std::size_t> best;
  for (std::size_t j = i; j-- > 0;) {
    const double age = apart_s(track, j, i);
    if (age > options.max_chord_s) break;
    if (age < 0.5 * options.chord_s) continue;
    if (best && std::abs(age - options.chord_s) >= std::abs(apart_s(track, *best, i) - options.chord_s))
      break;
    best = j;
  }
  return best;
}

bool has_direction(const Eigen::Vector2d& v, const GateOptions& options) {
  return v.norm() >= options.min_chord_m;
}

/// If there is only one chord, the vectors have no common frame. Their lengths differ at most as
/// much as the vectors under any alignment.
Verdict judge_pair(const Chord& bc, const GateOptions& options) {
  Verdict verdict;
  verdict.displacement_m = std::abs(bc.gnss.norm() - bc.odometry.norm());
  const bool passed = verdict.displacement_m < options.max_displacement_m;
  verdict.status = passed ? FixStatus::accepted : FixStatus::rejected;
  verdict.reason = passed ? "pair" : "displacement";
  return verdict;
}

Verdict judge_chords(const Chord& ab, const Chord& bc, const GateOptions& options) {
  Verdict verdict;
  const bool aligned = has_direction(ab.gnss, options) && has_direction(ab.odometry, options);
  if (aligned) {
    const Eigen::Vector2d expected = rotate(angle_between(ab.odometry, ab.gnss), bc.odometry);
    verdict.displacement_m = (bc.gnss - expected).norm();
  } else {
    verdict.displacement_m = std::abs(bc.gnss.norm() - bc.odometry.norm());
  }
  if (aligned && has_direction(bc.gnss, options) && has_direction(bc.odometry, options))
    verdict.angle_rad = wrap_angle(angle_between(ab.gnss, bc.gnss) - angle_between(ab.odometry, bc.odometry));

  // The gyro bias turns the chord of the odometry in proportion to the time between the middles
  // of the chords.
  const double chords = std::max(1.0, 0.5 * (ab.duration_s + bc.duration_s) / options.chord_s);
  // false for NaN
  const bool angle_fails = std::abs(verdict.angle_rad) >= options.max_angle_rad * chords;
  const bool displacement_fails = verdict.displacement_m >= options.max_displacement_m;
  const bool frozen =
      !has_direction(bc.gnss, options) && bc.odometry.norm() >= kFrozenRatio * options.min_chord_m;
  verdict.status = angle_fails || displacement_fails || frozen ? FixStatus::rejected : FixStatus::accepted;
  if (angle_fails && displacement_fails) {
    verdict.reason = "both";
  } else if (angle_fails) {
    verdict.reason = "angle";
  } else if (displacement_fails) {
    verdict.reason = "displacement";
  } else if (frozen) {
    verdict.reason = "frozen";
  } else if (!std::isnan(verdict.angle_rad)) {
    verdict.reason = "agrees";
  } else {
    verdict.reason = bc.odometry.norm() < kStandstillChord ? "standstill" : "short";
  }
  return verdict;
}

/// Judges with both chords before `c` in the order of the walk, or returns nothing.
std::optional<Verdict> judge(const Track& track, std::size_t c, const GateOptions& options) {
  const std::optional<std::size_t> b = reference(track, c, options);
  if (!b) return std::nullopt;
  const std::optional<std::size_t> a = reference(track, *b, options);
  if (!a) return std::nullopt;
  return judge_chords(chord(track, *a, *b), chord(track, *b, c), options);
}

Verdict judge_with_fallbacks(const Track& forward, const Track& backward, std::size_t c,
                             const GateOptions& options) {
  if (std::optional<Verdict> verdict = judge(forward, c, options)) return *verdict;
  const std::size_t mirrored = forward.members.size() - 1 - c;
  if (std::optional<Verdict> verdict = judge(backward, mirrored, options)) return *verdict;
  if (const auto b = reference(forward, c, options)) return judge_pair(chord(forward, *b, c), options);
  if (const auto b = reference(backward, mirrored, options))
    return judge_pair(chord(backward, *b, mirrored), options);
  return Verdict{.reason = "alone"};
}

void apply(Fix& fix, const Verdict& verdict) {
  fix.status = verdict.status;
  fix.reason = verdict.reason;
  fix.chord_angle_rad = verdict.angle_rad;
  fix.displacement_m = verdict.displacement_m;
}

void judge_source(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned, int source,
                  const GateOptions& options) {
  Track forward{.fixes = fixes, .odometry = dead_reckoned, .members = {}};
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (fixes[i].source == source && fixes[i].status != FixStatus::withheld) forward.members.push_back(i);
  Track backward = forward;
  std::reverse(backward.members.begin(), backward.members.end());
  for (std::size_t c = 0; c < forward.members.size(); ++c)
    apply(fixes[forward.members[c]], judge_with_fallbacks(forward, backward, c, options));
}

void reject(Fix& fix, const char* reason) {
  if (fix.status == FixStatus::withheld) return;
  fix.status = FixStatus::rejected;
  fix.reason = reason;
}

/// Of repeated fixes that say nothing against the others: the log holds each fix until the next one.
constexpr const char* kHeld = "held";

/// A position that is repeated while the vehicle moves is no measurement, so this needs no gate.
void reject_frozen(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned) {
  for (const FrozenFixes& frozen : find_frozen_fixes(fixes, dead_reckoned))
    for (const std::size_t i : frozen.repeated) reject(fixes[i], frozen.held ? kHeld : "frozen");
}

/// Between a jump and the jump back the fixes agree among themselves, so that no gate sees them.
void reject_excursions(std::span<Fix> fixes, const ReckonedFixes& receiver) {
  for (const Jump& jump : jumps_of(receiver)) {
    if (!jump.undone) continue;
    for (std::size_t i = receiver.place[jump.first]; i < receiver.place[jump.end]; ++i)
      if (fixes[i].source == receiver.fixes.front().source) reject(fixes[i], "jump");
  }
}

std::vector<int> sources_of(std::span<const Fix> fixes) {
  std::vector<int> sources;
  for (const Fix& fix : fixes) sources.push_back(fix.source);
  std::sort(sources.begin(), sources.end());
  sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
  return sources;
}

GateSummary count(std::span<const Fix> fixes) {
  GateSummary summary;
  for (const Fix& fix : fixes) {
    if (fix.status == FixStatus::withheld) {
      ++summary.withheld;
      continue;
    }
    ++(fix.status == FixStatus::accepted ? summary.accepted : summary.rejected);
    ++summary.reasons[fix.reason];
  }
  return summary;
}

}  // namespace

double GateSummary::rejected_percent() const {
  const std::size_t judged = accepted + rejected;
  return judged == 0 ? 0 : 100 * static_cast<double>(rejected) / static_cast<double>(judged);
}

GateSummary apply_gate(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
                       const GateOptions& options) {
  const std::vector<int> sources = sources_of(fixes);
  const std::size_t count = sources.empty() ? 1 : static_cast<std::size_t>(sources.back()) + 1;
  return apply_gate(fixes, dead_reckoned, std::vector<GateOptions>(count, options));
}

GateSummary apply_gate(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
                       std::span<const GateOptions> by_source) {
  for (const GateOptions& options : by_source) check(fixes, dead_reckoned, options);
  for (const int source : sources_of(fixes)) {
    const GateOptions& options = by_source[static_cast<std::size_t>(source)];
    if (options.enabled.value_or(true)) {
      judge_source(fixes, dead_reckoned, source, options);
    } else {
      for (Fix& fix : fixes)
        if (fix.source == source && fix.status != FixStatus::withheld) apply(fix, Verdict{.reason = "off"});
    }
    reject_excursions(fixes, of_receiver(fixes, dead_reckoned, source));
  }
  reject_frozen(fixes, dead_reckoned);
  return count(fixes);
}

void require_accepted_fix(const GateSummary& summary) {
  if (summary.accepted > 0) return;
  if (summary.rejected == 0) throw InputError("the drive has no GNSS fix");
  throw InputError(
      "all " + std::to_string(summary.rejected) +
      " fixes were rejected by the gate; check the sign and unit of the yaw rate and the clocks of "
      "both logs, widen gate: max_angle_deg and max_displacement_m, or turn the gate off (gate: enabled: "
      "false)");
}

std::string warning_of(const GateSummary& summary) {
  const auto held = summary.reasons.find(kHeld);
  const std::size_t rejected = summary.rejected - (held == summary.reasons.end() ? 0 : held->second);
  if (rejected <= summary.accepted) return {};
  const std::size_t judged = summary.accepted + rejected;
  return fmt::format(
      "the gate rejects {} of {} fixes ({:.0f} %), so the rest may be a chance agreement: the modeling "
      "'correlated' needs no gate; otherwise check the sign and unit of the yaw rate and the clocks of both "
      "logs, or widen gate: max_angle_deg and max_displacement_m",
      rejected, judged, 100 * static_cast<double>(rejected) / static_cast<double>(judged));
}

}  // namespace waymark::drive

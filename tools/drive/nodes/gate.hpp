/// Adaptive GNSS outlier rejection: the paper's Sec. II-D ("Adaptive GNSS Outlier Rejection"),
/// completed for its open cases. tools/drive/README.md, section "The gate", has these decisions and
/// their reasons.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

struct GateOptions {
  std::optional<bool> enabled;  ///< empty: the caller decides; otherwise it is on
  /// 1.5 degrees: chord angle of GNSS minus that of odometry, > 0
  double max_angle_rad = 0.026179938779914945;
  double max_displacement_m = 15;  ///< difference of the displacement vectors, > 0
  /// approximate duration of chords, > 0; both limits are meant for it
  double chord_s = 1;
  double max_chord_s = 5;  ///< fixes further apart make no chord, >= chord_s
  double min_chord_m = 1;  ///< a shorter chord (GNSS or odometry) has no direction, > 0

  friend bool operator==(const GateOptions&, const GateOptions&) = default;
};

/// The result of the gate. Every fix is in exactly one count.
struct GateSummary {
  std::size_t accepted = 0;
  std::size_t rejected = 0;
  std::size_t withheld = 0;
  std::map<std::string, std::size_t> reasons;  ///< reason word -> fixes (withheld ones excluded)

  /// Returns the share of rejected fixes in percent, without withheld ones; 0 if there are none.
  [[nodiscard]] double rejected_percent() const;
};

/// Judges every fix that is not withheld, and writes status, reason, chord_angle_rad and
/// displacement_m into it.
///
/// Let c be the judged fix, b the fix about `chord_s` before it, and a the fix about `chord_s`
/// before b. The GNSS chords are ab and bc; the chords of the odometry are between the same stamps.
/// The angle error is the turn from ab to bc in GNSS minus that in odometry, in (-pi, pi]. If the
/// chords last longer than `chord_s`, its limit grows with their duration. The displacement error
/// is |bc_gnss - R bc_odometry|, where R rotates the odometry's ab onto the GNSS ab. So the vectors
/// are compared in the GNSS frame without an estimate of the heading. If ab has no direction, the
/// displacement error is the difference of the two lengths. The first fixes, and the first ones
/// after a gap, are judged by their successors with time reversed.
///
/// Reasons of an accepted fix:
/// - `agrees`: both tests passed;
/// - `short`: a chord is too short for an angle, and the displacement passed;
/// - `standstill`: the odometry did not move, and the displacement passed;
/// - `pair`: there is only one chord, and its length passed;
/// - `alone`: there is no chord;
/// - `off`: the gate is disabled.
///
/// Reasons of a rejected fix: `angle`, `displacement`, `both`, `frozen` (GNSS stands while the
/// odometry moves; fixes that repeat a position are rejected without the gate too: frozen_fixes.hpp),
/// `jump` (between a jump and the jump back, without the gate too: chords.hpp).
///
/// @param fixes sorted by stamp; fixes of different `source` are judged separately
/// @param dead_reckoned for each fix the pose (x [m], y [m], heading [rad]) of odometry alone at
/// its stamp, in any one frame; antenna positions if a lever arm is known
/// @throws UsageError if the sizes differ, the stamps are not sorted or an option is out of range.
/// It is no error here if all fixes are rejected: see require_accepted_fix.
GateSummary apply_gate(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
                       const GateOptions& options);
/// Does the same with options for each source. @param by_source in the order of Fix::source
GateSummary apply_gate(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
                       std::span<const GateOptions> by_source);

/// @throws InputError "all N fixes were rejected by the gate; ..." with the remedy if the
/// gate left no fix
void require_accepted_fix(const GateSummary& summary);

/// Returns a warning with the remedy if the gate rejected more than half of the fixes; empty otherwise.
[[nodiscard]] std::string warning_of(const GateSummary& summary);

}  // namespace waymark::drive

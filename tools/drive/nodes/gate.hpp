/// Adaptive GNSS outlier rejection: the paper's Sec. II-D ("Adaptive GNSS Outlier Rejection"), with its open
/// cases ruled. The rulings and their reasons are in tools/drive/README.md, section "The gate".
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

struct GateOptions {
  std::optional<bool> enabled;                  ///< empty: whoever asks decides; on, where nobody does
  double max_angle_rad = 0.026179938779914945;  ///< 1.5 degrees: chord angle of GNSS against odometry, > 0
  double max_displacement_m = 15;               ///< difference of the displacement vectors, > 0
  double chord_s = 1;      ///< chords span about this long; both limits are meant for it, > 0
  double max_chord_s = 5;  ///< fixes further apart than this form no chord, >= chord_s
  double min_chord_m = 1;  ///< a shorter chord (GNSS or odometry) has no direction, > 0

  friend bool operator==(const GateOptions&, const GateOptions&) = default;
};

/// What the gate did. Every fix is in exactly one count.
struct GateSummary {
  std::size_t accepted = 0;
  std::size_t rejected = 0;
  std::size_t withheld = 0;
  std::map<std::string, std::size_t> reasons;  ///< reason word -> fixes (withheld ones excluded)

  /// Share of rejected among the judged (withheld ones excluded), in percent; 0 for none.
  [[nodiscard]] double rejected_percent() const;
};

/// Judges every fix that is not withheld and writes status, reason, chord_angle_rad and displacement_m into
/// it.
///
/// With c the fix judged, b the fix about `chord_s` before it and a the fix about `chord_s` before b, the
/// GNSS chords are ab and bc, and so are the odometry's between the same stamps. The angle error is the turn
/// from ab to bc in GNSS minus that in odometry, in (-pi, pi]; its limit grows with the duration of the
/// chords beyond `chord_s`. The displacement error is |bc_gnss - R bc_odometry|, R being the rotation that
/// lays the odometry's ab along the GNSS ab: the vectors are compared in the GNSS frame without any estimate
/// of heading. Where ab has no direction it is the difference of the two lengths. The first fixes, and the
/// first after a gap, are judged by their successors with time reversed.
///
/// Reasons of an accepted fix: `agrees` (both tests passed), `short` (a chord too short for an angle;
/// displacement passed), `standstill` (the odometry did not move; displacement passed), `pair` (only one
/// chord could be formed; its length passed), `alone` (none could), `off` (the gate is disabled). Reasons of
/// a rejected fix: `angle`, `displacement`, `both`, `frozen` (GNSS stands while the odometry moves).
///
/// @param fixes          sorted by stamp; fixes of different `source` are judged apart from each other
/// @param dead_reckoned  for each fix the pose (x [m], y [m], heading [rad]) of odometry alone at its stamp
/// in
///                       any one frame; give antenna positions where a lever arm is known
/// @throws UsageError where the sizes differ, the stamps are not sorted or an option is out of range. All
/// rejected is not an error here: see require_accepted_fix.
GateSummary apply_gate(std::span<Fix> fixes, std::span<const Eigen::Vector3d> dead_reckoned,
                       const GateOptions& options);

/// @throws InputError "all N fixes were rejected by the gate; ..." where the gate left none, naming the
/// remedy.
void require_accepted_fix(const GateSummary& summary);

}  // namespace waymark::drive

/// Times from which the fixes of a receiver are elsewhere, by the odometry.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <waymark/tools/drive/comparison/chords.hpp>

namespace waymark::drive {

/// The fixes leave where the odometry goes on, at once or in a slide.
struct Jump {
  std::size_t first = 0;    ///< fix of the receiver that has left
  std::size_t settled = 0;  ///< fix that is elsewhere for good; `first` if the fixes leave at once
  std::size_t end = 0;      ///< fix at which the next jump is over, or the number of fixes
  Eigen::Vector2d by = Eigen::Vector2d::Zero();  ///< m, in the frame of the fixes
  double usual_m = 0;    ///< what the odometry usually leaves unexplained in such a time and way; 0: at once
  double claimed_m = 0;  ///< what the fixes beside it claim, if it is one of precise_jumps_of(); 0 else
  double stays_s = 0;    ///< from `first` to `end`, or to the last fix
  /// the next jump undoes this one, and there are more fixes elsewhere: those between are wrong
  bool undone = false;
};

/// Finds jumps: 20 m or more, and more than 5 sigmas of the fixes, are not the motion of the odometry, laid
/// along the fixes before. For 10 s before and after, all fixes agree with the odometry within a quarter of
/// that. Between two fixes at most 5 s apart that is enough. What takes longer, at most 30 s (a receiver
/// that smooths its positions, a gap), must also be five times what is usual between the fixes of this drive
/// and its odometry in such a time, and on such a way. Of fixes that claim centimetres, smaller ones are found too
/// (precise_jumps.hpp).
[[nodiscard]] std::vector<Jump> jumps_of(const ReckonedFixes& receiver);

}  // namespace waymark::drive

/// What a live estimate depends on besides the description of the drive and the settings of its fusion.
#pragma once

namespace waymark::live {

struct LiveSettings {
  double window_s = 60;  ///< how long poses stay in the graph
  /// Samples wait this long, on the clock of the odometry, for others that are stamped earlier. So long
  /// may any source be late without a difference in the result; fixes may be later (up to the window).
  double reorder_s = 0;
  double longest_gap_s = 10;       ///< after a longer silence of the odometry the estimate begins anew
  double silence_s = 2;            ///< so long without odometry: lost
  double degraded_radius_m = 20;   ///< a larger radius of 95 % is degraded
  double lost_radius_m = 1000;     ///< a larger one is lost: the estimate begins anew with the next fixes
  double least_distance_m = 10;    ///< the way after which a heading may be known
  double heading_sigma_rad = 0.3;  ///< that it must have
  /// squared normalised distance beyond which a fix is absurd: chi-square of two dimensions at 1e-10
  double absurd = 46.1;
  int fixes_that_convince = 5;  ///< so many absurd fixes in a row that agree with each other are believed
  int failures_to_reset = 5;    ///< so many solutions in a row without success
};

}  // namespace waymark::live

/// The parameters of a simulated drive, with a unit in each name. README.md explains the models.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace waymark::simulation {

/// The layout of one kind of road, and how it is driven. A road is a row of legs, each with its own
/// cruise speed. A leg consists of straights and smooth bends. It ends with a street corner, a
/// stop, both or nothing.
struct RoadRecipe {
  std::string kind = "rural";  ///< a word for reports: highway, urban, rural
  /// share of the duration of the drive, relative to the sum of all shares
  double share = 1;

  double cruise_min_mps = 14;  ///< the cruise speed of a leg is uniform in [min, max]
  double cruise_max_mps = 25;
  double speed_wander = 0.04;  ///< relative deviation of the cruise speed, correlated over 20 s
  double acceleration_mps2 = 1.2;
  double deceleration_mps2 = 1.6;
  double lateral_acceleration_mps2 = 2.0;  ///< upper limit in bends and corners

  double leg_min_m = 500;  ///< the length of a leg is uniform in [min, max]
  double leg_max_m = 3000;
  double straight_m = 250;         ///< mean length of the straight between two bends (exponential)
  double bend_sigma_deg = 25;      ///< deviation of the angle of a bend (normal, both senses)
  double bend_radius_min_m = 120;  ///< the smallest radius of a bend is uniform in [min, max]
  double bend_radius_max_m = 500;

  double corner_probability = 0.3;  ///< that a leg ends in a street corner of 90 degrees
  double corner_radius_m = 12;      ///< its smallest radius
  double stop_probability = 0.3;    ///< that the vehicle stops at the end of a leg
  double stop_min_s = 5;            ///< the duration of a stop is uniform in [min, max]
  double stop_max_s = 40;
  double canyon_probability = 0.25;  ///< that a leg runs through a canyon: houses, trees, a bridge
};

/// Odometry: reading = quantised((1 + scale) speed + noise), quantised(yaw rate + bias + noise). A
/// vehicle at rest reads speed 0, and a yaw rate of bias and noise.
struct OdometryRecipe {
  std::string name = "odometry";       ///< of the source and, with .csv, of its log
  double rate_hz = 25;                 ///< must divide 100 Hz, the clock of the simulation
  double first_s = 0.01;               ///< instant of the first reading; a multiple of 0.01 s
  double speed_scale = 0;              ///< 0.01: reads 1 % too much
  double speed_scale_sigma = 0;        ///< deviation of a further part that each seed draws
  double speed_noise_mps = 0.02;       ///< of each reading, independent
  double speed_step_mps = 0.02 / 3.6;  ///< quantisation; 0: none
  double gyro_bias_radps = 0;
  double gyro_bias_sigma_radps = 0;          ///< deviation of the part that each seed draws
  double gyro_bias_walk_radps_sqrts = 2e-6;  ///< its random walk, rad/s per sqrt(s)
  double yaw_rate_noise_radps = 2.6e-3;      ///< of each reading, independent
  double yaw_rate_step_radps = 7e-4;         ///< quantisation; 0: none

  double silent_share = 0;  ///< share of the readings that are missing; exact but for rounding
  double outage_s = 20;     ///< mean length of the outages that contain them (exponential)
};

/// The errors of the fixes, true east and north: bias + fast part + jitter + bursts. Also the
/// accuracy that the receiver states.
struct GnssRecipe {
  std::string name = "gnss";        ///< of the source and, with .json, of its log
  double rate_hz = 1;               ///< must divide 100 Hz
  double first_s = 1;               ///< instant of the first epoch; a multiple of 0.01 s
  Eigen::Vector2d antenna_m{0, 0};  ///< in the body frame: x forward, y left

  double bias_east_m = 0;  ///< constant over the drive
  double bias_north_m = 0;
  double bias_sigma_m = 0;  ///< per axis, deviation of a further part that each seed draws

  double fast_sigma_m = 1;  ///< per axis, first-order Gauss-Markov
  double fast_tau_s = 30;
  /// filter of the receiver on the fast part: a first-order lag that keeps its sigma
  double smoothing_s = 0;
  double jitter_m = 0.1;  ///< per axis, independent from fix to fix
  /// share of the variances of drawn bias and fast part that all receivers with a share have in
  /// common; the common fast part has the times of the first receiver
  double common_share = 0;

  double bursts_per_minute = 1;  ///< multipath bursts, Poisson, in canyons only
  double burst_size_m = 10;      ///< mean of their size (exponential); direction uniform
  double burst_duration_s = 6;   ///< mean duration (exponential) before it decays
  double burst_rise_s = 1;       ///< rises as 1 - exp(-t / rise) ...
  double burst_decay_s = 2;      ///< ... and decays as exp(-t / decay)
  /// share of a burst in epx and epy: below 1 the receiver is over-confident
  double burst_admitted = 0.05;

  /// a fix shows the vehicle as it was so long before its stamp; a multiple of 0.01 s, < 0: early
  double delay_s = 0;

  int missing_epochs = 0;  ///< total number of epochs without a fix; exact
  double outage_s = 5;     ///< mean length of the outages that contain them (exponential)

  double stated_95_m = 2;          ///< mean of epx at 95 %; epy and epv are larger by fixed factors
  double stated_variation = 0.15;  ///< relative deviation, correlated over 120 s
  double stated_step_m = 0.01;     ///< rounding of epx, epy, epv
};

/// Post-processed RTK.
struct TruthRecipe {
  double rate_hz = 5;              ///< must divide 100 Hz
  double position_noise_m = 0.01;  ///< per axis, independent
  double heading_noise_rad = 5e-4;
};

/// A whole drive.
struct SimulationRecipe {
  std::string name = "drive";
  double duration_s = 600;  ///< number of odometry samples / rate, exactly
  /// if not 0: the factor on all cruise speeds is chosen to give this distance
  double distance_m = 0;
  std::vector<RoadRecipe> roads{};  ///< driven one after the other
  OdometryRecipe odometry{};
  GnssRecipe gnss{};
  std::vector<OdometryRecipe> further_odometry{};
  std::vector<GnssRecipe> further_gnss{};
  TruthRecipe truth{};
  double start_latitude_deg = 52.27;  ///< a real place; its UTM zone is the frame
  double start_longitude_deg = 10.53;
  /// The seed draws everything but name, duration and place: varied().
  bool varied = false;

  /// The first source of a kind, then the further ones.
  [[nodiscard]] std::vector<OdometryRecipe> all_odometry() const;
  [[nodiscard]] std::vector<GnssRecipe> all_gnss() const;
  [[nodiscard]] bool has_several() const { return !further_odometry.empty() || !further_gnss.empty(); }
};

/// Returns the drive that a seed draws: kind of road, odometry (1 to 100 Hz, good and poor gyros,
/// wrong wheel radii), receiver (RTK to single point, stated errors from a third to three times the
/// actual ones), delay of the fixes (none, or up to a second) and outages. Ranges are in
/// README.md. @param recipe for name, duration and place
[[nodiscard]] SimulationRecipe varied(const SimulationRecipe& recipe, std::uint64_t seed);

/// Returns the same drive with another duration. Distance and missing epochs are scaled with it.
[[nodiscard]] SimulationRecipe with_duration(SimulationRecipe recipe, double duration_s);

/// @throws UsageError that names the parameter, its value and the rule
void check(const SimulationRecipe& recipe);

}  // namespace waymark::simulation

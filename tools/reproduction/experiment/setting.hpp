/// The variables of the experiment. One Setting is one way to fuse a drive, and an experiment is a
/// list of settings.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::reproduction {

/// When a run ends.
enum class StoppingRule {
  full_steps,  ///< ours: by the Newton decrement, only on full steps (core/optimize/optimizer.hpp)
  /// that of g2o: the first step that lowers chi2 by less than 1e-6 of it ends the run, truncated
  /// or not; at most kGainIterations steps
  relative_gain
};

/// g2o has no limit of its own; its users choose the number of iterations. The paper does not state
/// it. The examples and the program of g2o run 5 to 20, so 50 is generous.
inline constexpr int kGainIterations = 50;
inline constexpr double kGain = 1e-6;  ///< of chi2: g2o's SparseOptimizerTerminateAction
/// shorter and shorter steps that are tried in one iteration, as in g2o
inline constexpr int kGainAttempts = 100;

/// Limit on the steps of a bare algorithm with full_steps. A run that needs more than 100
/// only creeps.
inline constexpr int kBareIterations = 100;

/// The treatment of outliers besides gate and loss.
enum class OutlierTreatment {
  none,
  graduation,  ///< graduated non-convexity over the fixes (core/robust/graduation.hpp)
  /// a second pass with larger covariances for fixes that did not fit (outlier_treatment.hpp)
  inflation
};

/// One way to fuse a drive, the same for every drive.
struct Setting {
  std::string name;  ///< unique name in tables and files: "paper_g1", "paper_g1/radius"
  drive::FusionSettings fusion{};
  StoppingRule stopping = StoppingRule::full_steps;
  OutlierTreatment outliers = OutlierTreatment::none;
  /// Settings with the same objective have the same minimum, so the poses at their ends are
  /// compared. Empty: no comparison.
  std::string objective{};
  /// against truth or withheld fixes; false: it only runs to test convergence
  bool evaluated = true;
};

/// Returns a setting without defaults from the modeling: the gate of the paper, no calibration
/// states, the noise as stated.
[[nodiscard]] Setting stated_setting(const std::string& name, const std::string& modeling);

/// The modelings of the paper, in its order.
inline constexpr const char* kModelings[] = {"g1", "g2", "g3"};

/// Returns g1, g2, g3 and g2_no_rejection with the literal settings of the paper, names
/// "paper_...". The dogleg is that of g2o: one norm for metres and radians, first radius 1e4,
/// stopping by relative gain. The initial guess is dead reckoning. Each odometry edge has 1.1
/// %. Fixes use the literal logarithm with heading 0 in the measurement. The nodes of G2 begin
/// at the poses.
[[nodiscard]] std::vector<Setting> paper_settings();

/// Returns the same four with our settings, names "ours_...": decoupled error, additive process
/// noise, anchored start, the default dogleg.
[[nodiscard]] std::vector<Setting> our_settings();

/// Returns the default model of the program, exactly as in `waymark run`: name kDefaultModel.
[[nodiscard]] Setting default_setting();
inline constexpr const char* kDefaultModel = "waymark";

/// Returns settings that show why g1, g2 and g3 of the paper end where they end. Each has one cause
/// replaced by ours: names "paper_g1/radius" (the trust region), "/heading" (the error),
/// "/stopping" and "/start"; "/all_but_start" has the first three together. Two more are no cures,
/// but choices that the paper leaves open: "/east" begins with heading 0, whatever the road;
/// "/nodes_at_fixes" lets the nodes of G2 begin at their fixes.
[[nodiscard]] std::vector<Setting> cause_settings();

/// Returns the references for runs with the settings of the paper: anchored start, default dogleg,
/// tight tolerance. Their names are "paper_g1/minimum" (evaluated: the model of the paper without
/// its way of minimising) and "paper_g1/heading_minimum" with the decoupled error.
[[nodiscard]] std::vector<Setting> minimum_settings();

/// A cause and its change, for a heading.
struct Cause {
  std::string name;
  std::string title;
};
[[nodiscard]] const std::vector<Cause>& causes();

/// Returns our settings from both starts with every algorithm: names
/// "ours_g1/dead_reckoning/levenberg_marquardt".
[[nodiscard]] std::vector<Setting> convergence_settings();

/// Their algorithms: the registered ones, and the same as `waymark optimize` runs them, which may
/// choose another start. The default of these is the dogleg.
inline constexpr const char* kConvergenceAlgorithms[] = {"gauss_newton", "levenberg_marquardt", "dogleg",
                                                         "levenberg_marquardt+starts", "default"};
/// Their starts. "east" is dead reckoning with first heading 0, whatever the road; only algorithms
/// that may choose another start use it.
inline constexpr const char* kConvergenceStarts[] = {"anchored", "dead_reckoning", "east"};

}  // namespace waymark::reproduction

/// What is varied in the experiment: one Setting is one way to fuse a drive; an experiment is a list of them.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::reproduction {

/// When a run ends.
enum class StoppingRule {
  full_steps,    ///< ours: by the Newton decrement, on full steps only (core/optimize/optimizer.hpp)
  relative_gain  ///< g2o's: the first step that lowers chi2 by less than 1e-6 of it ends the run, truncated
                 ///< or not; at most kGainIterations steps
};

/// g2o has no limit of its own: its users say how many iterations. The paper does not say how many; its
/// examples and program run 5 to 20, so 50 is generous.
inline constexpr int kGainIterations = 50;
inline constexpr double kGain = 1e-6;      ///< of chi2: g2o's SparseOptimizerTerminateAction
inline constexpr int kGainAttempts = 100;  ///< shorter and shorter steps tried in one iteration, as in g2o

/// Most steps of a bare algorithm with full_steps: what is not there after 100 creeps.
inline constexpr int kBareIterations = 100;

/// What is done about outliers beside gate and loss.
enum class OutlierTreatment {
  none,
  graduation,  ///< graduated non-convexity over the fixes (core/robust/graduation.hpp)
  inflation    ///< a second pass with covariances inflated where fixes did not fit (outlier_treatment.hpp)
};

/// One way to fuse a drive, the same for every drive.
struct Setting {
  std::string name;  ///< unique, for tables and files: "paper_g1", "paper_g1/radius"
  drive::FusionSettings fusion{};
  StoppingRule stopping = StoppingRule::full_steps;
  OutlierTreatment outliers = OutlierTreatment::none;
  /// Settings of one objective have one minimum, so the poses that they end at are compared; empty: not.
  std::string objective{};
  bool evaluated = true;  ///< against truth or withheld fixes; else it is run for its convergence alone
};

/// A modeling with nothing left to it: the paper's gate, no calibration states, the noise as stated.
[[nodiscard]] Setting stated_setting(const std::string& name, const std::string& modeling);

/// The modelings of the paper, in its order.
inline constexpr const char* kModelings[] = {"g1", "g2", "g3"};

/// g1, g2, g3 and g2_no_rejection with the paper's literal settings, names "paper_...": dogleg as g2o has it
/// (norm over metres and radians alike, first radius 1e4, stopping by relative gain), dead-reckoned
/// start, 1.1 % per odometry edge, the literal logarithm with heading 0 in the reading of each fix, G2's
/// nodes beginning at the poses.
[[nodiscard]] std::vector<Setting> paper_settings();

/// The same four with ours, names "ours_...": decoupled error, additive process noise, anchored start, the
/// default dogleg.
[[nodiscard]] std::vector<Setting> our_settings();

/// The default model of the program, exactly as `waymark run` has it: name kDefaultModel.
[[nodiscard]] Setting default_setting();
inline constexpr const char* kDefaultModel = "waymark";

/// Why the paper's g1, g2 and g3 end where they end: each cause switched to ours alone, names
/// "paper_g1/radius" (the trust region alone), "/heading" (the error alone), "/stopping", "/start", and
/// "/all_but_start": the first three together. Two are no cures but what the paper leaves open: "/east"
/// begins with heading 0, whatever the road's; "/nodes_at_fixes" has G2's nodes begin at their fixes.
[[nodiscard]] std::vector<Setting> cause_settings();

/// What runs of the paper's settings are compared with: anchored start, default dogleg, tight tolerance;
/// names "paper_g1/minimum" (evaluated: the paper's model without the way it was minimised), and
/// "paper_g1/heading_minimum" with the decoupled error.
[[nodiscard]] std::vector<Setting> minimum_settings();

/// A cause and what is changed, for a heading.
struct Cause {
  std::string name;
  std::string title;
};
[[nodiscard]] const std::vector<Cause>& causes();

/// Ours from both starts with every algorithm: names "ours_g1/dead_reckoning/levenberg_marquardt".
[[nodiscard]] std::vector<Setting> convergence_settings();

/// The algorithms in them: registered ones, and the same as `waymark optimize` runs them, which may choose
/// another start; its default is the dogleg.
inline constexpr const char* kConvergenceAlgorithms[] = {"gauss_newton", "levenberg_marquardt", "dogleg",
                                                         "levenberg_marquardt+starts", "default"};
/// The starts in them. "east": dead reckoning whose first heading is 0, whatever the road's; only for those
/// that may choose another start.
inline constexpr const char* kConvergenceStarts[] = {"anchored", "dead_reckoning", "east"};

}  // namespace waymark::reproduction

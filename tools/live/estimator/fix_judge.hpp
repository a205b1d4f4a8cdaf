/// Which fixes of the receivers are used: the gate where a modeling needs it, positions that repeat, and what
/// cannot be beside the estimate. The rest is left to the error model.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/live/estimator/reckoning.hpp>
#include <waymark/tools/live/estimator/settings.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>
#include <waymark/tools/live/learning/claims_so_far.hpp>

namespace waymark::live {

class FixJudge {
 public:
  /// All of them must outlive the object.
  FixJudge(const drive::DriveDescription& description, const drive::FusionSettings& settings,
           const LiveSettings& live, const TypeRegistry& registry)
      : description_(description), settings_(settings), live_(live), registry_(registry) {}

  /// Tells whether a period of the receiver has had its fix already.
  [[nodiscard]] bool is_thinned(const GeodeticFix& fix);
  /// Returns why a fix cannot be right: "frozen", "jump", "absurd", or the gate's reason; empty if it may be.
  /// @param window null: there is no estimate yet
  [[nodiscard]] std::string reason_against(const Fix& fix, const Reckoning& reckoning, const Window* window);
  /// Takes a fix that may be right. @returns what its receiver has claimed so far
  [[nodiscard]] ClaimedAccuracies accept(const Fix& fix);
  /// Takes a fix that is elsewhere: a jump, or absurd. @returns whether so many in a row agree with each other,
  /// for so long, that it is the estimate which is wrong
  [[nodiscard]] bool convinces(const Fix& fix, const Reckoning& reckoning);
  /// Returns the fixes of a receiver in a row that are elsewhere, and forgets them.
  [[nodiscard]] std::vector<Fix> take_believed(int source);
  /// Forgets what agreed with the estimate, and what is elsewhere.
  void forget_elsewhere();
  /// Forgets the receivers, but for what they claim.
  void clear();

 private:
  /// How far an accepted fix was from the estimate before it.
  struct Residual {
    Stamp stamp;
    Eigen::Vector2d off = Eigen::Vector2d::Zero();   ///< m, in the frame
    Eigen::Vector2d body = Eigen::Vector2d::Zero();  ///< m, the same in the axes of the vehicle
    double accuracy_m = 0;
  };
  struct Receiver {
    ClaimsSoFar claims{};
    std::deque<Residual> agreed{};           // of the last seconds
    std::optional<Stamp> agrees_since{};     // without a fix that is elsewhere
    double doubted_s = 0;                    // so long fixes that are elsewhere are not believed
    std::optional<Residual> left{};          // the first of the last fixes, which are elsewhere
    std::vector<Fix> elsewhere{};            // the last ones in a row, while none of any receiver is used
    std::deque<Fix> judged{};                // the last seconds, all of them, with the dead reckoning
    std::deque<Eigen::Vector3d> reckoned{};  // antenna at these
    std::optional<std::int64_t> period{};    // of the last one that was taken
    std::optional<Eigen::Vector2d> still{};  // a position that repeats
    double still_way_m = 0;                  // of the odometry when it began
  };

  [[nodiscard]] std::string judged_by_gate(const Fix& fix, const Reckoning& reckoning);
  [[nodiscard]] bool repeats(const Fix& fix, const Reckoning& reckoning);
  [[nodiscard]] bool is_absurd(const Eigen::Vector2d& off, const Fix& fix, const Window& window) const;
  [[nodiscard]] bool has_jumped(const Residual& residual, int source, const Window& window) const;
  void doubt(const Fix& fix, bool at_once);

  const drive::DriveDescription& description_;
  const drive::FusionSettings& settings_;
  const LiveSettings& live_;
  const TypeRegistry& registry_;
  std::map<int, Receiver> receivers_;
  std::optional<Residual> residual_{};  // of the fix that is judged
};

}  // namespace waymark::live

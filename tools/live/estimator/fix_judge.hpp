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
#include <waymark/tools/live/estimator/window.hpp>

namespace waymark::live {

class FixJudge {
 public:
  /// All of them must outlive the object.
  FixJudge(const drive::DriveDescription& description, const drive::FusionSettings& settings,
           const LiveSettings& live, const TypeRegistry& registry)
      : description_(description), settings_(settings), live_(live), registry_(registry) {}

  /// Tells whether a period of the receiver has had its fix already.
  [[nodiscard]] bool is_thinned(const GeodeticFix& fix);
  /// Returns why a fix cannot be right: "frozen", "absurd", or the gate's reason; empty if it may be.
  /// @param window null: there is no estimate yet
  [[nodiscard]] std::string reason_against(const Fix& fix, const Reckoning& reckoning, const Window* window);
  /// Takes a fix that may be right. @returns what its receiver has claimed lately
  [[nodiscard]] ClaimedAccuracies accept(const Fix& fix);
  /// Takes an absurd fix. @returns whether so many in a row agree with each other that it is the estimate
  /// which is wrong
  [[nodiscard]] bool convinces(const Fix& fix, const Reckoning& reckoning);
  /// Returns the absurd fixes in a row, and forgets them.
  [[nodiscard]] std::vector<Fix> take_believed();
  /// Forgets the absurd fixes in a row.
  void forget_absurd() { absurd_.clear(); }
  /// Forgets the receivers.
  void clear() { receivers_.clear(); }

 private:
  struct Receiver {
    std::vector<Fix> used;                 // the last ones: their claims
    std::deque<Fix> judged;                // the last seconds, all of them, with the dead reckoning
    std::deque<Eigen::Vector3d> reckoned;  // antenna at these
    std::optional<std::int64_t> period;    // of the last one that was taken
    std::optional<Eigen::Vector2d> still;  // a position that repeats
    double still_way_m = 0;                // of the odometry when it began
  };

  [[nodiscard]] std::string judged_by_gate(const Fix& fix, const Reckoning& reckoning);
  [[nodiscard]] bool repeats(const Fix& fix, const Reckoning& reckoning);
  [[nodiscard]] bool is_absurd(const Fix& fix, const Window& window) const;

  const drive::DriveDescription& description_;
  const drive::FusionSettings& settings_;
  const LiveSettings& live_;
  const TypeRegistry& registry_;
  std::map<int, Receiver> receivers_;
  std::vector<Fix> absurd_;  // the last ones in a row
};

}  // namespace waymark::live

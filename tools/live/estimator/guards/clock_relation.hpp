/// How the clock of the odometry and those of the receivers lie to each other, by the order of arrival.
///
/// A fix comes some time after it was measured, and about the same time after from one to the next: that is its
/// lateness, the newest stamp of the odometry minus its own. If the clock of the odometry steps alone, all latenesses
/// step with it. If both go on elsewhere (after a pause), they are as before.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::live {

class ClockRelation {
 public:
  /// Takes the arrival of a fix. @param odometry newest stamp of the odometry
  void take_fix(int source, Stamp fix, Stamp odometry);
  /// Tells that the odometry has had a sample.
  void take_odometry() { since_odometry_ = 0; }
  /// Returns how many fixes have come since the last sample of the odometry.
  [[nodiscard]] std::size_t fixes_since_odometry() const { return since_odometry_; }
  /// Returns how late fixes of a receiver usually are, s; empty: not known.
  [[nodiscard]] std::optional<double> usual_lateness_s(int source) const;
  /// Returns the shortest usual interval of the receivers that speak, s; empty if none does, or is known.
  /// @param odometry newest stamp of the odometry
  [[nodiscard]] std::optional<double> next_fix_within_s(Stamp odometry) const;
  /// Returns by how much the odometry is to be moved so that fixes which have come for a while with stamps that are
  /// more than a minute beside its own are not late; empty: there are no such fixes. @see take_fix
  [[nodiscard]] std::optional<double> apart_s() const;
  /// Forgets how late the fixes were.
  void forget();

 private:
  struct Receiver {
    std::optional<Stamp> newest{};
    Stamp odometry;  // when that fix came
    std::deque<double> lateness_s{};
    std::deque<double> intervals_s{};
  };
  void judge_apart(const Receiver& before, Stamp fix, Stamp odometry);

  std::map<int, Receiver> receivers_;
  std::size_t since_odometry_ = 0;
  std::size_t apart_ = 0;  // fixes in a row, of any receiver
  double apart_s_ = 0;
};

}  // namespace waymark::live

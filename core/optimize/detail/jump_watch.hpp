/// Notices where chi2 jumps: steps are rejected because chi2 rises by the same amount, however short they are.
#pragma once

#include <algorithm>

namespace waymark::detail {

/// Where chi2 is smooth, the quadratic model of a step of half the length errs by a quarter or less. An error that
/// does not shrink with the step is a jump between the present values and those tried, for example where the heading
/// error of an edge passes half a turn and its information is correlated. Beyond it chi2 may fall further than on
/// this side, so that the jump is worth being crossed. A crossing that led nowhere makes the watch more patient.
class JumpWatch {
 public:
  /// Hears of a rejected step. Those before a noticeable progress were rejected elsewhere, and count no more;
  /// small steps towards the jump may be accepted in between.
  /// @param length of the step @param misfit predicted minus actual decrease of chi2 @param chi2 before the
  /// step
  /// @return whether to take this step, up the jump
  [[nodiscard]] bool rejected(double length, double misfit, double chi2) {
    const bool same =
        misfit >= kSame * misfit_ && kSame * misfit <= misfit_ && chi2 >= kProgress * chi2_of_first_;
    if (!same) {
      chi2_of_first_ = chi2;
      count_ = 0;
      length_ = length;
      misfit_ = misfit;
    } else if (length > kShorter * length_) {
      length_ = std::max(length_, length);
    } else {
      ++count_;
    }
    last_misfit_ = misfit;
    return count_ >= patience_;
  }

  /// Tells that a crossing led below the chi2 of before.
  void crossed() { *this = {}; }

  /// Tells that the steps beyond the jump did not lead below the chi2 of before.
  void came_back(double chi2) {
    patience_ = std::min(2 * patience_, kLongestPatience);
    count_ = 0;
    if (chi2 < kProgress * chi2_of_return_) returns_ = 0;
    chi2_of_return_ = chi2;
    ++returns_;
  }

  /// Returns how many crossings have led nowhere since chi2 has sunk noticeably between two of them.
  [[nodiscard]] int returns() const { return returns_; }
  /// Returns by how much chi2 jumps: the error of the shortest step tells.
  [[nodiscard]] double height() const { return last_misfit_; }

 private:
  static constexpr double kSame = 0.7;     // share of its size to which a jump may change between two steps
  static constexpr double kShorter = 0.5;  // share of the longest step below which a smooth error had shrunk
  static constexpr double kProgress = 0.99;
  static constexpr int kPatience = 3;
  static constexpr int kLongestPatience = 12;

  double length_ = 0;         // of the longest step that met the jump
  double misfit_ = 0;         // of the longest step
  double chi2_of_first_ = 0;  // before the first step that met it
  double last_misfit_ = 0;
  int count_ = 0;  // short steps that met the jump
  int patience_ = kPatience;
  int returns_ = 0;
  double chi2_of_return_ = 0;
};

}  // namespace waymark::detail

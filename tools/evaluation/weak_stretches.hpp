/// The stretches of a drive where its result is worst, with their reasons as far as the fixes tell.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::evaluation {

/// A stretch around a peak of the error (with truth) or of the stated sigma (without).
struct WeakStretch {
  Stamp begin;
  Stamp end;
  Stamp peak;
  double peak_m = 0;  ///< the largest error or sigma
  double mean_m = 0;
  std::size_t epochs = 0;
  std::vector<std::string> reasons;  ///< "no fix for 12 s"; empty: the fixes tell none
};

/// Returns the worst stretches, worst first. A stretch reaches from its peak to both sides as far
/// as the value stays above the half of the peak and above 1.2 medians of all epochs, epochs follow
/// each other within 10 s, and no worse stretch begins. O(n log n).
/// @param epochs in order of time
/// @param against_truth errors against truth, or else the stated sigmas
[[nodiscard]] std::vector<WeakStretch> weak_stretches(std::span<const EpochResult> epochs, bool against_truth,
                                                      std::size_t most = 10);

}  // namespace waymark::evaluation

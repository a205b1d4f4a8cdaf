/// What a receiver has claimed of its accuracy so far.
#pragma once

#include <cstddef>
#include <vector>

#include <waymark/core/drive/modeling.hpp>

namespace waymark::live {

/// Keeps some hundreds of fixes, evenly over the drive: those of the last minutes would make a bad time the usual
/// one.
class ClaimsSoFar {
 public:
  /// Takes a fix that is used. @returns the claims of those before, and its own
  [[nodiscard]] ClaimedAccuracies with(const Fix& fix);

 private:
  std::vector<Fix> kept_;
  std::size_t each_ = 1;   // so many fixes for one that is kept
  std::size_t count_ = 0;  // of all fixes
};

}  // namespace waymark::live

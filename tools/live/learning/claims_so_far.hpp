/// What a receiver has claimed of its accuracy so far.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <waymark/core/drive/modeling.hpp>

namespace waymark::live {

/// Keeps some hundreds of fixes of each kind of solution, evenly over the drive: those of the last minutes would make
/// a bad time the usual one, and a rare kind would be lost among the others.
class ClaimsSoFar {
 public:
  /// Takes a fix that is used. @returns the claims of those before, and its own
  [[nodiscard]] ClaimedAccuracies with(const Fix& fix);

 private:
  struct Kept {
    std::vector<Fix> fixes;
    std::size_t each = 1;   // so many fixes for one that is kept
    std::size_t count = 0;  // of all fixes
  };

  std::array<Kept, 3> by_kind_;  // SolutionKind
  ClaimedAccuracies claims_;     // of each, when its last fix came
};

}  // namespace waymark::live

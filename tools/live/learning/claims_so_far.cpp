#include <waymark/tools/live/learning/claims_so_far.hpp>

namespace waymark::live {

ClaimedAccuracies ClaimsSoFar::with(const Fix& fix) {
  constexpr std::size_t kFewest = 300;
  kept_.push_back(fix);
  const ClaimedAccuracies claims = claimed_accuracies(kept_);
  if (count_++ % each_ != 0) kept_.pop_back();
  if (kept_.size() < 2 * kFewest) return claims;
  for (std::size_t i = 0; i < kFewest; ++i) kept_[i] = kept_[2 * i];
  kept_.resize(kFewest);
  each_ *= 2;
  return claims;
}

}  // namespace waymark::live

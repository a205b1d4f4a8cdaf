#include <waymark/tools/live/learning/claims_so_far.hpp>

namespace waymark::live {

ClaimedAccuracies ClaimsSoFar::with(const Fix& fix) {
  constexpr std::size_t kFewest = 300;
  const auto kind = static_cast<std::size_t>(kind_of(fix.told.quality));
  auto& [fixes, each, count] = by_kind_[kind];
  fixes.push_back(fix);
  const ClaimedAccuracies own = claimed_accuracies(fixes);
  claims_.median_m[kind] = own.median_m[kind];
  claims_.stand_in_m[kind] = own.stand_in_m[kind];
  if (count++ % each != 0) fixes.pop_back();
  if (fixes.size() < 2 * kFewest) return claims_;
  for (std::size_t i = 0; i < kFewest; ++i) fixes[i] = fixes[2 * i];
  fixes.resize(kFewest);
  each *= 2;
  return claims_;
}

}  // namespace waymark::live

#include <waymark/tools/simulation/sensors/lasting_errors.hpp>

#include <cmath>

namespace waymark::simulation {

LastingErrors draw_lasting_errors(std::size_t count, double interval_s, const GnssRecipe& recipe,
                                  RandomStream bias, RandomStream fast) {
  SmoothedGaussMarkov fast_east(recipe.fast_tau_s, recipe.smoothing_s, interval_s);
  SmoothedGaussMarkov fast_north(recipe.fast_tau_s, recipe.smoothing_s, interval_s);
  LastingErrors errors;
  errors.bias[0] = bias.normal();
  errors.bias[1] = bias.normal();
  for (std::size_t i = 0; i < count; ++i) {
    const double east = fast_east.next(fast);
    errors.fast.emplace_back(east, fast_north.next(fast));
  }
  return errors;
}

LastingErrors with_common(const LastingErrors& own, const LastingErrors& common, double share,
                          const std::vector<std::size_t>& ticks) {
  const double of_common = std::sqrt(share);
  const double of_own = std::sqrt(1 - share);
  LastingErrors errors;
  errors.bias = of_common * common.bias + of_own * own.bias;
  for (std::size_t i = 0; i < own.fast.size(); ++i)
    errors.fast.emplace_back(of_common * common.fast[ticks[i]] + of_own * own.fast[i]);
  return errors;
}

}  // namespace waymark::simulation

/// The errors of a receiver that last: bias and fast part, in units of their deviations. Receivers
/// that see the same satellites have a part of them in common.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/recipe.hpp>

namespace waymark::simulation {

/// Every number has mean 0 and deviation 1. Axes are true east and north.
struct LastingErrors {
  Eigen::Vector2d bias = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> fast;  ///< at evenly spaced instants
};

/// @param recipe for the correlation time and the smoothing of the fast part
/// @param interval_s between two of the `count` instants
[[nodiscard]] LastingErrors draw_lasting_errors(std::size_t count, double interval_s,
                                                const GnssRecipe& recipe, RandomStream bias,
                                                RandomStream fast);

/// Returns sqrt(share) `common` + sqrt(1 - share) `own`, so deviations stay 1. Two receivers with
/// the shares c and d have the correlation sqrt(c d). @param ticks index into common.fast of every
/// element of own.fast
[[nodiscard]] LastingErrors with_common(const LastingErrors& own, const LastingErrors& common, double share,
                                        const std::vector<std::size_t>& ticks);

}  // namespace waymark::simulation

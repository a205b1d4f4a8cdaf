/// Dead reckoning of samples to the fixes of their time.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

using Complex = std::complex<double>;  ///< a place or a way in the plane, m

/// Dead reckoning from the last sample before the first fix on.
struct Reckoned {
  std::vector<Complex> places;  ///< at the fixes, m
  double length_m = 0;          ///< from the first fix to the last one
};

/// @param fixes within the time of the samples, at least one; both sorted by stamp
[[nodiscard]] Reckoned reckoned(std::span<const OdometrySample> samples, std::span<const Fix> fixes);

}  // namespace waymark::drive

/// What the claims of receivers are worth in the time ahead: a drive tells it of those that it has had.
#pragma once

#include <map>
#include <span>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/live/estimator/window/window_setup.hpp>

namespace waymark::live {

/// The noise of a drive, and the claims that it holds for.
struct NoiseOfClaims {
  const drive::NoiseEstimate& noise;                ///< without parameters: nothing is learned yet
  double length_s = 0;                              ///< of the drive
  const std::map<int, ClaimedAccuracies>& claimed;  ///< by receiver
};

/// Returns settings whose modelings know how well the drive tells `accuracy_exponent` (`accuracy_exponent_sigma`: that of
/// the prior if it tells nothing), and for which claims its noise holds (`reference_accuracy`). So fixes that claim
/// what none has claimed before are not believed as those of the drive so far.
/// @param settings from drive::decided() @param stated settings of the drive: what they state stays
[[nodiscard]] drive::FusionSettings with_claims_ahead(drive::FusionSettings settings,
                                                      const drive::FusionSettings& stated,
                                                      const drive::DriveDescription& description,
                                                      const NoiseOfClaims& learned,
                                                      const TypeRegistry& registry);

/// Returns the setup of a drive that has told no noise yet: receivers that claim centimetres have not the errors of a
/// phone (NoisePrior::shrinks_with_claim). Parameters are what their priors expect of the variances, and hold for
/// these claims.
/// @param setup with settings from drive::decided() @param fixes the first ones
[[nodiscard]] FusionSetup with_first_claims(FusionSetup setup, const drive::FusionSettings& stated,
                                            const drive::DriveDescription& description,
                                            std::span<const Fix> fixes, const TypeRegistry& registry);

}  // namespace waymark::live

/// Warnings about implausible results. Wrong units and clocks also have a minimum, but distorted
/// states and noise reveal them.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::program {

/// Returns a sentence for each fact that a sound drive does not show: a state more than 6 sigmas of
/// its prior from zero (the mean of the prior), a first value of a calibration state more than 2.5 sigmas from it,
/// a noise parameter far above its prior (kUsualNoise), residuals of fixes twice as large as
/// their accuracies say or a quarter of them, fixes ten times as far away as they claim (and 10 m),
/// readings of a sensor twice as far away as its sigmas say, a source of which a loss down-weights a third, and fused
/// positions whose error exceeds that of the raw fixes by half.
/// @param modeled settings of the modeled drive
[[nodiscard]] std::vector<std::string> warnings_of_result(const std::vector<evaluation::StateReport>& states,
                                                          const drive::FusionSettings& modeled,
                                                          const drive::NoiseEstimate& noise,
                                                          const evaluation::Evaluation& evaluation);

}  // namespace waymark::program

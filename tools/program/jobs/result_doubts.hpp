/// Is a result believable? A minimum is found for wrong units and clocks as well; what had to be bent for it
/// tells.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/model/noise.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::program {

/// A sentence for each thing that a sound drive does not show: a state more than 6 sigmas of its prior from
/// zero, where its prior is; a noise parameter more than 4 deviations from its prior; fused positions half as
/// far again from the truth as the raw fixes.
[[nodiscard]] std::vector<std::string> doubts_of_result(const std::vector<evaluation::StateReport>& states,
                                                        const drive::NoiseEstimate& noise,
                                                        const evaluation::Evaluation& evaluation);

}  // namespace waymark::program

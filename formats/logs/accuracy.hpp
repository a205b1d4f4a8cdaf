/// What a figure of accuracy means, the same for every log reader.
#pragma once

#include <string_view>

#include <waymark/core/log_reader.hpp>

namespace waymark {

/// sigma = factor * figure for an accuracy figure of this meaning; `automatic` must have been resolved.
[[nodiscard]] double sigma_factor(AccuracyMeaning meaning);
/// "95", "1sigma", "drms", "cep50", "auto".
[[nodiscard]] std::string_view to_string(AccuracyMeaning meaning);

}  // namespace waymark

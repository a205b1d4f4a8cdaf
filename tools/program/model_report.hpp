/// What a drive's error model came out as: for the terminal and for JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <waymark/tools/drive/model.hpp>
#include <waymark/tools/evaluation/text_look.hpp>

namespace waymark {

/// What the gate rejected and why; the noise that was estimated, and what the drive did not show of it.
[[nodiscard]] std::string describe_model(const ModeledDrive& modeled, const TextLook& look = {});
[[nodiscard]] nlohmann::ordered_json noise_json(const NoiseEstimate& noise);

}  // namespace waymark

/// What a drive's error model came out as: for the terminal and for JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <waymark/tools/drive/model/model.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

/// What the gate rejected and why; the noise that was estimated, and what the drive did not show of it.
[[nodiscard]] std::string describe_model(const drive::ModeledDrive& modeled, const text::TextLook& look = {});
[[nodiscard]] nlohmann::ordered_json noise_json(const drive::NoiseEstimate& noise);

}  // namespace waymark::program

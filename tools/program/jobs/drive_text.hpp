/// A drive and its error model in words and as JSON, for the terminal and for reports.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

/// The way that the odometry says was driven, and its samples.
[[nodiscard]] std::string odometry_in_words(const drive::PreparedDrive& drive);

/// What of the logs did not go in.
[[nodiscard]] std::string left_out(const drive::PreparedDrive& drive);

/// A paragraph on what went in: samples, fixes, what was left out.
[[nodiscard]] std::string describe_drive(const drive::PreparedDrive& drive);

/// What the gate rejected and why; the noise that was estimated, and what the drive did not show of it.
[[nodiscard]] std::string describe_model(const drive::ModeledDrive& modeled, const text::TextLook& look = {});

/// The estimated noise, a list.
[[nodiscard]] nlohmann::ordered_json noise_json(const drive::NoiseEstimate& noise);

}  // namespace waymark::program

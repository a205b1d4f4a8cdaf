/// Describes a drive and its error model in words and as JSON, for the terminal and for reports.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/text/table.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

/// Describes the distance by the odometry, and its samples.
[[nodiscard]] std::string odometry_in_words(const drive::PreparedDrive& drive);

/// Describes which data of the logs were left out.
[[nodiscard]] std::string left_out(const drive::PreparedDrive& drive);

/// Returns a paragraph about the input: samples, fixes, and omissions.
[[nodiscard]] std::string describe_drive(const drive::PreparedDrive& drive);

/// Describes the fixes that the gate rejected and why, the estimated noise, and the noise
/// parameters that the drive does not show.
[[nodiscard]] std::string describe_model(const drive::ModeledDrive& modeled, const text::TextLook& look = {});

/// Returns the estimated noise: values, their 68 % intervals, and what was known before. "not
/// observed": the drive tells no more than the prior did.
[[nodiscard]] text::Table noise_table(const drive::NoiseEstimate& noise);

/// Returns the estimated noise as a list.
[[nodiscard]] nlohmann::ordered_json noise_json(const drive::NoiseEstimate& noise);

}  // namespace waymark::program

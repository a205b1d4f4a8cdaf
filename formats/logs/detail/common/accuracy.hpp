/// What a figure of accuracy means, the same for every log reader.
#pragma once

#include <optional>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// variance = factor * figure^2 for an accuracy figure of this meaning; `automatic` must have been resolved.
[[nodiscard]] double variance_factor(AccuracyMeaning meaning);
/// sigma = factor * figure, its root.
[[nodiscard]] double sigma_factor(AccuracyMeaning meaning);
/// Whether a figure can be an accuracy: from 10 micrometres to 10,000 km, the way to the pole. Zero, NaN and
/// what a damaged log holds are none.
[[nodiscard]] bool is_accuracy(double metres);
/// "95", "1sigma", "drms", "cep50", "auto".
[[nodiscard]] std::string_view to_string(AccuracyMeaning meaning);

/// The correlation of east and north errors that an error ellipse stands for. Its size is not looked at:
/// u-blox M9 states the ellipse 2.45 times as large as the sigmas (a 95 % ellipse), others as large as they
/// are.
/// @param sigma_east, sigma_north, major, minor  > 0, of any common unit
/// @param orientation_deg  of the major axis, clockwise from north
/// @return within (-1, 1); empty for an ellipse whose shape contradicts the sigmas by more than half
[[nodiscard]] std::optional<double> ellipse_correlation(double sigma_east, double sigma_north, double major,
                                                        double minor, double orientation_deg);

}  // namespace waymark::formats

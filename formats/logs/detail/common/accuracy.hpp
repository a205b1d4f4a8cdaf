/// The meaning of accuracy figures, the same for every log reader.
#pragma once

#include <optional>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Returns the factor in variance = factor * figure^2 for an accuracy figure with this meaning.
/// `automatic` must be resolved before.
[[nodiscard]] double variance_factor(AccuracyMeaning meaning);
/// Returns the factor in sigma = factor * figure: the root of variance_factor.
[[nodiscard]] double sigma_factor(AccuracyMeaning meaning);
/// Tells whether a number can be an accuracy: from 10 micrometres to 10,000 km, the distance from
/// equator to pole. Zero, NaN and garbage from a damaged log are rejected.
[[nodiscard]] bool is_accuracy(double metres);
/// "95", "1sigma", "drms", "cep50", "auto".
[[nodiscard]] std::string_view to_string(AccuracyMeaning meaning);

/// Returns the correlation of east and north errors that an error ellipse implies. The size of the
/// ellipse is ignored: u-blox M9 states it 2.45 times as large as the sigmas (a 95 % ellipse),
/// others as large as the sigmas.
/// @param sigma_east, sigma_north, major, minor > 0, in any common unit
/// @param orientation_deg of the major axis, clockwise from north
/// @return within (-1, 1); empty if the shape of the ellipse contradicts the sigmas by
/// more than half
[[nodiscard]] std::optional<double> ellipse_correlation(double sigma_east, double sigma_north, double major,
                                                        double minor, double orientation_deg);

}  // namespace waymark::formats

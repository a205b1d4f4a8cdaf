#include <waymark/formats/logs/detail/common/accuracy.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::formats {

double variance_factor(AccuracyMeaning meaning) {
  switch (meaning) {
    case AccuracyMeaning::automatic:
    case AccuracyMeaning::one_sigma:
      return 1;
    case AccuracyMeaning::percent95:
      return 0.25;
    case AccuracyMeaning::drms:
      return 0.5;
    case AccuracyMeaning::cep50:
      return 1 / (2 * std::numbers::ln2);  // median of a Rayleigh distribution: sigma sqrt(2 ln 2)
  }
  return 1;
}

double sigma_factor(AccuracyMeaning meaning) {
  return std::sqrt(variance_factor(meaning));
}

bool is_accuracy(double metres) {
  return metres >= 1e-5 && metres <= 1e7;
}

std::string_view to_string(AccuracyMeaning meaning) {
  switch (meaning) {
    case AccuracyMeaning::automatic:
      return "auto";
    case AccuracyMeaning::percent95:
      return "95";
    case AccuracyMeaning::one_sigma:
      return "1sigma";
    case AccuracyMeaning::drms:
      return "drms";
    case AccuracyMeaning::cep50:
      return "cep50";
  }
  return "auto";
}

std::optional<double> ellipse_correlation(double sigma_east, double sigma_north, double major, double minor,
                                          double orientation_deg) {
  const double angle = orientation_deg * std::numbers::pi / 180;
  const double north = std::hypot(major * std::cos(angle), minor * std::sin(angle));
  const double east = std::hypot(major * std::sin(angle), minor * std::cos(angle));
  const double correlation =
      (major - minor) * (major + minor) * std::sin(angle) * std::cos(angle) / (north * east);
  const double shape = sigma_east * north / (sigma_north * east);
  constexpr double kSameShape = 1.5;  // figures may be rounded to one digit
  constexpr double kMostCorrelated = 0.99999;
  // The comparisons fail for NaN.
  if (!(shape < kSameShape && shape > 1 / kSameShape && std::abs(correlation) < 1.001)) return std::nullopt;
  return std::clamp(correlation, -kMostCorrelated, kMostCorrelated);
}

}  // namespace waymark::formats

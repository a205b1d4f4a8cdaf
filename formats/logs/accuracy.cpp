#include <waymark/formats/logs/accuracy.hpp>

#include <cmath>
#include <numbers>

namespace waymark {

double sigma_factor(AccuracyMeaning meaning) {
  switch (meaning) {
    case AccuracyMeaning::automatic:
    case AccuracyMeaning::one_sigma:
      return 1;
    case AccuracyMeaning::percent95:
      return 0.5;
    case AccuracyMeaning::drms:
      return 1 / std::numbers::sqrt2;
    case AccuracyMeaning::cep50:
      return 1 / std::sqrt(2 * std::numbers::ln2);  // median of a Rayleigh distribution: sigma sqrt(2 ln 2)
  }
  return 1;
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

}  // namespace waymark

#include <waymark/core/drive/sample.hpp>

namespace waymark {

std::string_view to_string(FixQuality quality) {
  switch (quality) {
    case FixQuality::unknown:
      break;
    case FixQuality::single:
      return "single";
    case FixQuality::differential:
      return "differential";
    case FixQuality::floating:
      return "float";
    case FixQuality::fixed:
      return "fixed";
    case FixQuality::dead_reckoned:
      return "dead_reckoned";
    case FixQuality::manual:
      return "manual";
    case FixQuality::simulated:
      return "simulated";
  }
  return "unknown";
}

std::optional<FixQuality> fix_quality_from_string(std::string_view word) {
  for (const FixQuality quality : kFixQualities)
    if (word == to_string(quality)) return quality;
  return std::nullopt;
}

std::string_view to_string(FixStatus status) {
  switch (status) {
    case FixStatus::accepted:
      return "accepted";
    case FixStatus::rejected:
      return "rejected";
    case FixStatus::withheld:
      return "withheld";
  }
  return "accepted";
}

std::optional<FixStatus> fix_status_from_string(std::string_view word) {
  for (const FixStatus status : {FixStatus::accepted, FixStatus::rejected, FixStatus::withheld}) {
    if (word == to_string(status)) return status;
  }
  return std::nullopt;
}

}  // namespace waymark

/// What looks wrong in a log, as sentences.
#pragma once

#include <vector>

#include <waymark/tools/inspection/inspection.hpp>

namespace waymark::inspection {

/// Of one log.
[[nodiscard]] std::vector<std::string> suspicions_of(const LogInspection& log, Stamp now);
/// Of a log beside another one: spans that do not overlap, with what the distance would be for leap seconds
/// or another epoch. Empty where nothing is wrong.
[[nodiscard]] std::string suspicion_between(const LogInspection& log, const LogInspection& other);

}  // namespace waymark::inspection

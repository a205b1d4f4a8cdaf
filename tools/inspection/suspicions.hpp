/// Lists suspicious facts about a log, as sentences.
#pragma once

#include <vector>

#include <waymark/tools/inspection/inspection.hpp>

namespace waymark::inspection {

/// Returns the suspicions about one log.
[[nodiscard]] std::vector<std::string> suspicions_of(const LogInspection& log, Stamp now);
/// Returns a suspicion about a log beside another one, or an empty text. It reports spans that do
/// not overlap, and whether leap seconds or another epoch explain the distance.
[[nodiscard]] std::string suspicion_between(const LogInspection& log, const LogInspection& other);

}  // namespace waymark::inspection

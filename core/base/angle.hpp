/// One degree in radians: degrees * kDegree is an angle in radians, radians / kDegree
/// one in degrees.
#pragma once

#include <numbers>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

inline constexpr double kDegree = std::numbers::pi / 180;

}  // namespace waymark

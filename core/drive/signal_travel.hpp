/// The way of a satellite's signal, during which the Earth turns.
#pragma once

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

inline constexpr double kLight_mps = 299'792'458;
/// WGS84.
inline constexpr double kEarthRate_radps = 7.2921151467e-5;

/// Returns where a satellite was when the signal left it, in the axes that the Earth has when the
/// signal arrives. @param position ECEF, m
[[nodiscard]] Eigen::Vector3d turned_with_earth(const Eigen::Vector3d& position, double travel_s);

}  // namespace waymark

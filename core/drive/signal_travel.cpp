#include <waymark/core/drive/signal_travel.hpp>

#include <cmath>

namespace waymark {

Eigen::Vector3d turned_with_earth(const Eigen::Vector3d& position, double travel_s) {
  const double angle = kEarthRate_radps * travel_s;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * position.x() + s * position.y(), c * position.y() - s * position.x(), position.z()};
}

}  // namespace waymark

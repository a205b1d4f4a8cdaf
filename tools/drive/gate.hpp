/// Adaptive GNSS outlier rejection: the paper's Sec. II-D, with its open cases ruled (tools/drive/README.md).
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/sample.hpp>

namespace waymark {

struct GateOptions {
  bool enabled = true;
  double max_angle_rad = 0.026179938779914945;  ///< 1.5 degrees: chord angle of GNSS against odometry
  double max_displacement_m = 15;               ///< difference of the displacement vectors
};

}  // namespace waymark

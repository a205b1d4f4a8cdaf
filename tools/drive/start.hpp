/// Where the optimisation starts: the paper's dead reckoning, or a start anchored to the GNSS fixes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/sample.hpp>
#include <waymark/tools/drive/timeline.hpp>

namespace waymark {

enum class StartMethod {
  anchored,       ///< fixes anchor place and heading, the winding comes from the odometry (default)
  dead_reckoning  ///< the paper's: integrate from the first fix and the heading of the first chord
};

struct StartOptions {
  StartMethod method = StartMethod::anchored;
};

}  // namespace waymark

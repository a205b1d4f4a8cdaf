/// Odometry of one log with its stamps settled.
#pragma once

#include <vector>

#include <waymark/tools/drive/stamps/settle_stamps.hpp>

namespace waymark_test {

/// Settles the samples of "odo.csv". @returns what is told of them
inline waymark::drive::PrepareReport settled(std::vector<waymark::OdometrySample>& samples) {
  waymark::drive::PrepareReport report;
  waymark::drive::settle_stamps(samples, 0, "odo.csv", report);
  return report;
}

}  // namespace waymark_test

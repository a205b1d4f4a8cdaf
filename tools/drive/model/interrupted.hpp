/// The end of long work that a caller no longer wants.
#pragma once

#include <atomic>

#include <waymark/core/base/error.hpp>

namespace waymark::drive {

/// The caller asked for the end before there was a result.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted before there was a result") {}
};

/// @param cancel as OptimizerOptions::cancel @throws Interrupted if it is set
inline void stop_if(const std::atomic<bool>* cancel) {
  if (cancel != nullptr && *cancel) throw Interrupted();
}

}  // namespace waymark::drive

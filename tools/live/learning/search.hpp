/// The work beside an estimate: a lesson of the drive so far, and the window that fits it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>
#include <waymark/tools/live/learning/drive_so_far.hpp>
#include <waymark/tools/live/learning/lesson.hpp>

namespace waymark::live {

/// Copies of what the work needs, as they were when it began.
struct SearchTask {
  DriveSoFar so_far;
  drive::DriveDescription description;
  drive::FusionSettings stated;  ///< without what was learned before
  Frame frame;
  WindowInputs inputs;
  Stamp oldest;              ///< pose of the window
  std::uint32_t resets = 0;  ///< of the estimate
};

struct Learned {
  Lesson lesson;
  /// with the noise of the lesson, at the time when the work began; null: it has no minimum
  std::unique_ptr<Window> window;
  std::uint64_t inputs = 0;  ///< how many of the former window it has
  std::uint32_t resets = 0;  ///< of the estimate at that time
};

/// @param registry must outlive the result @param between as for learn()
[[nodiscard]] Learned search(const SearchTask& task, const TypeRegistry& registry,
                             const std::function<void()>& between);

}  // namespace waymark::live

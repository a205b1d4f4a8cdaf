/// The work beside an estimate: a lesson of the drive so far, and the window that fits it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>
#include <waymark/tools/live/estimator/window/window_setup.hpp>
#include <waymark/tools/live/learning/drive_so_far.hpp>
#include <waymark/tools/live/learning/lesson.hpp>

namespace waymark::live {

/// Copies of what the work needs, as they were when it began.
struct SearchTask {
  DriveSoFar so_far;
  drive::DriveDescription description;
  drive::FusionSettings stated;    ///< without what was learned before
  bool walk_is_open = true;        ///< as LessonTask has it
  FusionSetup setup;               ///< of the present window
  std::set<std::string> left_out;  ///< sources that are not used at present
  Frame frame;
  WindowInputs inputs;
  Stamp oldest;              ///< pose of the window
  std::uint32_t resets = 0;  ///< of the estimate
};

struct Learned {
  Lesson lesson;
  /// with the noise and the sources of the lesson, at the time when the work began; null: it has no minimum, or
  /// what was learned is no reason to build it again, or its nodes are from a source that is left out
  std::unique_ptr<Window> window;
  std::uint64_t inputs = 0;  ///< how many of the former window it has
  std::uint32_t resets = 0;  ///< of the estimate at that time
};

/// @param names of sources; those that the description does not have are passed over
[[nodiscard]] UnusedSources unused_sources(const drive::DriveDescription& description,
                                           const std::set<std::string>& names);

/// @param registry must outlive the result @param between as for learn()
[[nodiscard]] Learned search(const SearchTask& task, const TypeRegistry& registry,
                             const std::function<void()>& between);

}  // namespace waymark::live

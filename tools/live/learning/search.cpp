#include <waymark/tools/live/learning/search.hpp>

#include <waymark/tools/live/estimator/window/window_setup.hpp>

namespace waymark::live {

Learned search(const SearchTask& task, const TypeRegistry& registry, const std::function<void()>& between) {
  Learned learned;
  learned.lesson =
      learn(task.so_far, described_so_far(task.description, task.frame), task.stated, registry, between);
  learned.inputs = task.inputs.count();
  learned.resets = task.resets;
  if (learned.lesson.noise.parameters.empty()) return learned;
  learned.window = make_window(task.description, learned.lesson.setup, task.frame,
                               task.inputs.before().first_pose, registry);
  if (!learned.window->begin_again(task.inputs, task.oldest)) learned.window.reset();
  return learned;
}

}  // namespace waymark::live

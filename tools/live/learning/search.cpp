#include <waymark/tools/live/learning/search.hpp>

#include <waymark/tools/live/learning/claims_ahead.hpp>
#include <waymark/tools/live/learning/unlearned.hpp>

namespace waymark::live {

UnusedSources unused_sources(const drive::DriveDescription& description, const std::set<std::string>& names) {
  UnusedSources unused;
  for (std::size_t source = 0; source < description.odometry.size(); ++source)
    if (names.contains(description.odometry[source].name)) unused.odometries.insert(source);
  for (std::size_t source = 0; source < description.gnss.size(); ++source)
    if (names.contains(description.gnss[source].name)) unused.receivers.insert(static_cast<int>(source));
  return unused;
}

Learned search(const SearchTask& task, const TypeRegistry& registry, const std::function<void()>& between) {
  Learned learned;
  learned.lesson =
      learn(task.so_far,
            {described_so_far(task.description, task.frame), task.stated, task.left_out, task.walk_is_open},
            registry, between);
  learned.lesson.setup.settings = with_noise_of_readings(
      std::move(learned.lesson.setup.settings), task.stated, task.description, task.so_far, registry);
  learned.lesson.setup.settings = with_claims_ahead(
      std::move(learned.lesson.setup.settings), task.stated, task.description,
      {learned.lesson.noise, learned.lesson.length_s, learned.lesson.setup.claimed}, registry);
  learned.inputs = task.inputs.count();
  learned.resets = task.resets;
  const Lesson& lesson = learned.lesson;
  const bool has_noise = !lesson.noise.parameters.empty();
  if (!lesson.failure.empty() || (!has_noise && lesson.left_out == task.left_out)) return learned;
  const UnusedSources unused = unused_sources(task.description, lesson.left_out);
  if (task.inputs.nodes().empty() || task.inputs.has_nodes_of(unused)) return learned;
  WindowInputs inputs = task.inputs;
  inputs.remove(unused);
  learned.window = make_window(task.description, has_noise ? lesson.setup : task.setup, task.frame,
                               inputs.before().first_pose, registry);
  if (!learned.window->begin_again(inputs, task.oldest)) learned.window.reset();
  return learned;
}

}  // namespace waymark::live

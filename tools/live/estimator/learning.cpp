// What the estimator does with what its drive so far tells.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <waymark/tools/live/estimator/estimator.hpp>
#include <waymark/tools/live/learning/unlearned.hpp>

namespace waymark::live {

void Estimator::learn(Stamp now) {
  if (std::optional<Learned> learned = learner_.result(now)) adopt(std::move(*learned));
  const bool may_search = window_ || !left_out_.empty();
  if (may_search && learner_.is_due(now, so_far_.length_s())) begin_search(now);
}

void Estimator::begin_search(Stamp now) {
  const auto task = std::make_shared<const SearchTask>(SearchTask{
      so_far_, description_, with_open_calibration(stated_, description_, so_far_, registry_),
      walk_is_open(stated_, description_), setup_, left_out_, *frame_,
      window_ ? window_->inputs() : WindowInputs(), window_ ? window_->oldest() : now, says_.counts.resets});
  learner_.begin(now, so_far_.length_s(),
                 [task, &registry = registry_](const std::function<void()>& between) {
                   return search(*task, registry, between);
                 });
}

void Estimator::adopt(Learned learned) {
  ++says_.counts.lessons;
  const Lesson& lesson = learned.lesson;
  tell(lesson);
  if (!lesson.failure.empty()) return;
  if (!lesson.noise.parameters.empty()) {
    setup_ = lesson.setup;
    noise_ = lesson.noise;
    spread_ = lesson.spread;
  }
  leave_out(lesson.left_out);
  take_over(std::move(learned));
}

void Estimator::tell(const Lesson& lesson) {
  const auto of_the_last = [&](const std::string& text) {
    return fmt::format("the last {:.0f} s: {}", lesson.length_s, text);
  };
  for (const std::string& warning : lesson.warnings)
    says_.say_once(now_, "warning", of_the_last(warning), warning);
  if (!lesson.failure.empty())
    says_.say_once(now_, "noise", of_the_last("they tell no noise: " + lesson.failure), lesson.failure);
  if (lesson.noise.parameters.empty()) return;
  const std::string words = in_words(lesson.noise);
  say("noise", "",
      fmt::format("the last {:.0f} s tell: {}", lesson.length_s,
                  words.empty() ? "no noise better than the usual" : words));
}

// A source that is left out is judged again by the next lesson, and may come back.
void Estimator::leave_out(const std::set<std::string>& sources) {
  for (const std::string& source : sources)
    if (!left_out_.contains(source)) say("left_out", source, "the others contradict it: it is not used");
  for (const std::string& source : left_out_)
    if (!sources.contains(source))
      say("left_out", source, "it is no longer shown to be wrong: it is used again");
  left_out_ = sources;
  std::erase_if(pending_, [&](const Sample& sample) { return left_out_.contains(source_of(sample)); });
  if (!window_ || !window_->inputs().has_nodes_of(unused_sources(description_, left_out_))) return;
  reset("reset", "the nodes are from an odometry that is left out now");
  forget_motion();
}

// The window was built again with the noise and the sources that the drive shows. It takes what came since.
void Estimator::take_over(Learned learned) {
  if (!window_ || !learned.window || learned.resets != says_.counts.resets) return;
  WindowInputs inputs = window_->inputs();
  inputs.remove(unused_sources(description_, left_out_));
  learned.window->catch_up(inputs, learned.inputs);
  if (!learned.window->solve()) return;
  const std::vector<StampedPose> former = window_->remaining();
  const auto kept = std::find_if(former.begin(), former.end(), [&](const StampedPose& pose) {
    return pose.stamp >= learned.window->oldest();
  });
  says_.settle({former.begin(), kept});
  window_ = std::move(learned.window);
  ++says_.counts.solutions;
  last_cycle_ = now_;
  publish(true);
}

}  // namespace waymark::live

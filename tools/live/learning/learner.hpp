/// When a live estimate learns from its drive, and the work beside it.
///
/// A search begins a minute after the drive did, and again whenever the drive is half as long again, at
/// least every ten minutes unless less than half of that is remembered. What it finds is used later, by the
/// clock of the drive: after ten seconds, or a fifteenth of the drive. However long it took, a replay says
/// the same. If it took longer, the estimate waits for it.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/live/learning/search.hpp>

namespace waymark::live {

using Work = std::function<Learned(const std::function<void()>& between)>;
/// Runs work now or later, in this thread or another one.
using Beside = std::function<std::future<Learned>(std::function<Learned()> work)>;

class Learner {
 public:
  ~Learner() { forget(); }

  /// Lets work run elsewhere. By default it is done where its result is needed.
  void run_beside(Beside beside) { beside_ = std::move(beside); }
  /// Ends searches when this is set, whoever waits for them. @param stop must outlive the object
  void stop_with(const std::atomic<bool>& stop) { stop_from_outside_ = &stop; }
  /// Tells whether to begin. @param length_s of the drive so far
  [[nodiscard]] bool is_due(Stamp now, double length_s) const;
  /// Begins. @param work is called once; it must own what it uses
  void begin(Stamp now, double length_s, Work work);
  /// Returns what was learned, when its time has come. Empty, too, if the search was stopped from outside.
  [[nodiscard]] std::optional<Learned> result(Stamp now);
  /// Stops the work; its result is lost, and so is the time of the last one: stamps may begin anew.
  void forget();

 private:
  Beside beside_ = [](std::function<Learned()> work) {
    return std::async(std::launch::deferred, std::move(work));
  };
  std::future<Learned> future_;
  std::shared_ptr<std::atomic<bool>> stop_;
  const std::atomic<bool>* stop_from_outside_ = nullptr;
  Stamp ready_;                  // when its result is used
  double next_s_ = 60;           // length of the drive at the next search
  std::optional<Stamp> last_{};  // when the last search began
  double last_length_s_ = 0;     // of the drive then
};

}  // namespace waymark::live

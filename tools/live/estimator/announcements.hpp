/// What an estimator has to say, and its counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/live/estimator/reports.hpp>

namespace waymark::live {

/// Counts of everything that was taken. Nothing is dropped in silence.
struct Counts {
  std::map<std::string, std::size_t> taken;    ///< by source
  std::map<std::string, std::size_t> refused;  ///< by "source: reason"
  std::size_t solutions = 0;
  std::size_t lessons = 0;   ///< of the drive so far that were used
  std::size_t failures = 0;  ///< of solutions
  std::uint32_t resets = 0;
  std::size_t late_fixes = 0;  ///< that entered at their own time
};

class Announcements {
 public:
  Counts counts;

  [[nodiscard]] State state() const { return state_; }
  /// Returns what was said since the last call, in order.
  [[nodiscard]] std::vector<Report> take();

  void say(Stamp now, const std::string& kind, const std::string& source, const std::string& text);
  /// Says it if nothing was said yet that differs from it in numbers alone.
  /// @param text is said @param finding is compared
  void say_once(Stamp now, const std::string& kind, const std::string& text, const std::string& finding);
  /// Counts a sample that is not used. The first one of a kind is told, and then every power of ten.
  void refuse(Stamp now, const std::string& source, const std::string& reason, const std::string& text);
  /// Counts a solution that failed. The first one of a kind is told, and then every power of ten.
  void fail(Stamp now, const std::string& text);
  /// Says a change of the state.
  void change_state(Stamp now, State state, const std::string& why);
  void publish(const LivePose& pose) { reports_.emplace_back(pose); }
  /// Says poses that leave a window: each once, though a window that was built again has some once more.
  void settle(std::span<const StampedPose> poses);
  /// The next windows are others.
  void forget_settled() { settled_.reset(); }

 private:
  void tell_powers(Stamp now, const std::string& kind, const std::string& source, const std::string& text,
                   std::size_t count);

  State state_ = State::waiting;
  std::vector<Report> reports_;
  std::set<std::string> told_;                 // without their numbers
  std::map<std::string, std::size_t> failed_;  // by text
  std::optional<Stamp> settled_;               // the last pose that left a window
};

}  // namespace waymark::live

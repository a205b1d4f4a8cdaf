#include <waymark/tools/live/estimator/announcements.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace waymark::live {
namespace {

std::string without_numbers(std::string text) {
  std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
  return text;
}

}  // namespace

std::vector<Report> Announcements::take() {
  return std::exchange(reports_, {});
}

void Announcements::say(Stamp now, const std::string& kind, const std::string& source,
                        const std::string& text) {
  reports_.emplace_back(Event{now, kind, source, text});
}

void Announcements::say_once(Stamp now, const std::string& kind, const std::string& text,
                             const std::string& finding) {
  if (told_.insert(without_numbers(finding)).second) say(now, kind, "", text);
}

void Announcements::refuse(Stamp now, const std::string& source, const std::string& reason,
                           const std::string& text) {
  tell_powers(now, reason, source, text, ++counts.refused[source + ": " + reason]);
}

void Announcements::fail(Stamp now, const std::string& text) {
  ++counts.failures;
  tell_powers(now, "failure", "", text, ++failed_[text]);
}

void Announcements::tell_powers(Stamp now, const std::string& kind, const std::string& source,
                                const std::string& text, std::size_t count) {
  const double power = std::log10(static_cast<double>(count));
  if (power == std::floor(power))
    say(now, kind, source, count == 1 ? text : fmt::format("{} (so far {} times)", text, count));
}

void Announcements::change_state(Stamp now, State state, const std::string& why) {
  if (state == state_) return;
  say(now, "state", "",
      fmt::format("{} -> {}{}{}", to_string(state_), to_string(state), why.empty() ? "" : ": ", why));
  state_ = state;
}

void Announcements::settle(std::span<const StampedPose> poses) {
  for (const StampedPose& pose : poses) {
    if (settled_ && pose.stamp <= *settled_) continue;
    settled_ = pose.stamp;
    reports_.emplace_back(SettledPose{pose.stamp, pose.pose, counts.resets});
  }
}

}  // namespace waymark::live

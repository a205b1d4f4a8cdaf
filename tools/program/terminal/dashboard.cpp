#include <waymark/tools/program/terminal/dashboard.hpp>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {
namespace {

std::string line_of(const live::Session& session) {
  const live::Counts& counts = session.estimator().counts();
  if (!session.last_pose()) return fmt::format("{}: no pose yet", to_string(session.estimator().state()));
  const live::LivePose& pose = *session.last_pose();
  return fmt::format("{}: {:.2f} m (95 %), last fix {:.1f} s ago, {} solutions, {} resets",
                     to_string(pose.state), pose.radius95_m, pose.fix_age_s, counts.solutions, counts.resets);
}

std::string screen_of(const live::Session& session) {
  std::string screen = line_of(session) + "\n";
  if (session.last_pose()) {
    const live::LivePose& pose = *session.last_pose();
    screen += fmt::format(
        "  place     x {:.2f} m, y {:.2f} m, heading {}, speed {:.2f} m/s\n", pose.pose[0], pose.pose[1],
        pose.heading_known ? fmt::format("{:.2f} deg", pose.pose[2] / kDegree) : "unknown", pose.speed_mps);
  }
  const live::Counts& counts = session.estimator().counts();
  for (const auto& [source, count] : counts.taken) screen += fmt::format("  {:<9} {} used\n", source, count);
  for (const auto& [reason, count] : counts.refused)
    screen += fmt::format("  refused   {} {}\n", count, reason);
  const live::Latencies& latencies = session.latencies();
  screen +=
      fmt::format("  latency   predict {:.0f} us, solve {:.0f} us (99 %: {:.0f}, {:.0f}); window {} poses\n",
                  latencies.predict.quantile_us(0.5), latencies.solve.quantile_us(0.5),
                  latencies.predict.quantile_us(0.99), latencies.solve.quantile_us(0.99),
                  session.estimator().window_size());
  const std::vector<live::Event>& events = session.last_events();
  const std::size_t first = events.size() > 3 ? events.size() - 3 : 0;
  for (std::size_t i = first; i < events.size(); ++i)
    screen += fmt::format("  {}: {}\n", events[i].kind, events[i].text);
  return screen;
}

}  // namespace

Dashboard::Dashboard(bool wanted) : wanted_(wanted), is_terminal_(isatty(STDERR_FILENO) != 0) {}

void Dashboard::show(const live::Session& session) {
  if (!wanted_) return;
  if (!is_terminal_) {
    constexpr int kEvery = 10;
    if (seconds_++ % kEvery == 0)
      std::fprintf(stderr, "%s\n", text::without_controls(line_of(session)).c_str());
    return;
  }
  const std::string screen = text::without_controls(screen_of(session));
  if (lines_ > 0) std::fprintf(stderr, "\033[%dA\033[J", lines_);
  std::fputs(screen.c_str(), stderr);
  lines_ = static_cast<int>(std::count(screen.begin(), screen.end(), '\n'));
}

void Dashboard::end() {
  lines_ = 0;
}

}  // namespace waymark::program

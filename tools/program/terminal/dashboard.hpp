/// The state of a live run on the terminal, drawn anew each second. Where there is no terminal, a line every
/// ten seconds.
#pragma once

#include <string>

#include <waymark/tools/live/session/session.hpp>

namespace waymark::program {

class Dashboard {
 public:
  explicit Dashboard(bool wanted);
  void show(const live::Session& session);
  /// Leaves the last state on the terminal.
  void end();

 private:
  bool wanted_;
  bool is_terminal_;
  int lines_ = 0;
  int seconds_ = 0;
};

}  // namespace waymark::program

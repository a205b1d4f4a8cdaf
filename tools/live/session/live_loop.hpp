/// The loop of a live run: waits for bytes, hands them to the session, records them.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include <waymark/tools/live/session/session.hpp>

namespace waymark::live {

struct LoopOptions {
  std::string record;                       ///< file for the intake; empty: none
  const std::atomic<bool>* stop = nullptr;  ///< ends the run in an orderly way
  std::atomic<bool>* reopen = nullptr;      ///< files are opened again, and it is cleared
  /// takes sentences about inputs: opened, broken, ended. They are no part of what is said about the drive,
  /// so that a recording is repeated to the bit
  std::function<void(const std::string&)> news = {};
  std::function<void()> every_second = {};  ///< for a dashboard, a watchdog
};

/// Runs until all inputs have ended, or until it is stopped.
/// @throws UsageError for inputs that cannot be opened here at all, OutputError for a recording
void run_live(Session& session, const LoopOptions& options);

/// Repeats a recording: the same bytes in the same pieces. @throws InputError
void replay_recording(Session& session, const std::string& file, const LoopOptions& options);

/// Replays the logs of the description in the order of their stamps.
/// @param speed times real time; 0: as fast as possible
void replay_logs(Session& session, double speed, const LoopOptions& options);

}  // namespace waymark::live

#include <waymark/tools/live/session/live_loop.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <poll.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/live/inputs/byte_input.hpp>
#include <waymark/tools/live/session/recording.hpp>

namespace waymark::live {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPause = 0.05;   // s without a byte: the sender pauses, its record is complete
constexpr int kLongestWait = 50;  // ms

double seconds_now() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

std::int64_t arrival_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

bool stopped(const LoopOptions& options) {
  return options.stop != nullptr && options.stop->load();
}

/// What is done now and then, whatever arrives.
class Chores {
 public:
  Chores(Session& session, const LoopOptions& options) : session_(session), options_(options) {}
  /// @returns whether a second is over
  bool work() {
    if (options_.reopen != nullptr && options_.reopen->exchange(false)) session_.reopen();
    const double now_s = seconds_now();
    if (now_s < due_s_) return false;
    due_s_ = now_s + 1;
    session_.work();
    if (options_.every_second) options_.every_second();
    return true;
  }

 private:
  Session& session_;
  const LoopOptions& options_;
  double due_s_ = 0;
};

struct LiveInput {
  std::unique_ptr<ByteInput> bytes;
  std::optional<double> last_s;  // of the last byte; empty: the pause was told
};

/// Hands bytes over, and records them first: what is lost with the process is not more than was used.
class Intaker {
 public:
  Intaker(Session& session, const LoopOptions& options) : session_(session), options_(options) {
    if (!options.record.empty()) recorder_.emplace(options.record);
  }
  void take(std::size_t input, const std::string& bytes) {
    if (recorder_) keep({static_cast<std::uint32_t>(input), arrival_now(), bytes});
    session_.take(input, bytes);
  }
  /// Brings the recording to the disk, once a second.
  void flush() {
    if (recorder_ && !recorder_->flush()) give_up();
  }

 private:
  void keep(const Piece& piece) {
    if (!recorder_->write(piece)) give_up();
  }
  void give_up() {
    recorder_.reset();
    if (options_.news)
      options_.news(options_.record + ": the recording ends here, it cannot be written any more");
  }
  Session& session_;
  const LoopOptions& options_;
  std::optional<Recorder> recorder_;
};

void wait_for(const std::vector<LiveInput>& inputs, const Session& session) {
  std::vector<pollfd> waiting;
  for (const LiveInput& input : inputs)
    if (input.bytes->descriptor() >= 0)
      waiting.push_back(
          {input.bytes->descriptor(), static_cast<short>(input.bytes->connecting() ? POLLOUT : POLLIN), 0});
  for (const int listener : session.listeners()) waiting.push_back({listener, POLLIN, 0});
  (void)::poll(waiting.data(), waiting.size(), kLongestWait);
}

}  // namespace

void run_live(Session& session, const LoopOptions& options) {
  std::vector<LiveInput> inputs;
  for (const Session::Input& input : session.inputs())
    inputs.push_back({std::make_unique<ByteInput>(parse_address(input.file)), std::nullopt});
  Intaker intake(session, options);
  Chores chores(session, options);
  while (!stopped(options)) {
    for (LiveInput& input : inputs) input.bytes->open_if_due(seconds_now());
    wait_for(inputs, session);
    bool any_left = false;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      LiveInput& input = inputs[i];
      std::string bytes = input.bytes->read(seconds_now());
      if (const std::string news = input.bytes->news(); !news.empty() && options.news) options.news(news);
      any_left = any_left || !input.bytes->ended();
      if (!bytes.empty()) {
        input.last_s = seconds_now();
        intake.take(i, bytes);
      } else if (input.last_s && seconds_now() - *input.last_s > kPause) {
        input.last_s.reset();
        intake.take(i, {});
      }
    }
    session.work();
    if (chores.work()) intake.flush();
    if (!any_left) {
      if (options.news) options.news("all inputs have ended: the run ends");
      break;
    }
  }
  intake.flush();
  session.finish();
}

void replay_recording(Session& session, const std::string& file, const LoopOptions& options) {
  Chores chores(session, options);
  read_recording(file, [&](const Piece& piece) {
    if (stopped(options)) return;
    if (piece.input >= session.inputs().size())
      throw InputError(file + ": the recording is of a drive with other inputs");
    session.take(piece.input, piece.bytes);
    chores.work();
  });
  session.finish();
}

void replay_logs(Session& session, double speed, const LoopOptions& options) {
  const std::vector<Sample> samples = session.decode_files();
  Chores chores(session, options);
  const Clock::time_point begin = Clock::now();
  for (const Sample& sample : samples) {
    if (stopped(options)) break;
    if (speed > 0) {
      const double due_s = seconds_between(stamp_of(samples.front()), stamp_of(sample)) / speed;
      while (!stopped(options)) {
        const double left_s = due_s - std::chrono::duration<double>(Clock::now() - begin).count();
        if (left_s <= 0) break;
        std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left_s, 0.05)));
        chores.work();
      }
    }
    session.take(sample);
    chores.work();
  }
  session.finish();
}

}  // namespace waymark::live

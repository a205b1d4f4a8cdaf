#include <waymark/tools/fleet/work/fleet_work.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/hash.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/fleet/work/process_pool.hpp>

namespace waymark::fleet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMessages = "messages.txt";

/// A drive.yaml that cannot be read has the fingerprint of none; its run says why.
std::string fingerprint_of(const std::string& path) {
  try {
    return formats::fnv1a64_hex(formats::read_text_file(path));
  } catch (const InputError&) {
    return "";
  }
}

void remove_folder(const std::string& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) throw OutputError(fmt::format("{}: cannot remove: {}", folder, error.message()));
}

void move_folder(const std::string& from, const std::string& to) {
  remove_folder(to);
  formats::make_folder(fs::path(to).parent_path().string());
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw OutputError(fmt::format("{}: cannot move to {}: {}", from, to, error.message()));
}

/// Removes what the plan does not keep of the results of a drive.
void prune(const std::string& folder, Keep keep) {
  if (keep == Keep::all) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    const bool is_page = name.extension() == ".html";
    const bool is_kept = name == "metrics.json" || name == "summary.json" || name == kMessages ||
                         (keep == Keep::report && is_page);
    if (!is_kept) remove_folder(entry.path().string());
  }
}

/// Returns the last error that the program told, without its own name; else how it ended.
std::string failure_of(const ProcessEnd& end, const std::string& messages) {
  constexpr std::string_view kError = "waymark: error: ";
  const auto told = messages.rfind(kError);
  if (told != std::string::npos) {
    std::string line = messages.substr(told + kError.size());
    line.resize(std::min(line.find('\n'), line.size()));
    return line;
  }
  if (end.signal != 0)
    return fmt::format("ended by signal {} ({}){}", end.signal, ::strsignal(end.signal),
                       end.signal == SIGKILL ? "; the system may have had no memory left" : "");
  return fmt::format("ended with exit code {} and no message", end.exit_code);
}

std::string machine_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

/// One pass over the drives of a work.
class Worker {
 public:
  Worker(const WorkSettings& settings, const std::atomic<bool>& stop, const OnDriveEnd& on_end)
      : settings_(settings), stop_(stop), on_end_(on_end), machine_(machine_name()) {
    const std::string name = settings.task ? fmt::format("task-{}", *settings.task) : FleetFolder::kLocal;
    running_ = settings_.folder.running(name);
    remove_folder(running_);
    formats::make_folder(running_);
  }
  ~Worker() {
    std::error_code left;  // the next worker removes it
    fs::remove_all(running_, left);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  WorkReport run() {
    for (const PlannedDrive& drive : share_of(settings_.plan, settings_.task)) {
      const Due is_due = due(drive, settings_.folder, settings_.retry_failed);
      if (is_due == Due::ended) ++report_.ended_before;
      if (is_due == Due::changed) ++report_.changed;
      if (is_due != Due::ended) waiting_.push_back(drive);
    }
    due_ = waiting_.size();
    report_.interrupted = !pass(settings_.at_once) || !pass_alone() || report_.ended < due_;
    return report_;
  }

 private:
  /// Drives that had too little memory, one after the other.
  bool pass_alone() {
    waiting_.swap(too_large_);
    alone_ = true;
    return pass(1);
  }

  bool pass(std::size_t at_once) {
    const std::uint64_t share = settings_.memory_bytes / std::max<std::size_t>(1, at_once);
    const std::size_t first = started_.size();
    return run_processes(
        [&]() -> std::optional<Process> {
          if (waiting_.empty()) return std::nullopt;
          const std::size_t number = started_.size();
          started_.push_back(std::move(waiting_.front()));
          waiting_.pop_front();
          return process_of(started_.back(), number, share);
        },
        at_once, stop_, [&](std::size_t number, const ProcessEnd& end) { take(first + number, end); });
  }

  Process process_of(const PlannedDrive& drive, std::size_t number, std::uint64_t memory_bytes) {
    const std::string folder = folder_of(number);
    formats::make_folder(folder);
    Process process{.words = {settings_.program, "run", drive.path, "-o", folder},
                    .output_file = "/dev/null",
                    .messages_file = folder + "/" + kMessages,
                    .memory_bytes = memory_bytes,
                    .time_limit_s = settings_.time_limit_s};
    process.words.insert(process.words.end(), settings_.plan.options.begin(), settings_.plan.options.end());
    return process;
  }

  void take(std::size_t number, const ProcessEnd& end) {
    const std::string folder = folder_of(number);
    const PlannedDrive& drive = started_[number];
    const std::string messages = formats::read_text_file(folder + "/" + kMessages);
    if (end.exit_code == settings_.codes.interrupted || end.signal == SIGTERM || end.signal == SIGINT) return;
    if (end.exit_code == settings_.codes.not_written)
      throw OutputError(fmt::format("drive '{}': {}", drive.name, failure_of(end, messages)));
    if (!alone_ && lacks_memory(end, messages)) {
      too_large_.push_back(drive);
      remove_folder(folder);
      return;
    }
    const DriveRecord record = record_of(drive, end, folder, messages);
    keep(record, folder, messages);
    ++report_.ended;
    on_end_(record, report_.ended, due_);
  }

  [[nodiscard]] bool lacks_memory(const ProcessEnd& end, const std::string& messages) const {
    if (end.out_of_time) return false;
    if (end.signal == SIGKILL) return true;
    return end.exit_code != settings_.codes.success &&
           std::any_of(settings_.lack_of_memory.begin(), settings_.lack_of_memory.end(),
                       [&](const std::string& part) { return messages.find(part) != std::string::npos; });
  }

  DriveRecord record_of(const PlannedDrive& drive, const ProcessEnd& end, const std::string& folder,
                        const std::string& messages) const {
    DriveRecord record{.drive = drive.name,
                       .fingerprint = fingerprint_of(drive.path),
                       .label = settings_.plan.label,
                       .program = settings_.program_version,
                       .exit_code = end.exit_code};
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    record.cost = {end.wall_s, end.processor_s, end.memory_bytes, machine_,
                   std::chrono::duration<double>(now).count()};
    const bool has_results = end.signal == 0 && (end.exit_code == settings_.codes.success ||
                                                 end.exit_code == settings_.codes.not_converged);
    if (!has_results) {
      record.reason = end.out_of_time
                          ? fmt::format("killed, because it reached its time limit of {} s (--time-limit)",
                                        settings_.time_limit_s)
                          : failure_of(end, messages);
      return record;
    }
    record.state = end.exit_code == settings_.codes.success ? DriveState::done : DriveState::not_converged;
    add_results(folder, record);
    return record;
  }

  /// The record comes last: a drive with a record has its results.
  void keep(const DriveRecord& record, const std::string& folder, const std::string& messages) {
    prune(folder, record.state == DriveState::failed ? Keep::metrics : settings_.plan.keep);
    if (messages.empty()) remove_folder(folder + "/" + kMessages);
    move_folder(folder, settings_.folder.results(record.drive));
    const std::string file = settings_.folder.record(record.drive);
    formats::make_folder(fs::path(file).parent_path().string());
    formats::write_file_atomically(file, record_json(record));
  }

  /// A number, because the name of a drive may have folders.
  [[nodiscard]] std::string folder_of(std::size_t number) const {
    return running_ + "/" + std::to_string(number);
  }

  const WorkSettings& settings_;
  const std::atomic<bool>& stop_;
  const OnDriveEnd& on_end_;
  std::string machine_;
  std::string running_;
  std::deque<PlannedDrive> waiting_;
  std::deque<PlannedDrive> too_large_;
  std::vector<PlannedDrive> started_;
  std::size_t due_ = 0;
  bool alone_ = false;
  WorkReport report_;
};

}  // namespace

std::vector<PlannedDrive> share_of(const FleetPlan& plan, std::optional<std::size_t> task) {
  if (!task) return plan.drives;
  const std::size_t begin = std::min(*task * plan.per_task, plan.drives.size());
  const std::size_t end = std::min(begin + plan.per_task, plan.drives.size());
  return {plan.drives.begin() + static_cast<std::ptrdiff_t>(begin),
          plan.drives.begin() + static_cast<std::ptrdiff_t>(end)};
}

Due due(const PlannedDrive& drive, const FleetFolder& folder, bool retry_failed) {
  const std::string file = folder.record(drive.name);
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return Due::yes;
  const DriveRecord record = read_record(file);
  if (record.fingerprint != fingerprint_of(drive.path)) return Due::changed;
  return retry_failed && record.state == DriveState::failed ? Due::yes : Due::ended;
}

WorkReport work(const WorkSettings& settings, const std::atomic<bool>& stop, const OnDriveEnd& on_end) {
  return Worker(settings, stop, on_end).run();
}

FleetLock::FleetLock(const FleetFolder& folder) {
  descriptor_ = ::open(folder.lock().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    throw OutputError(fmt::format("{}: cannot write: {}", folder.lock(), std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw UsageError(folder.path() + ": another process works on this fleet; wait for it, or stop it first");
}

FleetLock::~FleetLock() {
  ::close(descriptor_);
}

}  // namespace waymark::fleet

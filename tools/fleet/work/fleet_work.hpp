/// Works through the drives of a fleet, or through a share of them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/fleet/folder/fleet_plan.hpp>
#include <waymark/tools/fleet/table/drive_record.hpp>

namespace waymark::fleet {

/// What the exit codes of `waymark run` mean for a fleet.
struct RunCodes {
  int success = 0;
  int not_converged = 4;
  int not_written = 5;    ///< ends the fleet: the next drive would not be written either
  int interrupted = 130;  ///< the drive has not ended, and is run again another time
};

struct WorkSettings {
  FleetFolder folder;
  FleetPlan plan;
  std::string program;          ///< file of the program `waymark`
  std::string program_version;  ///< "waymark 0.1.0"
  RunCodes codes{};
  /// Parts of messages by which a drive says that it needs more memory than it may have.
  std::vector<std::string> lack_of_memory{};
  std::size_t at_once = 1;
  std::uint64_t memory_bytes = 0;     ///< that all drives together may have
  double time_limit_s = 0;            ///< of each drive; 0: none
  std::optional<std::size_t> task{};  ///< of a cluster: only the drives of this one
  bool retry_failed = false;          ///< run failed drives again
};

/// What is to be done before a drive is run.
enum class Due {
  yes,
  ended,   ///< its record stands
  changed  ///< its record is of another drive.yaml, so it is run again
};

struct WorkReport {
  std::size_t ended_before = 0;
  std::size_t changed = 0;  ///< run again because their drive.yaml changed
  std::size_t ended = 0;    ///< by this work
  bool interrupted = false;
};

/// Called for each drive that has ended.
using OnDriveEnd = std::function<void(const DriveRecord& record, std::size_t ended, std::size_t due)>;

/// Returns the drives of a task.
[[nodiscard]] std::vector<PlannedDrive> share_of(const FleetPlan& plan, std::optional<std::size_t> task);

/// Tells whether a drive has to be run.
[[nodiscard]] Due due(const PlannedDrive& drive, const FleetFolder& folder, bool retry_failed);

/// Runs every drive that is due as `PROGRAM run DRIVE -o FOLDER OPTIONS`, each in its own process, with
/// at most memory_bytes / at_once of data. One that needs more is run again at the end, alone, with all of
/// it. One that reaches the time limit is killed and has failed. A drive is run in a folder of the
/// worker, and its results are moved to their place when they are complete; then its record is written,
/// which ends it. A work that is killed therefore leaves whole results only, and the next one begins with
/// the drives that have no record.
/// @param stop ends the work: what runs is killed, what has ended is kept
/// @throws OutputError if results cannot be written
WorkReport work(const WorkSettings& settings, const std::atomic<bool>& stop, const OnDriveEnd& on_end);

/// Holds the fleet for one worker on this machine.
class FleetLock {
 public:
  /// @throws UsageError if another process holds it
  explicit FleetLock(const FleetFolder& folder);
  ~FleetLock();
  FleetLock(const FleetLock&) = delete;
  FleetLock& operator=(const FleetLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace waymark::fleet

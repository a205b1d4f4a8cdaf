// The pieces of a fleet's work: processes beside each other, shares of a cluster, names of drives.
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <unistd.h>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/detail/address_sanitizer.hpp>
#include <waymark/tools/fleet/folder/fleet_plan.hpp>
#include <waymark/tools/fleet/work/fleet_work.hpp>
#include <waymark/tools/fleet/work/process_pool.hpp>
#include <waymark/tools/fleet/work/slurm.hpp>

#include "support/skip.hpp"

namespace fleet_work_test {

using namespace waymark::fleet;
namespace fs = std::filesystem;

namespace {

/// A folder that is removed at the end of the case.
class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / ("waymark_fleet_" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Scratch() { fs::remove_all(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text = "") const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return file(name);
  }

 private:
  fs::path path_;
};

Process shell(const Scratch& scratch, const std::string& script) {
  return {.words = {"/bin/sh", "-c", script},
          .output_file = scratch.file("out"),
          .messages_file = scratch.file("err")};
}

/// Runs scripts and returns how they ended, in the order of their starts.
std::vector<ProcessEnd> ends_of(const Scratch& scratch, const std::vector<std::string>& scripts,
                                std::size_t at_once, std::uint64_t memory = 0, double time_limit_s = 0) {
  const std::atomic<bool> never{false};
  std::vector<ProcessEnd> ends(scripts.size());
  std::size_t next = 0;
  CHECK(run_processes(
      [&]() -> std::optional<Process> {
        if (next == scripts.size()) return std::nullopt;
        Process process = shell(scratch, scripts[next++]);
        process.memory_bytes = memory;
        process.time_limit_s = time_limit_s;
        return process;
      },
      at_once, never, [&](std::size_t number, const ProcessEnd& end) { ends.at(number) = end; }));
  return ends;
}

std::vector<std::string> names_of(const std::vector<PlannedDrive>& drives) {
  std::vector<std::string> names;
  for (const PlannedDrive& drive : drives) names.push_back(drive.name);
  return names;
}

bool is_alive(pid_t process) {
  return ::kill(process, 0) == 0;
}

/// Whoever adopts a process whose parent died may take a moment to reap it: until then it is a zombie.
bool dies_soon(pid_t process) {
  for (int i = 0; i < 200 && is_alive(process); ++i) {
    pid_t number = 0;
    std::string name;
    char state = 'Z';
    std::ifstream("/proc/" + std::to_string(process) + "/stat") >> number >> name >> state;
    if (state == 'Z') return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return !is_alive(process);
}

}  // namespace

TEST_CASE("fleet: a process that fails or crashes ends alone, and its end is told") {
  const Scratch scratch;
  const std::vector<ProcessEnd> ends = ends_of(scratch, {"exit 0", "exit 7", "kill -SEGV $$", "true"}, 2);
  CHECK(ends[0].exit_code == 0);
  CHECK(ends[1].exit_code == 7);
  CHECK(ends[2].signal == SIGSEGV);
  CHECK(ends[3].exit_code == 0);
  CHECK(ends[3].memory_bytes > 100 * 1024);  // a shell has more
}

TEST_CASE("fleet: processes run beside each other, and never more than asked for") {
  const Scratch scratch;
  const std::string folder = scratch.file("now");
  fs::create_directories(folder);
  const std::string script = "mkdir " + folder + "/$$ && sleep 0.1 && ls " + folder + " | wc -l >> " +
                             scratch.file("counts") + " && rmdir " + folder + "/$$";
  (void)ends_of(scratch, std::vector<std::string>(9, script), 3);
  std::ifstream counts(scratch.file("counts"));
  int most = 0;
  int lines = 0;
  for (int count = 0; counts >> count; ++lines) most = std::max(most, count);
  CHECK(lines == 9);
  CHECK(most == 3);
}

TEST_CASE("fleet: a process has no more memory than its share") {
  const Scratch scratch;
  const std::string taker = "head -c 60000000 /dev/zero | tail -c 60000000 | wc -c > " + scratch.file("size");
  const auto size = [&] {
    long read = -1;
    std::ifstream(scratch.file("size")) >> read;
    return read;
  };
  (void)ends_of(scratch, {taker}, 1);
  CHECK(size() == 60000000);
  if (waymark::detail::kAddressSanitized) return waymark_test::skip("AddressSanitizer knows no limit of memory");
  (void)ends_of(scratch, {taker}, 1, 20000000);
  CHECK(size() < 60000000);
}

TEST_CASE("fleet: a stop kills what runs, with its own children") {
  const Scratch scratch;
  std::atomic<bool> stop{false};
  bool is_given = false;
  int told = 0;
  std::thread stopper([&] {
    for (int i = 0; i < 500 && fs::exists(scratch.file("child")) == false; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop = true;
  });
  const bool all = run_processes(
      [&]() -> std::optional<Process> {
        if (is_given) return std::nullopt;
        is_given = true;
        return shell(scratch, "sleep 60 & echo $! > " + scratch.file("child") + "; wait");
      },
      2, stop, [&](std::size_t, const ProcessEnd&) { ++told; });
  stopper.join();
  CHECK_FALSE(all);
  CHECK(told == 0);
  pid_t child = 0;
  std::ifstream(scratch.file("child")) >> child;
  REQUIRE(child > 0);
  CHECK(dies_soon(child));
}

TEST_CASE("fleet: a process that reaches its time limit is killed with its own children, and no other") {
  const Scratch scratch;
  const std::string hangs = "sleep 60 & echo $! > " + scratch.file("child") + "; wait";
  const std::vector<ProcessEnd> ends = ends_of(scratch, {"exit 7", hangs, "kill -KILL $$"}, 3, 0, 1.5);
  CHECK(ends[0].exit_code == 7);
  CHECK_FALSE(ends[0].out_of_time);
  CHECK(ends[1].signal == SIGKILL);
  CHECK(ends[1].out_of_time);
  CHECK(ends[1].wall_s >= 1.5);
  CHECK(ends[1].wall_s < 30);
  CHECK_FALSE(ends[2].out_of_time);  // killed by something else
  pid_t child = 0;
  std::ifstream(scratch.file("child")) >> child;
  REQUIRE(child > 0);
  CHECK(dies_soon(child));
}

TEST_CASE("fleet: drives are called by the folders of their drive.yaml") {
  const Scratch scratch;
  scratch.write("week/monday/1/drive.yaml");
  scratch.write("week/monday/2/drive.yaml");
  scratch.write("week/tuesday/1/drive.yaml");
  scratch.write("week/tuesday/1/notes.yaml");
  const std::string alone = scratch.write("alone/drive.yaml");
  const std::string named = scratch.write("alone/named.yaml");
  CHECK(names_of(find_drives({scratch.file("week")})) ==
        std::vector<std::string>{"monday/1", "monday/2", "tuesday/1"});
  CHECK(names_of(find_drives({scratch.file("week/monday/"), named, alone, alone})) ==
        std::vector<std::string>{"1", "2", "alone", "named"});
  CHECK(find_drives({alone}).at(0).path == alone);
  CHECK(names_of(find_drives({scratch.file("alone")})) == std::vector<std::string>{"alone"});
  CHECK_THROWS_WITH(
      find_drives({scratch.file("week/monday"), scratch.file("week/tuesday")}),
      Catch::Contains("two drives are called '1'") && Catch::Contains("name the folder above both"));
  CHECK_THROWS_AS(find_drives({scratch.file("nowhere")}), waymark::InputError);
  scratch.write("week/monday/1/again/drive.yaml");
  CHECK_THROWS_WITH(find_drives({scratch.file("week")}),
                    Catch::Contains("'monday/1/again' lies in the folder of drive 'monday/1'"));
}

TEST_CASE("fleet: a plan reads back, and tells from another one") {
  const Scratch scratch;
  const FleetFolder folder(scratch.file(""));
  const FleetPlan plan{.label = "a \"b\"",
                       .options = {"--modeling=g1"},
                       .keep = Keep::metrics,
                       .per_task = 3,
                       .drives = {{"x/1", "/x/1/drive.yaml"}}};
  scratch.write("fleet.json", plan_json(plan));
  const FleetPlan read = read_plan(folder);
  CHECK(plan_json(read) == plan_json(plan));
  CHECK(difference(plan, read).empty());
  FleetPlan other = plan;
  other.options = {};
  CHECK(difference(plan, other) == "its options are: --modeling=g1; now: none");
  scratch.write("fleet.json", R"({"schema": "waymark-fleet-plan", "version": 1, "label": 7})");
  CHECK_THROWS_WITH(read_plan(folder), Catch::Contains("label: expected"));
}

TEST_CASE("fleet: tasks share the drives, each drive is in one of them") {
  FleetPlan plan{.label = "", .options = {}, .per_task = 3, .drives = {}};
  for (int i = 0; i < 10; ++i) plan.drives.push_back({std::to_string(i), ""});
  CHECK(plan.tasks() == 4);
  std::vector<std::string> all;
  for (std::size_t task = 0; task < 4; ++task)
    for (const std::string& name : names_of(share_of(plan, task))) all.push_back(name);
  CHECK(all == names_of(plan.drives));
  CHECK(share_of(plan, 4).empty());
}

TEST_CASE("fleet: an index list of Slurm has ranges and single tasks") {
  CHECK(array_text({0}) == "0");
  CHECK(array_text({0, 1, 2, 3, 7, 9, 10}) == "0-3,7,9-10");
}

TEST_CASE("fleet: a batch script keeps names with quotes and spaces together") {
  CHECK(quoted("it's") == "'it'\\''s'");
  const FleetPlan plan{.label = "night", .options = {}, .drives = {{"a", ""}}};
  const std::string script = slurm_script(plan, FleetFolder("/data/my fleet/50%"), {0},
                                          {.program = "/opt/it's/waymark",
                                           .processors = 2,
                                           .memory_mb = 900,
                                           .options = {"--partition=long"},
                                           .time_limit_s = 5400});
  CHECK(script.find("#SBATCH --output='/data/my fleet/50%%/slurm/task-%a.log'\n") != std::string::npos);
  CHECK(script.find("#SBATCH --array=0\n") != std::string::npos);
  CHECK(script.find("#SBATCH --mem=900M\n") != std::string::npos);
  CHECK(script.find("#SBATCH --requeue\n") != std::string::npos);
  CHECK(script.find("#SBATCH --partition=long\n") != std::string::npos);
  CHECK(script.find(
            "exec '/opt/it'\\''s/waymark' fleet work '/data/my fleet/50%' --task \"$SLURM_ARRAY_TASK_ID\" "
            "--jobs 2 --memory 900 --time-limit 5400\n") != std::string::npos);
}

}  // namespace fleet_work_test

// Pipes: what comes once is read once, and what never ends is refused before it fills the memory.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <waymark/core/base/detail/address_sanitizer.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace pipes_test {

namespace {

/// Runs a line of bash in a folder; "$WAYMARK" is the program.
RunResult shell(const std::string& folder, const std::string& line) {
  return run({"-c", "WAYMARK=$0; " + line, waymark_test::program_path()},
             {.folder = folder, .program = "/bin/bash"});
}

}  // namespace

TEST_CASE("pipes: text without an end is refused with little memory") {
  if (waymark::detail::kAddressSanitized)
    return waymark_test::skip("AddressSanitizer needs the address space that is limited here");
  const std::string folder = fresh_folder();
  // 1.2 GB of address space hold the program and its libraries, and 60 s would fill them many times.
  const std::string limit = "ulimit -v 1200000; yes LINE | exec timeout 60 \"$WAYMARK\" ";
  for (const char* command :
       {"check /dev/stdin", "check --input-format toro /dev/stdin", "convert /dev/stdin -o a.graph",
        "optimize /dev/stdin -o a.graph", "evaluate /dev/stdin", "run /dev/stdin -o out", "doctor /dev/stdin",
        "sync /dev/stdin", "live /dev/stdin", "inspect /dev/stdin"}) {
    const RunResult result = shell(folder, limit + command);
    INFO(command << "\n" << result.err);
    CHECK(result.code == 3);
    CHECK_FALSE(contains(result.err, "more memory than there is"));
  }
  const RunResult result = shell(folder, limit + "check /dev/stdin");
  CHECK(contains(result.err, "/dev/stdin: no line with a known tag from byte 1 to 1048576"));
  CHECK(contains(shell(folder, "yes '#' | \"$WAYMARK\" run /dev/stdin -o out").err,
                 "/dev/stdin: is longer than 16 MiB, and a drive.yaml is not"));
  // A valid beginning does not help what follows.
  CHECK(shell(folder,
              "(echo GRAPH 1; yes x) | (ulimit -v 1200000; exec timeout 60 \"$WAYMARK\" check /dev/stdin)")
            .code == 3);
}

TEST_CASE(
    "pipes: a log that comes from a pipe is read as the file is, though its format is looked for first") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  const RunResult file = run({"inspect", "gnss.csv"}, {.folder = folder});
  REQUIRE(file.code == 0);
  const RunResult pipe = shell(folder, "cat gnss.csv | \"$WAYMARK\" inspect /dev/stdin");
  CHECK(pipe.code == 0);
  const std::size_t begin = file.out.find("  gnss ");
  REQUIRE(begin != std::string::npos);
  const std::string found = file.out.substr(begin, file.out.find('\n', begin) - begin);
  CHECK(contains(found, " fixes"));
  CHECK(contains(pipe.out, found));
  const RunResult packed = shell(folder, "gzip -c gnss.csv | \"$WAYMARK\" inspect /dev/stdin");
  CHECK(contains(packed.out, found));
}

TEST_CASE("pipes: a drive whose drive.yaml and logs are pipes gives the poses of the files") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  const RunResult result =
      shell(folder,
            "\"$WAYMARK\" run drive.yaml -o files > files.txt || exit 1\n"
            "mkdir pipes; sed -e 's/odometry.csv/odometry.pipe/' -e 's/gnss.csv/gnss.pipe/' "
            "drive.yaml > pipes.yaml\n"
            "mkfifo odometry.pipe gnss.pipe\n"
            "cat odometry.csv > odometry.pipe & cat gnss.csv > gnss.pipe &\n"
            "timeout 60 \"$WAYMARK\" run <(cat pipes.yaml) --data . -o out > pipes.txt || exit 2\n"
            "cmp files/correlated.csv out/correlated.csv && echo same\n");
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(contains(result.out, "same"));
}

TEST_CASE("pipes: a recording that comes from a pipe is played as the file is") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  const RunResult result = shell(
      folder,
      "sed -e 's/odometry.csv/o.pipe, format: csv/' -e 's/gnss.csv/g.pipe, format: csv/' drive.yaml > live.yaml\n"
      "mkfifo o.pipe g.pipe\n"
      "\"$WAYMARK\" live live.yaml -o json:a.jsonl --record take 2> log & pid=$!\n"
      "cat odometry.csv > o.pipe; cat gnss.csv > g.pipe; sleep 1; kill -TERM $pid; wait $pid\n"
      "\"$WAYMARK\" live live.yaml -o json:b.jsonl --play <(cat take) && cmp a.jsonl b.jsonl && echo same\n");
  INFO(result.err << read_text(folder + "log"));
  CHECK(contains(result.out, "same"));
}

TEST_CASE("pipes: a folder that another program writes into is refused, and left as it was") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  for (const char* command : {"run drive.yaml -o out", "simulate --preset rural --duration 20 -o out"}) {
    REQUIRE(shell(folder, "rm -rf out; mkdir out").code == 0);
    const int held = ::open((folder + "out").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    REQUIRE(held >= 0);
    REQUIRE(::flock(held, LOCK_EX) == 0);
    const RunResult refused = shell(folder, std::string("exec \"$WAYMARK\" ") + command);
    INFO(refused.err);
    CHECK(refused.code == 5);
    CHECK(contains(refused.err,
                   "out: another program of Waymark writes into this folder now; wait until it has ended"));
    CHECK(names_in(folder + "out").empty());
    ::close(held);
    CHECK(shell(folder, std::string("exec \"$WAYMARK\" ") + command).code == 0);
  }
}

}  // namespace pipes_test

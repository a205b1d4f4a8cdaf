// Where results go: full disks, pipes, folders, devices. Nothing half-written is ever left.
#include <catch2/catch.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace output_test {

namespace {

const std::vector<std::string> kOnlyInput = {"a.graph"};

std::string folder_with_graph() {
  std::string folder = fresh_folder();
  write_text(folder + "a.graph", square_graph());
  return folder;
}

}  // namespace

TEST_CASE("output: a graph on standard output is a graph, and the report goes elsewhere") {
  for (const char* name : {"-", "/dev/stdout"}) {
    const std::string folder = folder_with_graph();
    const RunResult result = run({"optimize", "a.graph", "-o", name}, {.folder = folder});
    INFO(name);
    CHECK(result.code == 0);
    CHECK(result.out.rfind("GRAPH 1\n", 0) == 0);
    CHECK(contains(result.err, "converged: "));
    CHECK(names_in(folder) == kOnlyInput);
    write_text(folder + "b.graph", result.out);
    CHECK(run({"check", folder + "b.graph"}).code == 0);
  }
  const std::string folder = fresh_folder();
  const RunResult converted = run({"convert", write_drive(folder), "-o", "-"});
  CHECK(converted.code == 0);
  CHECK(converted.out.rfind("GRAPH 1\n", 0) == 0);
  CHECK(contains(converted.err, "written     -"));
  write_text(folder + "b.graph", converted.out);
  CHECK(run({"check", folder + "b.graph"}).code == 0);
}

TEST_CASE("output: standard output in a file: the graph stands in it whole") {
  const std::string folder = folder_with_graph();
  const RunResult result =
      run({"optimize", "a.graph", "-o", "/dev/stdout"}, {.out_file = folder + "out.graph", .folder = folder});
  CHECK(result.code == 0);
  CHECK(run({"check", folder + "out.graph"}).code == 0);
}

TEST_CASE("output: a full disk: exit 5, the old file is kept and nothing partial is left") {
  const std::string folder = folder_with_graph();
  write_text(folder + "b.graph", "old");
  const RunResult limited =
      run({"optimize", "a.graph", "-o", "b.graph"}, {.file_size_limit = 100, .folder = folder});
  CHECK(limited.code == 5);
  CHECK(limited.err == "waymark: error: b.graph: cannot write: File too large\n");
  CHECK(read_text(folder + "b.graph") == "old");
  CHECK(names_in(folder) == std::vector<std::string>{"a.graph", "b.graph"});

  const RunResult device = run({"optimize", "a.graph", "-o", "/dev/full"}, {.folder = folder});
  CHECK(device.code == 5);
  CHECK(device.err == "waymark: error: /dev/full: cannot write: No space left on device\n");
}

TEST_CASE("output: a full disk under the shell's limit ends a run the same way") {
  const std::string folder = fresh_folder();
  write_drive(folder);
  const RunResult result =
      run({"-c", "ulimit -f 8; exec \"$0\" run drive.yaml --out results", waymark_test::program_path()},
          {.folder = folder, .program = "/bin/sh"});
  CHECK(result.code == 5);
  CHECK(contains(result.err, "results/correlated.graph: cannot write: File too large"));
  CHECK(names_in(folder + "results").empty());
}

TEST_CASE("output: a report that cannot be written is an error too") {
  // Guards against a full disk that looks like success to a script.
  const std::string folder = folder_with_graph();
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"check", "a.graph"},
                                                    {"info"},
                                                    {"info", "--json"},
                                                    {"--help"},
                                                    {"help", "run"},
                                                    {"completion", "bash"},
                                                    {"doctor"},
                                                    {"--version"}}) {
    INFO(arguments[0]);
    const RunResult result = run(arguments, {.out_file = "/dev/full", .folder = folder});
    CHECK(result.code == 5);
    CHECK(contains(result.err, "standard output: cannot write"));
  }
}

TEST_CASE("output: a reader that has gone is an error, not a death by signal") {
  const RunResult result = run({"info"}, {.close_output = true});
  CHECK(result.code == 5);
  CHECK(contains(result.err, "standard output: cannot write: Broken pipe"));
}

TEST_CASE("output: outputs that cannot be are refused before the work") {
  const std::string folder = folder_with_graph();
  const RunResult is_folder = run({"optimize", "a.graph", "-o", ".", "-v"}, {.folder = folder});
  CHECK(is_folder.code == 5);
  CHECK(is_folder.err == "waymark: error: .: cannot write: it is a folder\n");
  const RunResult nowhere = run({"optimize", "a.graph", "-o", "none/b.graph", "-v"}, {.folder = folder});
  CHECK(nowhere.code == 5);
  CHECK(nowhere.err == "waymark: error: none/b.graph: cannot write: its folder does not exist\n");
  const RunResult under_file = run({"optimize", "a.graph", "-o", "a.graph/b.graph"}, {.folder = folder});
  CHECK(under_file.code == 5);
  CHECK(names_in(folder) == kOnlyInput);
}

TEST_CASE("output: an output folder that is a file is an output error, not an internal one") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  write_text(folder + "results", "a file");
  const RunResult ran = run({"run", drive, "--out", folder + "results"});
  CHECK(ran.code == 5);
  CHECK(contains(ran.err, "results: cannot make the folder: Not a directory"));
  CHECK(run({"convert", drive, "-o", folder + "a.graph", "-q"}).code == 0);
  for (const char* name : {"results", "results/below"}) {
    const RunResult evaluated = run({"evaluate", folder + "a.graph", "--out", folder + name});
    INFO(name);
    CHECK(evaluated.code == 5);
    CHECK(contains(evaluated.err, "cannot make the folder: Not a directory"));
  }
  CHECK(read_text(folder + "results") == "a file");
}

TEST_CASE("output: output folders are made, also in depth") {
  const std::string folder = fresh_folder();
  CHECK(run({"run", write_drive(folder), "--out", folder + "a/b/c", "-q"}).code == 0);
  CHECK(exists(folder + "a/b/c/metrics.json"));
}

}  // namespace output_test

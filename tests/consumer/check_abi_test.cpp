// tools/packaging/check_abi.sh: changes that the next version of a library may have, and those it may not.
#include <filesystem>

#include <catch2/catch.hpp>

#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace {

namespace fs = std::filesystem;

const std::string kScript = waymark_test::source_dir() + "/tools/packaging/check_abi.sh";
const std::string kSource = waymark_test::source_dir() + "/tests/consumer/abi";

/// The sample library with one of the header's changes; its file.
std::string build(const std::string& change) {
  const std::string folder = fresh_folder();
  fs::copy(kSource + "/include", folder + "include", fs::copy_options::recursive);
  const std::string library = folder + "libsensor.so";
  const RunResult built = run({"-g", "-shared", "-fPIC", "-D" + change, "-I" + folder + "include",
                               kSource + "/sensor.cpp", "-o", library},
                              {.program = COMPILER});
  INFO(built.err);
  REQUIRE(built.code == 0);
  return library;
}

RunResult check_abi(const std::string& before, const std::string& after) {
  return run({before, after}, {.program = kScript});
}

bool no_abidiff() {
  if (fs::exists("/usr/bin/abidiff")) return false;
  waymark_test::skip("no abidiff (Debian package abigail-tools)");
  return true;
}

}  // namespace

TEST_CASE("ABI: a changed layout and an added virtual function are reported") {
  if (no_abidiff()) return;
  const std::string before = build("NOTHING");
  for (const auto& [change, said] :
       {std::pair{"CHANGED_LAYOUT", "double sigma"}, std::pair{"ADDED_VIRTUAL", "Sensor::reset"}}) {
    const RunResult result = check_abi(before, build(change));
    INFO(change << "\n" << result.out << result.err);
    CHECK(result.code == 1);
    CHECK(contains(result.out, said));
    CHECK(contains(result.out, "not compatible"));
  }
}

TEST_CASE("ABI: an added function and a change of what no public header shows pass") {
  if (no_abidiff()) return;
  const std::string before = build("NOTHING");
  for (const char* change : {"NOTHING", "ADDED_FUNCTION", "CHANGED_PRIVATE"}) {
    const RunResult result = check_abi(before, build(change));
    INFO(change << "\n" << result.out << result.err);
    CHECK(result.code == 0);
    CHECK(contains(result.out, "compatible"));
  }
}

TEST_CASE("ABI: the installed library is compatible with itself") {
  if (no_abidiff()) return;
  // Of its symbols; with debug information, as some presets have it, abidiff takes a minute.
  const std::string folder = fresh_folder();
  fs::create_directory(folder + "include");
  const std::string library = folder + "libwaymark_core.so";
  REQUIRE(run({"--strip-debug", INSTALLED_LIBDIR "/libwaymark_core.so", "-o", library},
              {.program = "/usr/bin/strip"})
              .code == 0);
  const RunResult result = check_abi(library, library);
  INFO(result.out << result.err);
  CHECK(result.code == 0);
}

TEST_CASE("ABI: a file that is not there is a wrong use") {
  const RunResult result = check_abi("/nowhere/old.so", "/nowhere/new.so");
  CHECK(result.code == 2);
  CHECK(contains(result.err, "usage"));
}

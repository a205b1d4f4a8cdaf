// Which libraries the program loads is no matter of the folder it is started in.
#include <filesystem>

#include <catch2/catch.hpp>

#include "support/paths.hpp"
#include "support/run_path.hpp"

namespace run_path_test {

TEST_CASE("run path: no binary or module of the build has an empty or relative entry") {
  const std::filesystem::path bin = std::filesystem::path(waymark_test::program_path()).parent_path();
  std::size_t seen = 0;
  for (const char* part : {"bin", "lib", "plugins", "test_modules", "examples"}) {
    if (!std::filesystem::exists(bin.parent_path() / part)) continue;
    for (const std::string& file : waymark_test::binaries_below(bin.parent_path() / part)) {
      INFO(file);
      CHECK(waymark_test::is_safe(waymark_test::run_path(file)));
      ++seen;
    }
  }
  CHECK(seen > 2);
}

TEST_CASE("hardening: every binary is position independent, with relocations that are bound and read-only") {
  const std::filesystem::path build =
      std::filesystem::path(waymark_test::program_path()).parent_path().parent_path();
  std::vector<std::string> arguments{"--linked"};
  for (const char* part : {"bin", "lib", "plugins", "test_modules", "examples"})
    if (std::filesystem::exists(build / part)) arguments.push_back(build / part);
  const RunResult result =
      run(arguments, {.program = waymark_test::source_dir() + "/tools/packaging/check_hardening.sh"});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
}

TEST_CASE("run path: a library beside a log is not loaded") {
  const std::string folder = fresh_folder();
  write_text(folder + "libz.so.1", "no library, so that loading it would be an error");
  const RunResult result = run({"--version"}, {.folder = folder});
  INFO(result.err);
  CHECK(result.code == 0);
}

}  // namespace run_path_test

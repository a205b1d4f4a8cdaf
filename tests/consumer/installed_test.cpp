// Requirements on the installed tree, and the flags that a plugin may not be built with.
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/run_path.hpp"

namespace {

namespace fs = std::filesystem;

const std::string kPrefix = INSTALLED_PREFIX;

/// waymark_add_plugin's look at the flags, without a compiler.
RunResult check_flags(const std::string& variable, const std::string& flags,
                      const std::string& of_waymark = "") {
  const std::string script =
      write_text(fresh_folder() + "flags.cmake", "set_property(GLOBAL PROPERTY WAYMARK_CXX_FLAGS \"" +
                                                     of_waymark + "\")\ninclude(" + INSTALLED_LIBDIR +
                                                     "/cmake/waymark/waymark_add_plugin.cmake)\n"
                                                     "waymark_check_plugin_flags(antenna)\n");
  return run({"-D" + variable + "=" + flags, "-DCMAKE_BUILD_TYPE=Release", "-P", script}, {.program = CMAKE});
}

/// The names in one list of tools/cmake/public_headers.cmake.
std::set<std::string> header_list(const std::string& list) {
  const std::string text = read_text(waymark_test::source_dir() + "/tools/cmake/public_headers.cmake");
  const auto begin = text.find("set(" + list) + 4 + list.size();
  std::istringstream words(text.substr(begin, text.find(')', begin) - begin));
  return {std::istream_iterator<std::string>(words), {}};
}

/// Adds a header and all of ours that it includes.
void add_with_includes(const std::string& folder, const std::string& header, std::set<std::string>& found) {
  if (!found.insert(header).second) return;
  std::istringstream lines(read_text(folder + header));
  for (std::string line; std::getline(lines, line);) {
    const std::string start = "#include <waymark/";
    if (line.starts_with(start)) {
      add_with_includes(folder, line.substr(start.size(), line.find('>') - start.size()), found);
    }
  }
}

}  // namespace

TEST_CASE("installed: the program runs from any prefix, and nothing points into the build") {
  const RunResult result = run({"--version"}, {.program = kPrefix + "/bin/waymark"});
  REQUIRE(result.code == 0);
  CHECK(result.out.starts_with("waymark "));
  CHECK(waymark_test::run_path(kPrefix + "/bin/waymark").front().starts_with("$ORIGIN/../lib"));
  for (const std::string& file : waymark_test::binaries_below(kPrefix)) {
    INFO(file);
    CHECK(waymark_test::is_safe(waymark_test::run_path(file)));
  }
  for (const auto& entry : fs::recursive_directory_iterator(kPrefix)) {
    // The module of Python finds the library as the program does; plugins are loaded by one that has it.
    const bool is_plugin =
        entry.path().extension() == ".so" && !entry.path().filename().string().starts_with("_waymark");
    if (is_plugin) CHECK(waymark_test::run_path(entry.path()).empty());
    const std::string suffix = entry.path().extension();
    if (suffix == ".cmake" || suffix == ".pc") {
      INFO(entry.path());
      CHECK_FALSE(contains(read_text(entry.path()), waymark_test::source_dir()));
    }
  }
}

TEST_CASE("installed: a man page of every subcommand, and the completion where bash-completion looks") {
  CHECK(contains(read_text(kPrefix + "/share/man/man1/waymark.1"), "waymark \\- fuses odometry with GNSS"));
  CHECK(contains(read_text(kPrefix + "/share/man/man1/waymark-run.1"), ".SH SYNOPSIS\n\\fBwaymark run\\fR"));
  const std::string script = read_text(kPrefix + "/share/bash-completion/completions/waymark");
  CHECK(script == run({"completion", "bash"}, {.program = kPrefix + "/bin/waymark"}).out);
}

TEST_CASE("installed: the shared library has a version and a soname") {
  CHECK(fs::is_symlink(INSTALLED_LIBDIR "/libwaymark_core.so"));
  const RunResult result =
      run({"-d", INSTALLED_LIBDIR "/libwaymark_core.so"}, {.program = "/usr/bin/readelf"});
  CHECK(contains(result.out, "soname: [" INSTALLED_SONAME "]"));
}

TEST_CASE("installed: the public headers, those that they must include, and no others") {
  const std::set<std::string> promised = header_list("WAYMARK_PUBLIC_HEADERS");
  const std::set<std::string> included = header_list("WAYMARK_INCLUDED_HEADERS");
  REQUIRE(promised.size() > 50);
  std::set<std::string> installed;
  const std::string folder = kPrefix + "/include/waymark/";
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) installed.insert(fs::relative(entry.path(), folder));
  }
  std::set<std::string> listed = promised;
  listed.insert(included.begin(), included.end());
  listed.insert("version.hpp");
  CHECK(installed == listed);

  std::set<std::string> needed = {"version.hpp"};
  for (const std::string& header : promised) add_with_includes(folder, header, needed);
  CHECK(needed == listed);
  for (const std::string& header : promised) {
    INFO(header);
    CHECK_FALSE(contains(header, "/detail/"));
  }
  for (const std::string& header : included) {
    INFO(header);
    CHECK(contains(header, "/detail/"));
  }
}

TEST_CASE("installed: headers of the shared library show their names, nothing else does") {
  for (const auto& entry : fs::recursive_directory_iterator(waymark_test::source_dir() + "/core")) {
    if (entry.path().extension() != ".hpp" || entry.path().filename() == "export.hpp") continue;
    const std::string header = fs::relative(entry.path(), waymark_test::source_dir());
    INFO(header);
    CHECK(contains(read_text(entry.path()), "\nnamespace WAYMARK_EXPORT waymark {") ==
          fs::exists(kPrefix + "/include/waymark/" + header));
  }
}

TEST_CASE(
    "installed: waymark_add_plugin refuses flags with which the plugin would be refused, with the reason") {
  struct Case {
    const char* flag;
    const char* reason;
  };
  for (const auto& [flag, reason] :
       {Case{"-march=native", "alignment"}, Case{"-mavx", "alignment"}, Case{"-mavx2", "alignment"},
        Case{"-mavx512f", "alignment"}, Case{"-march=x86-64-v3", "alignment"},
        Case{"-ffast-math", "flush-to-zero"}, Case{"-Ofast", "flush-to-zero"},
        Case{"-D_GLIBCXX_DEBUG", "containers"}}) {
    for (const char* variable : {"CMAKE_CXX_FLAGS", "CMAKE_CXX_FLAGS_RELEASE", "CMAKE_MODULE_LINKER_FLAGS"}) {
      const RunResult result = check_flags(variable, flag);
      INFO(variable << " " << result.err);
      CHECK(result.code == 1);
      std::string message;  // CMake breaks lines
      for (const char c : result.err)
        if (c != '\n' || message.back() != ' ') message += c == '\n' ? ' ' : c;
      CHECK(contains(message, "waymark_add_plugin(antenna)"));
      CHECK(contains(message, flag));
      CHECK(contains(message, reason));
      CHECK(contains(message, variable));
    }
  }
}

TEST_CASE("installed: waymark_add_plugin lets other flags pass, and those that waymark was built with") {
  for (const char* flags : {"", "-O3 -g -Wall", "-march=x86-64 -mno-avx", "-D_GLIBCXX_ASSERTIONS",
                            "-fno-fast-math", "-fsanitize=address"}) {
    const RunResult result = check_flags("CMAKE_CXX_FLAGS", flags);
    INFO(flags << result.err);
    CHECK(result.code == 0);
  }
  CHECK(check_flags("CMAKE_CXX_FLAGS", "-O2 -mavx2", "-mavx2").code == 0);
  CHECK(check_flags("CMAKE_CXX_FLAGS", "-mavx512f", "-mavx2").code == 1);
}

// `waymark view`: the page of a folder, with and without a desktop.
#include <cstdlib>

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "program/support/program.hpp"

namespace {

/// Sets a variable of the environment while it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    const char* before = std::getenv(name);
    if (before != nullptr) before_ = before;
    had_ = before != nullptr;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (had_) {
      ::setenv(name_, before_.c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::string before_;
  bool had_ = false;
};

/// Writes a program "xdg-open" that notes its argument and ends with a code. Returns its folder.
std::string write_opener(const std::string& folder, const std::string& code) {
  const std::string opener = folder + "xdg-open";
  write_text(opener, "#!/bin/sh\nprintf %s \"$1\" > '" + folder + "opened'\nexit " + code + "\n");
  REQUIRE(::chmod(opener.c_str(), 0755) == 0);
  return folder;
}

}  // namespace

TEST_CASE("view: without a desktop it says the path of the report") {
  const Environment no_display("DISPLAY", "");
  const Environment no_wayland("WAYLAND_DISPLAY", "");
  const std::string folder = fresh_folder();
  write_text(folder + "a.html", "<html>");
  write_text(folder + "report.html", "<html>");
  const RunResult result = run({"view", folder});
  CHECK(result.code == 0);
  CHECK(result.out == folder + "report.html\n");
  CHECK(contains(result.err, "open the page in any browser"));
  CHECK(run({"view", folder + "a.html"}).out == folder + "a.html\n");
  CHECK(contains(run({"view", folder, "--json"}).out, "\"opened\": false"));
}

TEST_CASE("view: a desktop gets the absolute path, and what it reports is believed") {
  const std::string folder = fresh_folder();
  const Environment display("DISPLAY", ":99");
  const Environment path("PATH", write_opener(folder, "0") + ":" + std::getenv("PATH"));
  write_text(folder + "comparison.html", "<html>");
  CHECK(contains(run({"view", ".", "--json"}, {.folder = folder}).out, "\"opened\": true"));
  CHECK(read_text(folder + "opened") == folder + "comparison.html");
  write_opener(folder, "3");
  const RunResult failed = run({"view", folder});
  CHECK(failed.code == 0);
  CHECK(failed.out == folder + "comparison.html\n");
  CHECK(contains(failed.err, "open the page in any browser"));
}

TEST_CASE("view: a folder without a page, and what is neither, are bad input") {
  const std::string folder = fresh_folder();
  check_refused(run({"view", folder}), 3, "has no report; 'waymark run DRIVE.yaml --out");
  check_refused(run({"view", folder + "gone"}), 3, "neither a folder of results nor a page");
  check_refused(run({"view", write_text(folder + "a.txt", "")}), 3, "neither a folder of results nor a page");
  CHECK(run({"view"}).code == 2);
}

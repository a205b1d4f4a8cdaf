#include <catch2/catch.hpp>

#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/paths.hpp"

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
namespace fs = std::filesystem;

namespace {

/// An empty folder for one test.
fs::path fresh_folder(const std::string& name) {
  const fs::path folder = waymark_test::scratch_dir() / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("text file: a file comes back as it was written, whatever bytes it holds") {
  const fs::path folder = fresh_folder("round_trip");
  const std::string path = (folder / "a.bin").string();
  std::string content(3'000'000, 'x');
  content[5] = '\0';
  content.back() = '\n';
  for (const std::string& text : {content, std::string(), std::string("short\n")}) {
    write_file_atomically(path, text);
    CHECK(read_text_file(path) == text);
  }
  CHECK(entries(folder) == 1);
}

TEST_CASE("text file: what cannot be read says why") {
  const fs::path folder = fresh_folder("unreadable");
  const std::string missing = (folder / "none.csv").string();
  CHECK_THROWS_MATCHES(read_text_file(missing), InputError,
                       Message(missing + ": cannot read: No such file or directory"));
  CHECK_THROWS_MATCHES(read_text_file(folder.string()), InputError,
                       Message(folder.string() + ": cannot read: Is a directory; name a file in it"));
  const std::string drive = (folder / "drive.yaml").string();
  write_file_atomically(drive, "name: x\n");
  CHECK_THROWS_MATCHES(
      read_text_file(folder.string()), InputError,
      Message(folder.string() + ": cannot read: Is a directory; name the file in it: " + drive));
}

TEST_CASE("text file: what cannot be written says why and leaves nothing") {
  const fs::path folder = fresh_folder("unwritable");
  const std::string nowhere = (folder / "none" / "a.graph").string();
  CHECK_THROWS_MATCHES(write_file_atomically(nowhere, "x"), OutputError,
                       Message(nowhere + ": cannot write: its folder does not exist"));
  CHECK_THROWS_MATCHES(write_file_atomically(folder.string(), "x"), OutputError,
                       Message(folder.string() + ": cannot write: Is a directory"));
  CHECK_THROWS_MATCHES(write_file_atomically("/dev/full", "x"), OutputError,
                       Message("/dev/full: cannot write: No space left on device"));
  CHECK(entries(folder) == 0);
}

TEST_CASE("text file: a file size limit leaves the old file as it was") {
  const fs::path folder = fresh_folder("limit");
  const std::string path = (folder / "a.graph").string();
  write_file_atomically(path, "old");
  const auto previous_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit previous{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &previous) == 0);
  rlimit limited = previous;
  limited.rlim_cur = 4096;
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &limited) == 0);
  std::string message;
  try {
    write_file_atomically(path, std::string(100'000, 'x'));
  } catch (const OutputError& error) {
    message = error.what();
  }
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &previous) == 0);
  std::signal(SIGXFSZ, previous_handler);
  CHECK(message == path + ": cannot write: File too large");
  CHECK(read_text_file(path) == "old");
  CHECK(entries(folder) == 1);
}

TEST_CASE("text file: a text that cannot be finished leaves the old file as it was") {
  // Guards against half a graph if its writing fails or is interrupted between two pieces.
  const fs::path folder = fresh_folder("unfinished");
  const std::string path = (folder / "a.graph").string();
  write_file_atomically(path, "old");
  const auto fail_midway = [&](const TextSink& sink) {
    sink("half");
    throw UsageError("no more");
  };
  CHECK_THROWS_AS(write_file_atomically(path, fail_midway), UsageError);
  CHECK_THROWS_AS(write_file_atomically((folder / "b.graph").string(), fail_midway), UsageError);
  CHECK(read_text_file(path) == "old");
  CHECK(entries(folder) == 1);
  write_file_atomically(path, [](const TextSink& sink) {
    sink("ne");
    sink("w");
  });
  CHECK(read_text_file(path) == "new");
}

TEST_CASE("text file: a symbolic link and the permissions of a file are kept") {
  const fs::path folder = fresh_folder("link");
  const fs::path file = folder / "real.graph";
  const fs::path link = folder / "link.graph";
  write_file_atomically(file.string(), "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real.graph", link);
  write_file_atomically(link.string(), "new");
  CHECK(fs::is_symlink(link));
  CHECK(read_text_file(file.string()) == "new");
  CHECK(fs::status(file).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE(
    "text file: an unfinished file never has more permissions than the final one, and no name in advance") {
  const fs::path folder = fresh_folder("unforeseeable");
  const fs::path file = folder / "secret.graph";
  write_file_atomically(file.string(), "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  std::vector<std::string> names;
  for (int i = 0; i < 2; ++i) {
    write_file_atomically(file.string(), [&](const TextSink&) {
      for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        CHECK(entry.status().permissions() == (fs::perms::owner_read | fs::perms::owner_write));
        if (entry.path() != file) names.push_back(entry.path().filename());
      }
    });
  }
  REQUIRE(names.size() == 2);
  CHECK(names[0] != names[1]);
  CHECK(names[0].starts_with("secret.graph.partial-"));
}

TEST_CASE("text file: a name of the greatest length is written too") {
  const fs::path folder = fresh_folder("long_name");
  const std::string path = (folder / std::string(255, 'n')).string();
  write_file_atomically(path, "x");
  CHECK(read_text_file(path) == "x");
  CHECK(entries(folder) == 1);
}

TEST_CASE("text file: a trial in a folder leaves nothing, and names the folder if it fails") {
  const fs::path folder = fresh_folder("trial");
  try_to_write_in(folder.string());
  CHECK(entries(folder) == 0);
  const std::string nowhere = (folder / "none").string();
  CHECK_THROWS_MATCHES(try_to_write_in(nowhere), OutputError,
                       Message(nowhere + ": cannot write: its folder does not exist"));
}

TEST_CASE("text file: an input that promises more than it can hold is refused before it is in memory") {
  const fs::path file = fresh_folder("sparse") / "a.graph";
  write_file_atomically(file.string(), "");
  fs::resize_file(file, std::uintmax_t{1} << 40U);
  CHECK_THROWS_MATCHES(read_text_file(file.string()), InputError,
                       Message(file.string() + ": is no text: byte 1 is zero"));
  CHECK_THROWS_MATCHES(read_text_file("/dev/zero"), InputError,
                       Message("/dev/zero: is no text: byte 1 is zero"));
}

TEST_CASE("text file: a pipe is written and read directly, in as many parts as it takes") {
  const fs::path pipe = fresh_folder("pipe") / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const std::string content(500'000, 'y');  // more than a pipe holds
  std::string received;
  std::thread reader([&] { received = read_text_file(pipe.string()); });
  write_file_atomically(pipe.string(), content);
  reader.join();
  CHECK(received == content);
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("text file: the standard output is written where it stands, also into a file") {
  const fs::path file = fresh_folder("stdout") / "out.txt";
  const std::string name = GENERATE(as<std::string>(), "-", "/dev/stdout");
  ::fflush(stdout);
  const int kept = ::dup(STDOUT_FILENO);
  const int target = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  REQUIRE(target >= 0);
  ::dup2(target, STDOUT_FILENO);
  write_file_atomically(name, "first\n");
  write_file_atomically(name, "second\n");
  ::dup2(kept, STDOUT_FILENO);
  ::close(kept);
  ::close(target);
  CHECK(read_text_file(file.string()) == "first\nsecond\n");
}

// The arrows of the house: core <- types_se2 <- plugins, core <- solvers, core <- formats, and
// those between the libraries of tools; solvers/linear sees block patterns and numbers, never a
// graph.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "support/paths.hpp"

namespace architecture_test {

namespace {

namespace fs = std::filesystem;
using Rooms = std::set<std::string>;

/// The libraries: room -> rooms that it may include from, beside itself.
const std::map<std::string, Rooms> kArrows = {
    {"core", {}},
    {"types_se2", {"core"}},
    {"solvers", {"core", "types_se2"}},  // its front door knows the starts of the plane
    {"plugins", {"core", "types_se2"}},
    {"formats", {"core"}},
    {"tools/text", {"core", "formats"}},
    {"tools/drawing", {"core", "formats", "tools/text"}},
    {"tools/drive", {"core", "types_se2", "formats"}},
    {"tools/live", {"core", "types_se2", "formats", "tools/drive"}},
    {"tools/evaluation", {"core", "types_se2", "formats", "tools/text"}},
    {"tools/report", {"core", "types_se2", "formats", "tools/text", "tools/drawing", "tools/evaluation"}},
    {"tools/fleet", {"core", "formats", "tools/text", "tools/drawing", "tools/evaluation", "tools/report"}},
    {"tools/benchmark", {"core", "types_se2", "plugins", "formats", "tools/text", "tools/drawing"}},
    {"tools/simulation", {"core", "formats", "tools/text", "tools/drive", "tools/evaluation"}},
    {"tools/inspection", {"core", "formats", "tools/text", "tools/drive"}},
    {"tools/reproduction",
     {"core", "types_se2", "formats", "tools/text", "tools/drawing", "tools/drive", "tools/evaluation",
      "tools/report"}},
};

/// What users run or import sees all rooms. No room includes from it, but for the package of Python: it
/// does the job of the program.
const Rooms kSeeAll = {"tools/program", "tools/python"};

const std::string kVersion = "waymark/version.hpp";  // made by CMake, for everybody

fs::path root() {
  return waymark_test::source_dir();
}

bool is_source(const fs::path& file) {
  return file.extension() == ".hpp" || file.extension() == ".cpp";
}

/// The room of a path below the root: "core", "tools/drive".
std::string room_of(const std::string& path) {
  const auto end = path.find('/', path.starts_with("tools/") ? 6 : 0);
  return path.substr(0, end);
}

/// The paths inside <> or "" of all include lines of a file.
std::vector<std::string> includes(const fs::path& file) {
  std::vector<std::string> found;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("#include ")) continue;
    const auto begin = line.find_first_of("<\"") + 1;
    found.push_back(line.substr(begin, line.find_first_of(">\"", begin) - begin));
  }
  return found;
}

template <typename Visit>
void for_each_source(const std::string& room, Visit visit) {
  for (const auto& entry : fs::recursive_directory_iterator(root() / room)) {
    if (is_source(entry.path())) visit(entry.path());
  }
}

template <typename Visit>
void for_each_include(const std::string& room, Visit visit) {
  for_each_source(room, [&](const fs::path& file) {
    for (const std::string& include : includes(file)) visit(file, include);
  });
}

std::string joined(const Rooms& rooms) {
  std::string text;
  for (const std::string& room : rooms) text += (text.empty() ? "" : ", ") + room;
  return text.empty() ? "no other" : text;
}

/// All arrows, as CONTRIBUTING.md lists them.
std::string table_of_arrows() {
  std::string table = "| Library | Includes from |\n|---|---|\n";
  for (const auto& [room, allowed] : kArrows) table += "| " + room + " | " + joined(allowed) + " |\n";
  for (const std::string& room : kSeeAll) table += "| " + room + " | all |\n";
  return table;
}

std::string without(std::string text, const std::string& word) {
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at))
    text.erase(at, word.size());
  return text;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("house: each library includes only from the libraries that its arrows point to") {
  for (const auto& [room, allowed] : kArrows) {
    for_each_include(
        room, [&, &from = room, &targets = allowed](const fs::path& file, const std::string& include) {
          if (!include.starts_with("waymark/") || include == kVersion) return;
          const std::string target = room_of(include.substr(8));
          INFO(file << " includes " << include << "; " << from << " includes from: " << joined(targets));
          CHECK((target == from || targets.contains(target)));
        });
  }
}

TEST_CASE("house: CONTRIBUTING.md lists the arrows that are tested") {
  INFO("it must hold this table:\n" << table_of_arrows());
  CHECK(text_of(root() / "CONTRIBUTING.md").find("\n\n" + table_of_arrows() + "\n") != std::string::npos);
}

TEST_CASE("house: every library of tools has its arrows, and only what users run sees all of them") {
  for (const auto& entry : fs::directory_iterator(root() / "tools")) {
    const std::string name = "tools/" + entry.path().filename().string();
    if (kSeeAll.contains(name) || !fs::exists(entry.path() / "README.md")) continue;
    bool has_sources = false;
    for_each_source(name, [&](const fs::path&) { has_sources = true; });
    INFO(name);
    CHECK(has_sources == kArrows.contains(name));
  }
}

TEST_CASE("house: the arrows run one way") {
  // A room is reached only by rooms from which it cannot be reached.
  for (const auto& [room, allowed] : kArrows) {
    Rooms reached = allowed;
    for (bool grown = true; grown;) {
      grown = false;
      for (const std::string& next : Rooms(reached)) {
        for (const std::string& further : kArrows.at(next)) grown |= reached.insert(further).second;
      }
    }
    INFO(room);
    CHECK_FALSE(reached.contains(room));
  }
}

TEST_CASE("house: core knows Eigen and the standard library, nothing else") {
  for_each_include("core", [](const fs::path& file, const std::string& include) {
    INFO(file << " includes " << include);
    const bool own = include.starts_with("waymark/core/") || include == kVersion;
    const bool eigen = include.starts_with("Eigen/");
    const bool standard = include.find('/') == std::string::npos && include.find('.') == std::string::npos;
    // Of the C library: the plugin loader, its look into files and its trial in a child process, advice
    // on large arrays.
    static const std::set<std::string> kSystem = {"dlfcn.h",    "elf.h",          "fcntl.h",   "unistd.h",
                                                  "sys/mman.h", "sys/resource.h", "sys/wait.h"};
    const bool system = kSystem.contains(include);
    CHECK((own || eigen || standard || system));
  });
}

TEST_CASE("house: linear backends see no graph") {
  for_each_include("solvers/linear", [&](const fs::path& file, const std::string& include) {
    INFO(file << " includes " << include);
    if (!include.starts_with("waymark/")) return;
    CHECK((include.starts_with("waymark/solvers/linear/") || include.starts_with("waymark/core/linear/") ||
           include.starts_with("waymark/core/base/")));
  });
}

TEST_CASE("house: plugins and examples use public headers only") {
  for (const std::string room : {"plugins", "examples"}) {
    for_each_include(room, [&](const fs::path& file, const std::string& include) {
      INFO(file << " includes " << include);
      const bool foreign_detail =
          include.find("/detail/") != std::string::npos && !include.starts_with("waymark/plugins/");
      CHECK_FALSE(foreign_detail);
    });
  }
}

TEST_CASE("house: each library has a namespace of its own") {
  for (const auto& [room, allowed] : kArrows) {
    std::string expected = "namespace waymark";
    if (room == "formats" || room == "solvers" || room == "plugins") expected += "::" + room;
    if (room.starts_with("tools/")) expected += "::" + room.substr(6);
    for_each_source(room, [&, &of = room](const fs::path& file) {
      const std::string text = without(text_of(file), "WAYMARK_EXPORT ");
      INFO(file);
      if (file.stem() == "optimize" && of == "solvers") return;  // found by the namespace of its graph
      for (auto at = text.find("\nnamespace waymark"); at != std::string::npos;
           at = text.find("\nnamespace waymark", at + 1)) {
        const std::string found = text.substr(at + 1, expected.size());
        const char next = text[at + 1 + expected.size()];
        CHECK(found == expected);
        CHECK((next == ' ' || next == ':' || next == ';'));
      }
    });
  }
}

TEST_CASE("house: libraries neither print nor exit") {
  // Words with the character before them, so that static_assert and snprintf pass.
  const std::vector<std::string> forbidden = {"std::cout", "std::cerr", " printf(",   "std::printf(",
                                              "fprintf(",  "std::exit", "std::abort", " assert("};
  for (const auto& [room, allowed] : kArrows) {
    for_each_source(room, [&](const fs::path& file) {
      const std::string text = text_of(file);
      INFO(file);
      for (const std::string& word : forbidden) {
        INFO(word);
        CHECK(text.find(word) == std::string::npos);
      }
    });
  }
}

TEST_CASE("house: a folder shows at most some twenty names") {
  constexpr std::size_t kMost = 22;
  const std::set<std::string> data = {"tests/formats/cases"};  // pairs of files, listed by CMake
  for (const std::string top :
       {"core", "types_se2", "solvers", "plugins", "formats", "tools", "tests", "examples"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root() / top)) {
      if (!entry.is_directory()) continue;
      const std::string name = fs::relative(entry.path(), root()).string();
      const auto names = std::distance(fs::directory_iterator(entry.path()), fs::directory_iterator());
      INFO(name);
      if (!data.contains(name)) CHECK(static_cast<std::size_t>(names) <= kMost);
    }
  }
}

}  // namespace architecture_test

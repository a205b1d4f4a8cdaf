// The arrows of the house: core <- types_se2 <- plugins, core <- solvers, core <- formats, tools ->
// everything; solvers/linear sees block patterns and numbers, never a graph.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace {

namespace fs = std::filesystem;

/// Room -> rooms it may include from.
const std::map<std::string, std::set<std::string>> kArrows = {
    {"core", {"core"}},
    {"types_se2", {"core", "types_se2"}},
    {"solvers", {"core", "solvers"}},
    {"plugins", {"core", "types_se2", "plugins"}},
    {"formats", {"core", "formats"}},
};

bool is_source(const fs::path& file) {
  return file.extension() == ".hpp" || file.extension() == ".cpp";
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
void for_each_include(const std::string& room, Visit visit) {
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(WAYMARK_SOURCE_DIR) / room)) {
    if (!is_source(entry.path())) continue;
    for (const std::string& include : includes(entry.path())) visit(entry.path(), include);
  }
}

}  // namespace

TEST_CASE("Each room includes only from the rooms its arrows point to") {
  for (const auto& [room, allowed] : kArrows) {
    for_each_include(room, [&, &targets = allowed](const fs::path& file, const std::string& include) {
      if (!include.starts_with("waymark/")) return;
      const std::string target = include.substr(8, include.find('/', 8) - 8);
      INFO(file << " includes " << include);
      CHECK(targets.contains(target));
    });
  }
}

TEST_CASE("Core knows Eigen and the standard library, nothing else") {
  for_each_include("core", [](const fs::path& file, const std::string& include) {
    INFO(file << " includes " << include);
    const bool own = include.starts_with("waymark/core/");
    const bool eigen = include.starts_with("Eigen/");
    const bool standard = include.find('/') == std::string::npos && include.find('.') == std::string::npos;
    // Of the C library: the plugin loader and its look into files, advice on large arrays.
    const bool system = include == "dlfcn.h" || include == "elf.h" || include == "sys/mman.h";
    CHECK((own || eigen || standard || system));
  });
}

TEST_CASE("Linear backends see no graph") {
  const std::set<std::string> allowed = {"waymark/core/linear_solver.hpp", "waymark/core/block_pattern.hpp",
                                         "waymark/core/block_cholesky.hpp"};
  for_each_include("solvers/linear", [&](const fs::path& file, const std::string& include) {
    INFO(file << " includes " << include);
    const bool own = include.starts_with("waymark/solvers/linear/");
    if (include.starts_with("waymark/") && !own) CHECK(allowed.contains(include));
  });
}

TEST_CASE("Libraries neither print nor exit") {
  // Words with what stands before them, so that static_assert and snprintf pass.
  const std::vector<std::string> forbidden = {"std::cout", "std::cerr", " printf(",   "std::printf(",
                                              "fprintf(",  "std::exit", "std::abort", " assert("};
  for (const std::string room : {"core", "types_se2", "solvers", "plugins", "formats"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WAYMARK_SOURCE_DIR) / room)) {
      if (!is_source(entry.path())) continue;
      std::ifstream in(entry.path());
      const std::string text((std::istreambuf_iterator<char>(in)), {});
      INFO(entry.path());
      for (const std::string& word : forbidden) {
        INFO(word);
        CHECK(text.find(word) == std::string::npos);
      }
    }
  }
}

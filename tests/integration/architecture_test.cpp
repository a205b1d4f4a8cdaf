// The arrows of the house: core <- types_se2 <- plugins, core <- solvers, core <- formats, tools ->
// everything; solvers/linear sees block patterns and numbers, never a graph.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

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
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> found;
  std::ifstream in(file);
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, match, kInclude)) found.push_back(match[1]);
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
    const bool loader = include == "dlfcn.h";  // of the C library: the plugin loader
    CHECK((own || eigen || standard || loader));
  });
}

TEST_CASE("Linear backends see no graph") {
  const std::set<std::string> allowed = {"waymark/core/linear_solver.hpp", "waymark/core/block_pattern.hpp",
                                         "waymark/solvers/linear/backends.hpp"};
  for_each_include("solvers/linear", [&](const fs::path& file, const std::string& include) {
    INFO(file << " includes " << include);
    if (include.starts_with("waymark/")) CHECK(allowed.contains(include));
  });
}

TEST_CASE("Libraries neither print nor exit") {
  static const std::regex kForbidden(R"(std::cout|std::cerr|\bprintf\(|std::exit|std::abort|\bassert\()");
  for (const std::string room : {"core", "types_se2", "solvers", "plugins", "formats"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WAYMARK_SOURCE_DIR) / room)) {
      if (!is_source(entry.path())) continue;
      std::ifstream in(entry.path());
      const std::string text((std::istreambuf_iterator<char>(in)), {});
      INFO(entry.path());
      const bool forbidden =
          std::regex_search(text, kForbidden) && text.find("static_assert(") == std::string::npos;
      CHECK_FALSE(forbidden);
    }
  }
}

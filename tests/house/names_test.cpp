// The documentation names files that exist: in `code` of Markdown and in // comments of C++.
//
// A name such as graph.hpp is a file in any folder of the repository. With folders, as in graph/graph.hpp, it is
// the end of a path; includes begin with waymark/. A path that begins with a room, as in tests/formats/cases,
// leads to a file or a folder. NAME stands for any name. Files of other programs are named without ending.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "support/markdown.hpp"
#include "support/paths.hpp"

namespace names_test {

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = waymark_test::source_dir();
const std::vector<std::string> kRooms = {"core",  "types_se2", "solvers", "plugins",
                                         "tools", "formats",   "tests",   "examples"};

/// All files of the repository from its root on, as "/core/graph/graph.hpp".
std::set<std::string> repository_files() {
  std::set<std::string> files;
  const auto take = [&files](const fs::directory_entry& entry) {
    if (entry.is_regular_file())
      files.insert((fs::path("/") / entry.path().lexically_relative(kRoot)).generic_string());
  };
  for (const auto& entry : fs::directory_iterator(kRoot)) take(entry);
  for (const std::string& room : kRooms)
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / room)) take(entry);
  return files;
}

class Names {
 public:
  /// The names of files and paths in a text that lead nowhere, each with a blank behind it.
  [[nodiscard]] std::string dangling(const std::string& text) const {
    static const std::regex file(R"re([\w./-]*\w\.(hpp|cpp|md|py|sh|js|css|cmake)(\.in)?\b)re");
    static const std::regex path(
        R"re((^|[^\w./-])((core|types_se2|solvers|plugins|tools|formats|tests|examples)/[\w./-]*\w))re");
    std::string found;
    const std::sregex_iterator end;
    for (std::sregex_iterator match(text.begin(), text.end(), file); match != end; ++match)
      if (!is_end_of_path(match->str())) found += match->str() + " ";
    for (std::sregex_iterator match(text.begin(), text.end(), path); match != end; ++match)
      if (!is_begin_of_path((*match)[2])) found += (*match)[2].str() + " ";
    return found;
  }

  [[nodiscard]] const std::set<std::string>& files() const { return files_; }

 private:
  [[nodiscard]] bool is_end_of_path(const std::string& name) const {
    if (name.find("NAME") != std::string::npos) return true;  // stands for any name
    std::string end = std::string("/").append(name, name.find_first_not_of("./"));
    if (end.starts_with("/waymark/")) end.erase(0, 8);
    return std::any_of(files_.begin(), files_.end(), [&](const std::string& f) { return f.ends_with(end); });
  }

  [[nodiscard]] bool is_begin_of_path(const std::string& path) const {
    if (path.find("NAME") != std::string::npos) return true;
    const std::string begin = std::string("/").append(path);
    const auto after = files_.lower_bound(begin);
    return after != files_.end() && after->starts_with(begin);
  }

  std::set<std::string> files_ = repository_files();
};

std::string file_text(const std::string& file) {
  std::ifstream in(kRoot / file.substr(1));
  REQUIRE(in);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::vector<std::string> lines_of(const std::string& file) {
  std::istringstream in(file_text(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The `code` of a line, its parts separated by blanks.
std::string code_of(const std::string& line) {
  std::string code;
  for (auto begin = line.find('`'); begin != std::string::npos; begin = line.find('`', begin)) {
    const auto end = line.find('`', begin + 1);
    if (end == std::string::npos) break;
    code += line.substr(begin + 1, end - begin - 1) + " ";
    begin = end + 1;
  }
  return code;
}

/// The text behind "//"; nothing for addresses, "https://".
std::string comment_of(const std::string& line) {
  const auto begin = line.find("//");
  if (begin == std::string::npos || (begin > 0 && line[begin - 1] == ':')) return "";
  return line.substr(begin + 2);
}

void check(const Names& names, const std::string& file, const std::vector<std::string>& lines,
           std::string (*part)(const std::string&)) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string text = part(lines[i]);
    if (text.find('.') == std::string::npos && text.find('/') == std::string::npos) continue;
    const std::string dangling = names.dangling(text);
    INFO(file << ":" << i + 1 << ": does not exist: " << dangling);
    CHECK(dangling.empty());
  }
}

}  // namespace

TEST_CASE("names: a file or folder that Markdown names as code exists") {
  const Names names;
  for (const std::string& file : names.files())
    if (file.ends_with(".md"))
      check(names, file, waymark_test::parse_markdown(file_text(file)).lines, code_of);
}

TEST_CASE("names: a file or folder that a comment names exists") {
  const Names names;
  for (const std::string& file : names.files())
    if (file.ends_with(".hpp") || file.ends_with(".cpp")) check(names, file, lines_of(file), comment_of);
}

TEST_CASE("names: those that lead nowhere are found") {
  const Names names;
  CHECK(names.dangling("see markdown.hpp, support/markdown.hpp, tests/support, tests/house/names_test.cpp")
            .empty());
  CHECK(names.dangling("see sums.md, section 2; house/markdown.hpp; tests/numbers/") ==
        "sums.md house/markdown.hpp tests/numbers ");
  CHECK(code_of("a `b.hpp` and `c d.hpp`") == "b.hpp c d.hpp ");
  CHECK(comment_of("int a = 1;  // of markdown.hpp") == " of markdown.hpp");
  CHECK(comment_of("see(\"https://c.md\");").empty());
}

}  // namespace names_test

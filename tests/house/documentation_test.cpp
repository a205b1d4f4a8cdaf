// The documentation is complete: links have targets, every room describes its content.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "support/markdown.hpp"
#include "support/paths.hpp"

namespace documentation_test {

namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

const fs::path kRoot = waymark_test::source_dir();
/// The folders of the top level; build trees and results may lie beside them.
const std::vector<std::string> kRooms = {"core",  "types_se2", "solvers", "plugins",
                                         "tools", "formats",   "tests",   "examples"};

std::string file_text(const fs::path& file) {
  std::ifstream in(file);
  REQUIRE(in);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::vector<fs::path> markdown_files() {
  std::vector<fs::path> files;
  const auto take = [&files](const fs::path& file) {
    if (file.extension() == ".md") files.push_back(file);
  };
  for (const auto& entry : fs::directory_iterator(kRoot)) take(entry.path());
  for (const std::string& room : kRooms)
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / room)) take(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// A line without its `code`, in which brackets are no links.
std::string without_code(const std::string& line) {
  return std::regex_replace(line, std::regex("`[^`]*`"), "");
}

struct Link {
  std::string target{};
  std::size_t line = 0;
};

/// [text](target), ![text](target), <img src="target">.
std::vector<Link> links_of(const Lines& lines) {
  static const std::regex link(R"re(\]\(([^)\s]+)\)|src="([^"]+)")re");
  std::vector<Link> found;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string line = without_code(lines[i]);
    for (auto match = std::sregex_iterator(line.begin(), line.end(), link); match != std::sregex_iterator();
         ++match)
      found.push_back({(*match)[1].matched ? (*match)[1].str() : (*match)[2].str(), i + 1});
  }
  return found;
}

/// The anchor that GitHub and GitLab make of a heading: lower case, without punctuation, blanks as hyphens.
std::string anchor_of(const std::string& heading) {
  const std::string text = std::regex_replace(heading, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1");
  std::string anchor;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') {
      anchor += '-';
    } else if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80) {
      anchor += static_cast<char>(std::tolower(byte));
    }
  }
  return anchor;
}

std::set<std::string> anchors_of(const fs::path& file) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  for (const std::string& line : waymark_test::parse_markdown(file_text(file)).lines) {
    const auto level = line.find_first_not_of('#');
    if (level == 0 || level == std::string::npos || line[level] != ' ') continue;
    std::string anchor = anchor_of(line.substr(level + 1));
    const int before = seen[anchor]++;
    if (before > 0) anchor.append("-").append(std::to_string(before));
    anchors.insert(anchor);
  }
  return anchors;
}

/// The reason why a link of this file is broken; empty if it is not. Addresses of the web are not tried.
std::string broken(const fs::path& file, const std::string& target) {
  if (target.starts_with("https://") || target.starts_with("http://") || target.starts_with("mailto:"))
    return "";
  const auto hash = target.find('#');
  const std::string path = target.substr(0, hash);
  if (path.starts_with('/')) return "begins with '/', which is another place on every machine";
  const fs::path there = path.empty() ? file : (file.parent_path() / path).lexically_normal();
  if (!fs::exists(there)) return "there is no " + there.string();
  if (hash == std::string::npos) return "";
  if (there.extension() != ".md") return "an anchor, but not into a Markdown file";
  return anchors_of(there).contains(target.substr(hash + 1)) ? "" : "no such heading in " + there.string();
}

bool links_to(const fs::path& file, const fs::path& target) {
  const std::vector<Link> links = links_of(waymark_test::parse_markdown(file_text(file)).lines);
  return std::any_of(links.begin(), links.end(), [&](const Link& link) {
    const std::string path = link.target.substr(0, link.target.find('#'));
    return !path.empty() && (file.parent_path() / path).lexically_normal() == target;
  });
}

}  // namespace

TEST_CASE("documentation: every link between its files leads to a file and a heading that are there") {
  const std::vector<fs::path> files = markdown_files();
  REQUIRE(files.size() > 30);
  for (const fs::path& file : files) {
    for (const Link& link : links_of(waymark_test::parse_markdown(file_text(file)).lines)) {
      INFO(file.string() << ":" << link.line << ": " << link.target << ": " << broken(file, link.target));
      CHECK(broken(file, link.target).empty());
    }
  }
}

TEST_CASE("documentation: fences of listings are closed") {
  for (const fs::path& file : markdown_files()) {
    std::ifstream in(file);
    int fences = 0;
    for (std::string line; std::getline(in, line);) fences += line.starts_with("```") ? 1 : 0;
    INFO(file);
    CHECK(fences % 2 == 0);
  }
}

TEST_CASE(
    "documentation: every room and every folder of tools and plugins has a README that its parent's leads "
    "to") {
  for (const std::string& room : kRooms) {
    INFO(room);
    REQUIRE(fs::exists(kRoot / room / "README.md"));
    CHECK(links_to(kRoot / "README.md", kRoot / room / "README.md"));
  }
  for (const char* room : {"tools", "plugins"}) {
    for (const auto& entry : fs::directory_iterator(kRoot / room)) {
      if (!entry.is_directory()) continue;
      const fs::path readme = entry.path() / "README.md";
      INFO(readme);
      REQUIRE(fs::exists(readme));
      CHECK(links_to(kRoot / room / "README.md", readme));
    }
  }
}

TEST_CASE("documentation: the README of a folder names its chapters") {
  for (const fs::path& file : markdown_files()) {
    if (file.filename() != "README.md" || file.parent_path() == kRoot) continue;
    const std::string readme = file_text(file);
    for (const auto& entry : fs::directory_iterator(file.parent_path())) {
      const std::string chapter = entry.path().filename().string();
      if (!entry.is_directory() || chapter == "detail" || chapter == "__pycache__") continue;
      INFO(file << " does not name " << chapter);
      CHECK(std::regex_search(readme, std::regex("[`/(\\[]" + chapter + "[`/)\\]]")));
    }
  }
}

TEST_CASE("documentation: lines of prose end at 100 characters, the README of the root at 110 lines") {
  for (const fs::path& file : markdown_files()) {
    const Lines lines = waymark_test::parse_markdown(file_text(file)).lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool listing = lines[i].starts_with("    ");
      const bool drawn = lines[i].starts_with('|') || lines[i].starts_with('<') || lines[i].starts_with("![");
      INFO(file << ":" << i + 1);
      CHECK((listing || drawn || lines[i].size() <= 100));
    }
  }
  CHECK(waymark_test::parse_markdown(file_text(kRoot / "README.md")).lines.size() <= 110);
}

TEST_CASE("documentation: the citation has what CFF 1.2.0 requires and the version that is built") {
  const std::string citation = file_text(kRoot / "CITATION.cff");
  for (const char* required : {"cff-version: 1.2.0", "message:", "title:", "authors:"}) {
    INFO(required);
    CHECK(("\n" + citation).find(std::string("\n") + required) != std::string::npos);
  }
  std::smatch built;
  const std::string cmake = file_text(kRoot / "CMakeLists.txt");
  REQUIRE(std::regex_search(cmake, built, std::regex(R"(project\(waymark VERSION ([0-9.]+))")));
  CHECK(citation.find("\nversion: " + built[1].str() + "\n") != std::string::npos);
}

TEST_CASE("documentation: anchors are made as the places make them where the files are read") {
  // Rules: github.com/gjtorikian/html-pipeline, TableOfContentsFilter.
  CHECK(anchor_of("drive.yaml") == "driveyaml");
  CHECK(anchor_of("TORO and GTSAM's covariances") == "toro-and-gtsams-covariances");
  CHECK(anchor_of("The `.graph` format, version 1") == "the-graph-format-version-1");
  CHECK(anchor_of("1. Look at the logs") == "1-look-at-the-logs");
  CHECK(anchor_of("Speed & memory") == "speed--memory");
}

}  // namespace documentation_test

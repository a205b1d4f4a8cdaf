// tools/drive/DRIVE_YAML.md lists the keys of a drive.yaml that the reader has: no key is missing there, and
// the reader refuses none that is there.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/parts/odometry_parts.hpp>

#include "support/markdown.hpp"
#include "support/paths.hpp"

namespace drive_yaml_page_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;

namespace {

std::string file_text(const std::string& path) {
  std::ifstream in(waymark_test::source_dir() + "/" + path);
  REQUIRE(in);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::string drive_yaml_page() {
  return file_text("tools/drive/DRIVE_YAML.md");
}

bool is_word(char c) {
  return std::islower(static_cast<unsigned char>(c)) || std::isdigit(static_cast<unsigned char>(c)) ||
         c == '_';
}

std::set<std::string> words_of(const std::string& text) {
  std::set<std::string> words;
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = std::find_if(at, text.end(), is_word);
    at = std::find_if_not(begin, text.end(), is_word);
    if (begin != at) words.emplace(begin, at);
  }
  return words;
}

/// The string literals of a source that are one word: keys, and the words that values may be.
std::set<std::string> literal_words(const std::string& source) {
  std::set<std::string> words;
  for (auto quote = source.find('"'); quote != std::string::npos; quote = source.find('"', quote)) {
    const auto end = source.find('"', quote + 1);
    const std::string literal = source.substr(quote + 1, end - quote - 1);
    if (!literal.empty() && std::all_of(literal.begin(), literal.end(), is_word)) words.insert(literal);
    quote = end + 1;
  }
  return words;
}

}  // namespace

TEST_CASE("drive.yaml: the reader takes every key of the list on its page") {
  const std::vector<waymark_test::FencedBlock> blocks =
      waymark_test::parse_markdown(drive_yaml_page()).blocks;
  REQUIRE(blocks.size() == 3);
  CHECK_NOTHROW(parse_drive_file(blocks[0].text, "page.yaml", ""));
  CHECK_NOTHROW(parse_drive_file(blocks[1].text, "page.yaml", ""));
  // The third shows another way to give odometry: on its own it lacks the GNSS log.
  CHECK_NOTHROW(parse_drive_file(blocks[2].text + "gnss: {file: gnss.csv}\n", "page.yaml", ""));
}

TEST_CASE("drive.yaml: its page names every key and word that the reader knows") {
  const std::set<std::string> named = words_of(drive_yaml_page());
  std::set<std::string> known;
  for (const char* source :
       {"tools/drive/description/drive_file.cpp", "tools/drive/description/description_yaml.cpp",
        "tools/drive/description/settings_yaml.cpp", "tools/drive/description/log_config.cpp",
        "tools/drive/description/source_entries.cpp"})
    known.merge(literal_words(file_text(source)));
  known.insert(kSpeedSources.begin(), kSpeedSources.end());
  known.insert(kYawRateSources.begin(), kYawRateSources.end());
  REQUIRE(known.size() > 70);
  known.erase("true");  // YAML's own words for on and off
  known.erase("false");
  for (const std::string& word : known) {
    INFO("tools/drive/DRIVE_YAML.md lacks '" << word << "'");
    CHECK(named.contains(word));
  }
}

TEST_CASE("drive.yaml: every key that a message tells the user to state or to check exists") {
  const std::set<std::string> named = words_of(drive_yaml_page());
  // Long messages are several literals; a key in them is quoted, with what may stand behind it.
  const std::regex broken("\"\\s*\n\\s*\"");
  const std::regex advice("(state|stated|check|leave out|under|widen|map) '([a-z_]+)");
  std::size_t keys = 0;
  for (const char* folder : {"formats/logs", "tools/drive", "tools/inspection", "tools/program/jobs"}) {
    for (const auto& file :
         std::filesystem::recursive_directory_iterator(waymark_test::source_dir() + "/" + folder)) {
      if (file.path().extension() != ".cpp") continue;
      std::ifstream in(file.path());
      const std::string source =
          std::regex_replace(std::string(std::istreambuf_iterator<char>(in), {}), broken, "");
      for (std::sregex_iterator match(source.begin(), source.end(), advice), end; match != end; ++match) {
        INFO(file.path() << ": " << match->str());
        CHECK(named.contains((*match)[2]));
        ++keys;
      }
    }
  }
  CHECK(keys > 20);
}

TEST_CASE(
    "drive.yaml: the README of the logs names every quantity, unit and convention that columns may state") {
  const std::string readme = file_text("formats/logs/README.md");
  const auto named = [&readme](std::string_view word) {
    INFO("formats/logs/README.md lacks '" << word << "'");
    CHECK(readme.find(word) != std::string::npos);
  };
  LogRequest channels;
  channels.stream = StreamKind::odometry;
  channels.readings = odometry_channels();
  std::vector<LogRequest> requests = {channels};
  for (const StreamKind stream : {StreamKind::odometry, StreamKind::gnss, StreamKind::truth}) {
    requests.emplace_back();
    requests.back().stream = stream;
  }
  for (const LogRequest& request : requests) {
    for (const Quantity& quantity : table_quantities(request)) {
      std::string word(1, '`');  // piece by piece: g++ 12 warns of an overflow that is none
      word += quantity.name;
      named(word += '`');
      for (const Unit& unit : quantity.units) named(unit.name);
      for (const Convention& convention : quantity.conventions) named(convention.name);
    }
  }
}

}  // namespace drive_yaml_page_test

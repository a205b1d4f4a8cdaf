// Pages for newcomers are followed to the letter: their commands run in order in a fresh folder, end with the
// exit code they state, and print the output they show.
//
// A block "sh" is run, with "exit=N" it must end so, with "data=DRIVE" it needs the logs of that drive; a block
// with a file's name is that file, but a block "cpp" is a part of the file of that name beside the page, which
// is compiled; a block "text" is what the "sh" above it printed: each of its lines must be among the lines
// printed, "..." stands for anything, numbers may differ by 5 % (other compilers).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <sstream>

#include <catch2/catch.hpp>

#include "program/support/program.hpp"
#include "support/markdown.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace tutorial_test {

namespace {

namespace fs = std::filesystem;
using Words = std::span<const std::string>;
using waymark_test::FencedBlock;

constexpr const char* kTutorial = "examples/tutorial/README.md";
constexpr const char* kFromG2o = "examples/programs/FROM_G2O.md";

std::vector<FencedBlock> blocks_of(const std::string& page) {
  return waymark_test::parse_markdown(read_text(waymark_test::source_dir() + "/" + page)).blocks;
}

/// Of "NAME=VALUE" behind the fence.
std::string attribute(const FencedBlock& block, const std::string& name) {
  for (const std::string& word : block.words)
    if (word.starts_with(name + "=")) return word.substr(name.size() + 1);
  return "";
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::optional<double> as_number(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// One step of a word's last digit, the uncertainty of rounding. 0 for words without decimals.
double last_digit(const std::string& word) {
  const auto point = word.find('.');
  if (point == std::string::npos || word.find_first_of("eE") != std::string::npos) return 0;
  return std::pow(10, -static_cast<double>(word.size() - point - 1));
}

bool same_word(const std::string& shown, const std::string& printed) {
  if (shown == printed) return true;
  if (shown.starts_with("...")) return printed.ends_with(shown.substr(3));
  const auto a = as_number(shown);
  const auto b = as_number(printed);
  if (!a || !b || shown.find('.') == std::string::npos) return false;  // counts are exact
  return std::abs(*a - *b) <= 0.05 * std::abs(*a) + last_digit(shown);
}

bool same_line(Words shown, Words printed) {
  if (shown.empty()) return printed.empty();
  if (shown.front() == "...")
    return same_line(shown.subspan(1), printed) || (!printed.empty() && same_line(shown, printed.subspan(1)));
  return !printed.empty() && same_word(shown.front(), printed.front()) &&
         same_line(shown.subspan(1), printed.subspan(1));
}

/// The lines shown that were not printed.
std::string missing_lines(const std::string& shown, const std::string& printed) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream in(printed);
  for (std::string line; std::getline(in, line);) lines.push_back(words_of(line));
  std::string missing;
  std::istringstream wanted(shown);
  for (std::string line; std::getline(wanted, line);) {
    const std::vector<std::string> words = words_of(line);
    if (std::none_of(lines.begin(), lines.end(), [&](const auto& l) { return same_line(words, l); }))
      missing += line + "\n";
  }
  return missing;
}

/// A place where a page is followed: `examples` and the program are where a clone has them.
class Reader {
 public:
  explicit Reader(std::string page) : page_(std::move(page)) {
    fs::create_symlink(waymark_test::source_dir() + "/examples", root_ + "examples");
    fs::create_directories(root_ + "build/release");
    fs::create_directory_symlink(fs::path(waymark_test::program_path()).parent_path(),
                                 root_ + "build/release/bin");
  }

  void follow(const FencedBlock& block) {
    INFO(page_ << ":" << block.line);
    if (block.language == "sh") {
      run_block(block);
    } else if (block.language == "text") {
      INFO("shown, but not printed by the commands above:\n" << missing_lines(block.text, printed_));
      INFO("printed:\n" << printed_);
      CHECK(missing_lines(block.text, printed_).empty());
    } else if (block.language == "cpp") {
      REQUIRE(block.words.size() == 1);
      const fs::path beside = fs::path(waymark_test::source_dir()) / page_;
      CHECK(read_text((beside.parent_path() / block.words.front()).string()).find(block.text) !=
            std::string::npos);
    } else {
      REQUIRE(block.words.size() == 1);
      write_text(folder_ + "/" + block.words.front(), block.text);
    }
  }

 private:
  /// Each block in a shell of its own, which goes on where the last one was.
  void run_block(const FencedBlock& block) {
    const std::string where = root_ + "where";
    const std::string script = "export PATH='" + root_ + "build/release/bin':\"$PATH\" AARHUS='" +
                               (waymark_test::shared_data_dir() / "drives/aarhus_horsens").string() +
                               "'\ntrap 'pwd > \"" + where + "\"' EXIT\nset -e\n" + block.text;
    const RunResult result = run({"-c", script}, {.folder = folder_, .program = "/bin/bash"});
    printed_ = result.out + "\n" + result.err;
    const std::string expected = attribute(block, "exit");
    INFO(printed_);
    CHECK(result.code == (expected.empty() ? 0 : std::stoi(expected)));
    folder_ = read_text(where);
    folder_.erase(folder_.find_last_not_of('\n') + 1);
  }

  std::string page_;
  std::string root_ = fresh_folder();
  std::string folder_ = root_;
  std::string printed_;
};

/// The commands that need the logs of this drive ("": those that need none), with their further blocks.
std::vector<FencedBlock> part_of_tutorial(const std::string& data) {
  std::vector<FencedBlock> part;
  bool takes = data.empty();
  for (const FencedBlock& block : blocks_of(kTutorial)) {
    if (block.language == "sh") takes = attribute(block, "data") == data;
    if (takes) part.push_back(block);
  }
  return part;
}

}  // namespace

TEST_CASE("tutorial: what it shows of the bundled drive is what its commands print") {
  Reader reader(kTutorial);
  const std::vector<FencedBlock> part = part_of_tutorial("");
  REQUIRE(part.size() >= 20);
  for (const FencedBlock& block : part) reader.follow(block);
}

TEST_CASE("tutorial: what it shows of the raw logs of Aarhus is what its commands print") {
  if (!waymark_test::shared_data("drives/aarhus_horsens")) return;
  Reader reader(kTutorial);
  const std::vector<FencedBlock> part = part_of_tutorial("aarhus_horsens");
  REQUIRE_FALSE(part.empty());
  for (const FencedBlock& block : part) reader.follow(block);
}

TEST_CASE("tutorial: a user of g2o is led through commands that run and code that is compiled") {
  Reader reader(kFromG2o);
  const std::vector<FencedBlock> blocks = blocks_of(kFromG2o);
  REQUIRE(blocks.size() >= 6);
  for (const FencedBlock& block : blocks) reader.follow(block);
}

TEST_CASE("tutorial: a line that was not printed is missed, whatever stands around it") {
  // The check itself: else a tutorial of nothing but "..." would pass.
  const std::string printed =
      "g1   converged in 4 iterations, 0.010 s, chi2 7468.9 -> 538.3\nRMSE  2.208 m\n";
  CHECK(missing_lines("g1 converged in 4 iterations, ...\nRMSE 2.208 m\n", printed).empty());
  CHECK(missing_lines("RMSE 2.21 m\n", printed).empty());
  CHECK(missing_lines("RMSE 2.35 m\n", printed) == "RMSE 2.35 m\n");
  CHECK(missing_lines("g1 converged in 5 iterations, ...\n", printed) ==
        "g1 converged in 5 iterations, ...\n");
  CHECK(missing_lines("... converged\n", printed) == "... converged\n");
  CHECK(missing_lines("RMSE 2.208\n", printed) == "RMSE 2.208\n");
}

}  // namespace tutorial_test

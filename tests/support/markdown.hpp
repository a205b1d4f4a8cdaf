/// Reads documentation for tests. Fenced blocks are compared with the commands, listings and files
/// that run; the text outside of them is read too.
#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace waymark_test {

/// "```LANGUAGE WORDS" ... "```"
struct FencedBlock {
  std::string language{};            ///< first word after the fence; may be empty
  std::vector<std::string> words{};  ///< the other words, for example the name of a file
  std::string text{};                ///< the lines between the fences, each with "\n"
  int line = 0;                      ///< line of the opening fence, from 1
};

struct Markdown {
  std::vector<FencedBlock> blocks{};
  /// lines outside of blocks; lines inside are empty, so numbers are those of the file
  std::vector<std::string> lines{};
};

[[nodiscard]] inline Markdown parse_markdown(std::string_view text) {
  Markdown result;
  std::istringstream in{std::string(text)};
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const bool fence = line.starts_with("```");
    if (fence && !inside) {
      FencedBlock block{.line = number};
      std::istringstream info(line.substr(3));
      info >> block.language;
      for (std::string word; info >> word;) block.words.push_back(word);
      result.blocks.push_back(std::move(block));
    } else if (inside && !fence) {
      result.blocks.back().text += line + "\n";
    }
    result.lines.push_back(inside || fence ? std::string() : line);
    if (fence) inside = !inside;
  }
  return result;
}

}  // namespace waymark_test

#include "program/support/help.hpp"

#include <algorithm>
#include <sstream>

#include <catch2/catch.hpp>

#include "program/support/program.hpp"

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> words_of(const std::string& line) {
  std::string spaced = line;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream in(spaced);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> subcommands() {
  std::vector<std::string> names;
  bool inside = false;
  for (const std::string& line : lines_of(run({"--help"}).out)) {
    if (line == "Subcommands:") {
      inside = true;
    } else if (line.empty()) {
      inside = false;
    } else if (inside) {
      names.push_back(words_of(line).front());
    }
  }
  REQUIRE(names.size() > 10);
  return names;
}

#include <waymark/core/base/suggest.hpp>

#include <algorithm>
#include <vector>

namespace waymark {
namespace {

char small(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

struct Nearest {
  std::string_view word;  // empty: none is near
  bool alone = true;      // no other candidate is as near
};

Nearest nearest_of(std::string_view word, std::span<const std::string_view> candidates) {
  Nearest nearest;
  std::size_t smallest = word.size() + 1;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    const std::size_t tolerated = std::max<std::size_t>(1, candidate.size() / 3);
    if (distance > tolerated || distance > smallest) continue;
    if (distance == smallest && !nearest.word.empty()) {
      nearest.alone = false;
    } else if (distance < smallest) {
      nearest = {candidate, true};
      smallest = distance;
    }
  }
  return nearest;
}

std::string question(std::string_view word) {
  std::string text = "; did you mean '";
  text += word;
  text += "'?";
  return text;
}

template <typename Word>
std::string joined_words(std::span<const Word> words) {
  std::string text;
  for (const Word& word : words) {
    if (!text.empty()) text += ", ";
    text += word;
  }
  return text;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table suffice, because a swap looks two rows back.
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = small(a[i - 1]) == small(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0U : 1U)});
      const bool swapped =
          i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const Nearest nearest = nearest_of(word, candidates);
  return nearest.word.empty() ? std::string() : question(nearest.word);
}

std::string suggestion(std::string_view word, std::span<const std::string_view> candidates) {
  const Nearest nearest = nearest_of(word, candidates);
  if (!nearest.word.empty() && nearest.alone) return question(nearest.word);
  return "; there are: " + joined(candidates);
}

std::string joined(std::span<const std::string_view> words) {
  return joined_words(words);
}

std::string joined(std::span<const std::string> words) {
  return joined_words(words);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = small(c);
  return result;
}

}  // namespace waymark

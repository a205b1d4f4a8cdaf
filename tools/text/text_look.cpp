#include <waymark/tools/text/text_look.hpp>

#include <algorithm>
#include <utility>

namespace waymark::text {
namespace {

std::string_view code_of(Tone tone) {
  switch (tone) {
    case Tone::heading:
      return "1";
    case Tone::dim:
      return "2";
    case Tone::better:
      return "32";
    case Tone::worse:
      return "31";
    case Tone::warning:
      return "33";
    case Tone::error:
      return "1;31";
  }
  return "0";
}

/// Returns the bytes of the character that begins here; 1 if it is no UTF-8.
std::size_t character_size(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text.front());
  const std::size_t size = byte >= 0xf0 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc0 ? 2 : 1;
  if (size > text.size()) return 1;
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; };
  return std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(size), continues) ? size
                                                                                                    : 1;
}

std::size_t character_width(std::string_view character) {
  // U+1100 is e1 84 80.
  return character >= "\xe1\x84\x80" && character.size() >= 3 ? 2 : 1;
}

bool steers_terminals(std::string_view character) {
  const auto byte = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return byte < 0x20 || byte == 0x7f || byte >= 0x80;
  return byte == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;  // C1: U+0080 to U+009F
}

/// Returns the size of a sequence of painted() with which the text begins; 0: none.
std::size_t colour_size(std::string_view text) {
  for (const std::string_view colour :
       {"\033[0m", "\033[1m", "\033[2m", "\033[32m", "\033[31m", "\033[33m", "\033[1;31m"})
    if (text.starts_with(colour)) return colour.size();
  return 0;
}

/// Returns the word, or its beginning with "..." and its end; both end with whole characters.
std::pair<std::string, std::string_view> shown_word(std::string_view word, std::size_t longest) {
  if (word.size() <= longest) return {std::string(word), {}};
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(word[at]) & 0xc0U) == 0x80;
  };
  std::size_t first = longest / 2;
  while (first > 0 && continues(first)) --first;
  std::size_t last = word.size() - (longest - longest / 2 - 3);
  while (last < word.size() && continues(last)) ++last;
  return {std::string(word.substr(0, first)) + "...", word.substr(last)};
}

template <typename Take>
void for_characters(std::string_view text, const Take& take) {
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view character = text.substr(at, character_size(text.substr(at)));
    take(character);
    at += character.size();
  }
}

}  // namespace

std::string painted(std::string_view text, Tone tone, const TextLook& look) {
  if (!look.colours || text.empty()) return std::string(text);
  std::string result = "\033[";
  result += code_of(tone);
  result += 'm';
  result += text;
  result += "\033[0m";
  return result;
}

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  for_characters(text, [&](std::string_view character) { width += character_width(character); });
  return width;
}

std::string fitted(std::string_view text, std::size_t columns) {
  constexpr std::string_view kCut = "...";
  std::string whole;
  std::string start;  // as much as fits before "..."
  std::size_t width = 0;
  const std::size_t room = columns > kCut.size() ? columns - kCut.size() : 0;
  for_characters(text, [&](std::string_view character) {
    whole += steers_terminals(character) ? "?" : character;
    width += character_width(character);
    if (width <= room) start = whole;
  });
  if (width <= columns) return whole;
  return columns < kCut.size() ? std::string(columns, '.') : start.append(kCut);
}

std::string without_controls(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::string_view part = text.substr(0, std::max(character_size(text), colour_size(text)));
    text.remove_prefix(part.size());
    if (part.front() == '\n' || part.front() == '\t' || part.starts_with("\033[") ||
        !steers_terminals(part)) {
      out += part;
      continue;
    }
    for (const char c : part) {
      const auto byte = static_cast<unsigned char>(c);
      out += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return out;
}

std::string shown_message(std::string_view text, std::size_t longest) {
  const std::string safe = without_controls(text);
  std::string out;
  for (std::size_t at = 0; at < safe.size();) {
    const std::size_t end = std::min(safe.find_first_of(" \n\t", at), safe.size());
    const std::string_view word(safe.data() + at, end - at);
    const auto cut = shown_word(word, longest);
    out.append(cut.first).append(cut.second);
    if (end < safe.size()) out += safe[end];
    at = end + 1;
  }
  return out;
}

std::string indented(std::string_view lines, std::size_t spaces) {
  std::string out;
  while (!lines.empty()) {
    const std::size_t size = std::min(lines.find('\n'), lines.size() - 1) + 1;
    if (lines.front() != '\n') out.append(spaces, ' ');
    out.append(lines.substr(0, size));
    lines.remove_prefix(size);
  }
  return out;
}

}  // namespace waymark::text

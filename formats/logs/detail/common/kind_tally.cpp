#include <waymark/formats/logs/detail/common/kind_tally.hpp>

#include <algorithm>
#include <cstring>

#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

void KindTally::add(std::string_view name) {
  constexpr std::size_t kMostKinds = 128;  // half of the table, so that a search ends soon
  Key key{};
  name.copy(reinterpret_cast<char*>(key.data()), sizeof key);
  // The top byte of a multiplicative hash. Each word has its own odd factor, so their order counts.
  std::size_t place =
      (key[0] * 0x9E3779B97F4A7C15U + key[1] * 0xC2B2AE3D27D4EB4FU + key[2] * 0x165667B19E3779F9U) >> 56U;
  while (entries_[place].count > 0 && entries_[place].key != key) place = (place + 1) % entries_.size();
  Entry& entry = entries_[place];
  if (entry.count == 0) {
    if (used_ == kMostKinds) {
      ++others_;
      return;
    }
    ++used_;
    entry.key = key;
  }
  ++entry.count;
}

std::map<std::string, std::size_t> KindTally::counts() const {
  std::map<std::string, std::size_t> result;
  for (const Entry& entry : entries_) {
    if (entry.count == 0) continue;
    std::array<char, sizeof entry.key> letters{};
    std::memcpy(letters.data(), entry.key.data(), letters.size());
    result[shown_name({letters.data(), std::find(letters.begin(), letters.end(), '\0')})] += entry.count;
  }
  if (others_ > 0) result["others"] += others_;
  return result;
}

}  // namespace waymark::formats

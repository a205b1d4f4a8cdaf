#include <waymark/formats/logs/kind_tally.hpp>

#include <algorithm>
#include <cstring>

namespace waymark {

void KindTally::add(std::string_view name) {
  constexpr std::size_t kMostKinds = 128;  // half of the table: a search ends soon
  std::uint64_t key = 0;
  std::memcpy(&key, name.data(), std::min(name.size(), sizeof key));
  std::size_t place = (key * 0x9E3779B97F4A7C15U) >> 56U;  // the top byte of a multiplicative hash
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

void KindTally::write(std::map<std::string, std::size_t>& kinds) const {
  for (const Entry& entry : entries_) {
    if (entry.count == 0) continue;
    std::array<char, sizeof entry.key> letters{};
    std::memcpy(letters.data(), &entry.key, letters.size());
    kinds[std::string(letters.begin(), std::find(letters.begin(), letters.end(), '\0'))] += entry.count;
  }
  if (others_ > 0) kinds["others"] += others_;
}

}  // namespace waymark

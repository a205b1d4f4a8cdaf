/// How many messages of each kind a log holds.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace waymark {

/// Counts by name, without an allocation for a name that is known. A log of garbage has endless names: after
/// the first 64, new ones count as "other".
class KindCounter {
 public:
  void count(std::string_view name) {
    for (auto& [known, number] : counts_) {
      if (known == name) {
        ++number;
        return;
      }
    }
    if (counts_.size() < kMost) {
      counts_.emplace_back(name, 1);
    } else {
      ++others_;
    }
  }
  [[nodiscard]] std::map<std::string, std::size_t> counts() const {
    std::map<std::string, std::size_t> result(counts_.begin(), counts_.end());
    if (others_ > 0) result["other"] += others_;
    return result;
  }

 private:
  static constexpr std::size_t kMost = 64;
  std::vector<std::pair<std::string, std::size_t>> counts_;
  std::size_t others_ = 0;
};

}  // namespace waymark

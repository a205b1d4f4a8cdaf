/// Counts messages by kind where they come by the million.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace waymark {

/// Counts names of at most eight characters (of longer ones the first eight) in a small table: neither a map
/// nor an allocation in the hot path, and no growth with a hostile log: beyond 128 names they are "others".
class KindTally {
 public:
  void add(std::string_view name);
  /// Adds the counts to LogData::kinds.
  void write(std::map<std::string, std::size_t>& kinds) const;

 private:
  struct Entry {
    std::uint64_t key = 0;
    std::size_t count = 0;
  };
  std::array<Entry, 256> entries_{};
  std::size_t used_ = 0;
  std::size_t others_ = 0;
};

}  // namespace waymark

/// Counts the messages of each kind in a log. There may be millions of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Counts names in a small table, without a map or an allocation in the hot path. Names are
/// distinguished by their first 24 characters; NMEA, gpsd and NovAtel need fewer. A log of garbage
/// has endless names, so all names after the first 128 count as "others".
class KindTally {
 public:
  void add(std::string_view name);
  /// Returns the counts in the form of LogData::kinds.
  [[nodiscard]] std::map<std::string, std::size_t> counts() const;

 private:
  static constexpr std::size_t kWords = 3;
  using Key = std::array<std::uint64_t, kWords>;  ///< the characters of the name, then zeros
  struct Entry {
    Key key{};
    std::size_t count = 0;
  };
  std::array<Entry, 256> entries_{};
  std::size_t used_ = 0;
  std::size_t others_ = 0;
};

}  // namespace waymark::formats

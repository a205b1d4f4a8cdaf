/// How many messages of each kind a log holds, counted where they come by the million.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Counts names in a small table: neither a map nor an allocation in the hot path. Names are told apart by
/// their first 24 characters, which are more than NMEA, gpsd and NovAtel need. A log of garbage has endless
/// names: beyond the first 128 they count as "others".
class KindTally {
 public:
  void add(std::string_view name);
  /// As LogData::kinds has them.
  [[nodiscard]] std::map<std::string, std::size_t> counts() const;

 private:
  static constexpr std::size_t kWords = 3;
  using Key = std::array<std::uint64_t, kWords>;  ///< the name's characters, then zeros
  struct Entry {
    Key key{};
    std::size_t count = 0;
  };
  std::array<Entry, 256> entries_{};
  std::size_t used_ = 0;
  std::size_t others_ = 0;
};

}  // namespace waymark::formats

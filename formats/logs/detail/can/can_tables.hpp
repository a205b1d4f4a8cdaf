/// Look-up tables that the candump reader uses for every line.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

/// At most this many interfaces are distinguished, by names of at most this many characters
/// (Linux allows 15).
inline constexpr std::size_t kMostInterfaces = 16;
inline constexpr std::size_t kLongestInterface = 31;

/// Maps the id of a frame to the indices of its messages in the DBC. Several DBC files may define one id.
class MessageTable {
 public:
  static constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();

  explicit MessageTable(const Dbc& dbc) : next_(dbc.messages.size(), kUnknown) {
    standard_.fill(kUnknown);
    // Backwards, so that the first definition of an id is found first.
    for (std::size_t i = dbc.messages.size(); i-- > 0;) {
      const DbcMessage& message = dbc.messages[i];
      const auto index = static_cast<std::uint32_t>(i);
      if (message.id < standard_.size()) {
        next_[i] = standard_[message.id];
        standard_[message.id] = index;
        continue;
      }
      std::uint32_t& entry = (message.is_group ? groups_.try_emplace(parameter_group(message.id), kUnknown)
                                               : extended_.try_emplace(message.id, kUnknown))
                                 .first->second;
      next_[i] = entry;
      entry = index;
    }
  }
  /// Returns the first message of an id; kUnknown: none. A message of a J1939 parameter group comes
  /// from any sender, with any priority.
  [[nodiscard]] std::uint32_t find(std::uint32_t id) const {
    if (id < standard_.size()) return standard_[id];
    const auto exact = extended_.find(id);
    if (exact != extended_.end()) return exact->second;
    const auto group = groups_.find(parameter_group(id));
    return group != groups_.end() && (id & kExtendedFrame) != 0 ? group->second : kUnknown;
  }
  /// Returns the next message of the same id.
  [[nodiscard]] std::uint32_t next(std::uint32_t message) const { return next_[message]; }

 private:
  std::array<std::uint32_t, 2048> standard_{};
  std::unordered_map<std::uint32_t, std::uint32_t> extended_, groups_;
  std::vector<std::uint32_t> next_;  ///< by message
};

/// The interfaces of a log and the number of frames from each.
class Interfaces {
 public:
  /// Counts a frame and returns the index of its interface; kMostInterfaces for those
  /// beyond the table.
  std::size_t count(std::string_view name) {
    if (last_ >= used_ || names_[last_] != name) last_ = find(name);
    ++counts_[last_];
    return last_;
  }
  [[nodiscard]] std::string name(std::size_t index) const {
    return index < used_ ? shown_name(names_[index]) : std::string("other interfaces");
  }
  [[nodiscard]] std::string summary(const std::array<std::size_t, kMostInterfaces + 1>& counts) const {
    std::string text;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] > 0)
        text += fmt::format("{}{} ({} frames)", text.empty() ? "" : ", ", name(i), counts[i]);
    }
    return text;
  }
  [[nodiscard]] std::string summary() const { return summary(counts_); }

 private:
  std::size_t find(std::string_view name) {
    for (std::size_t i = 0; i < used_; ++i) {
      if (names_[i] == name) return i;
    }
    if (used_ == kMostInterfaces || name.size() > kLongestInterface) return kMostInterfaces;
    names_[used_] = name;
    return used_++;
  }

  std::array<std::string, kMostInterfaces> names_;
  std::array<std::size_t, kMostInterfaces + 1> counts_{};
  std::size_t used_ = 0;
  std::size_t last_ = kMostInterfaces;
};

}  // namespace waymark::formats

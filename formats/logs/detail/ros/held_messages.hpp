/// Messages of a chunk that wait until its checksum or its compression is known to be right.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace waymark::formats {

struct HeldMessage {
  std::uint32_t channel = 0;
  std::int64_t log_time = 0;  ///< Unix nanoseconds
  std::string bytes;
};

/// Holds at most 8 MiB, several times the chunk of a usual recorder. What is more is given before that.
class HeldMessages {
 public:
  void add(HeldMessage message) {
    size_ += message.bytes.size() + sizeof message;
    messages_.push_back(std::move(message));
  }
  [[nodiscard]] bool full() const { return size_ > (8U << 20U); }
  [[nodiscard]] std::vector<HeldMessage> take() {
    size_ = 0;
    return std::exchange(messages_, {});
  }

 private:
  std::vector<HeldMessage> messages_;
  std::size_t size_ = 0;
};

}  // namespace waymark::formats

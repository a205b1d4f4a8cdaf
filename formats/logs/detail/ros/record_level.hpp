/// Splits bytes into records that come in pieces: at the top level of a file, and within its chunks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace waymark::formats {

/// The step of a record that has been read so far.
struct RecordStep {
  enum class Then {
    collect,  ///< call again with `size` bytes of the record in all
    skip,     ///< pass over the next `size` bytes; the record then ends
    stream,   ///< give the next `size` bytes piece by piece to take_content; the record then ends
    stop      ///< nothing behind this can be read
  };
  Then then = Then::skip;
  std::uint64_t size = 0;
};

/// The records of one level. A record is collected only as far as `Owner::begin` asks, so memory is bounded by
/// what it asks for. Owner has
/// - `RecordStep begin(Level&, std::string_view collected)`: called with the first bytes of a record
/// - `void take_content(Level&, std::string_view)` and `void end_content(Level&)`: for `stream`
/// - `void passed(Level&, std::string_view)`: all bytes in their order, once their record has begun
template <typename Owner>
class RecordLevel {
 public:
  /// @param first how many bytes every record has at least
  RecordLevel(Owner& owner, std::size_t first) : owner_(&owner), first_(first), wanted_(first) {}

  void take(std::string_view bytes) {
    while (!bytes.empty() && !stopped_) {
      if (rest_ > 0) {
        pass(bytes);
        continue;
      }
      if (collected_.empty()) place_ = done_;
      const std::size_t part =
          static_cast<std::size_t>(std::min<std::uint64_t>(wanted_ - collected_.size(), bytes.size()));
      collected_ += bytes.substr(0, part);
      done_ += part;
      bytes.remove_prefix(part);
      while (!stopped_ && rest_ == 0 && !collected_.empty() && collected_.size() == wanted_) step();
    }
  }
  /// Where the current record begins, in the bytes of this level.
  [[nodiscard]] std::uint64_t place() const { return place_; }
  /// Tells whether a record has begun and not ended.
  [[nodiscard]] bool within() const { return !stopped_ && (rest_ > 0 || !collected_.empty()); }

 private:
  void step() {
    const RecordStep next = owner_->begin(*this, collected_);
    if (next.then == RecordStep::Then::stop) {
      stopped_ = true;
      return;
    }
    if (next.then == RecordStep::Then::collect) {
      wanted_ = next.size;
      return;
    }
    streaming_ = next.then == RecordStep::Then::stream;
    rest_ = next.size;
    owner_->passed(*this, collected_);
    collected_.clear();
    wanted_ = first_;
    if (rest_ == 0 && streaming_) owner_->end_content(*this);
  }
  void pass(std::string_view& bytes) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(rest_, bytes.size()));
    owner_->passed(*this, bytes.substr(0, part));
    if (streaming_) owner_->take_content(*this, bytes.substr(0, part));
    rest_ -= part;
    done_ += part;
    bytes.remove_prefix(part);
    if (rest_ == 0 && streaming_) owner_->end_content(*this);
  }

  Owner* owner_;
  std::size_t first_;
  std::uint64_t wanted_;
  std::string collected_;
  std::uint64_t rest_ = 0;  ///< of a record that is skipped or streamed
  std::uint64_t done_ = 0;
  std::uint64_t place_ = 0;
  bool streaming_ = false;
  bool stopped_ = false;
};

}  // namespace waymark::formats

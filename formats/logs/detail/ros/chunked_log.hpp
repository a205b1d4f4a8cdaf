/// What MCAP files and bags have in common: a magic, then records, some of which are chunks of further records.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <waymark/formats/logs/detail/ros/chunk_content.hpp>
#include <waymark/formats/logs/detail/ros/held_messages.hpp>
#include <waymark/formats/logs/detail/ros/record_level.hpp>
#include <waymark/formats/logs/detail/ros/ros_log.hpp>

namespace waymark::formats {

/// The base of Decoder, which has `begin_record` and `pass_record` for `begin` and `passed` of RecordLevel.
template <typename Decoder>
class ChunkedLogDecoder : public RosLogDecoder {
 public:
  using Level =
      RecordLevel<ChunkedLogDecoder>;  // not of Decoder, which is no object yet while a base is made

  RecordStep begin(Level& level, std::string_view collected) {
    return decoder().begin_record(level, collected);
  }
  void passed(Level& level, std::string_view bytes) { decoder().pass_record(level, bytes); }
  void take_content(Level& /*level*/, std::string_view bytes) {
    if (chunk_failed_) return;
    if (const char* error = content_->take(bytes)) fail_chunk(error);
  }
  void end_content(Level& /*level*/) {
    if (!chunk_failed_) {
      if (const char* error = content_->finish(chunk_crc_))
        fail_chunk(error);
      else if (inner_->within())
        corrupt_record(place(), "chunk: its last record is cut");
    }
    give_held();
    inner_.reset();
    content_.reset();
  }

 protected:
  /// @param format for messages @param record_head how many bytes every record has at least
  ChunkedLogDecoder(const std::string& path, const LogRequest& request, std::string_view format,
                    std::string_view magic, std::size_t record_head)
      : RosLogDecoder(path, request, format),
        magic_(magic),
        record_head_(record_head),
        outer_(*this, record_head) {}

  /// Takes the bytes of the magic off a piece, as far as they are missing. @returns them
  std::string_view take_magic(std::string_view& piece) {
    const std::string_view part = piece.substr(0, std::min(magic_.size() - begin_.size(), piece.size()));
    begin_ += part;
    piece.remove_prefix(part.size());
    return part;
  }
  [[nodiscard]] bool is_empty() const { return begin_.empty(); }
  [[nodiscard]] bool has_magic() const { return begin_ == magic_; }
  void take_records(std::string_view piece) {
    if (has_magic()) outer_.take(piece);
  }
  /// Where the current record of the file begins, bytes.
  [[nodiscard]] std::uint64_t place() const { return magic_.size() + outer_.place(); }
  [[nodiscard]] bool is_outer(const Level& level) const { return &level == &outer_; }
  /// Tells whether the file ends within a record.
  [[nodiscard]] bool is_cut() const { return outer_.within(); }

  /// Begins a chunk. @param size of its content @param crc32 of that; 0: not told
  /// @returns its content, to be opened
  ChunkContent& begin_content(std::uint64_t size, std::uint32_t crc32) {
    inner_.emplace(*this, record_head_);
    content_.emplace(size, [this](std::string_view bytes) { inner_->take(bytes); });
    chunk_crc_ = crc32;
    chunk_failed_ = false;
    return *content_;
  }
  /// The chunk gives nothing more, and what is held of it is lost. The first error of a chunk is told.
  void fail_chunk(const char* error) {
    if (chunk_failed_) return;
    chunk_failed_ = true;
    (void)held_.take();
    corrupt_record(place(), std::string("chunk: ") + error);
  }
  /// Takes a message, or holds it until its chunk is known to be sound.
  void take_or_hold(std::uint32_t channel, std::int64_t log_time, std::string_view bytes) {
    if (!inner_) return take_message(channel, log_time, bytes, place());
    held_.add({channel, log_time, std::string(bytes)});
    if (held_.full()) give_held();
  }
  /// Gives what came of a chunk in which the file ends. Its records before the cut are as good as any.
  void give_cut_chunk() {
    if (content_ && !chunk_failed_) (void)content_->flush();
    give_held();
  }

 private:
  Decoder& decoder() { return static_cast<Decoder&>(*this); }
  void give_held() {
    for (const HeldMessage& message : held_.take())
      take_message(message.channel, message.log_time, message.bytes, place());
  }

  std::string_view magic_;
  std::string begin_;  ///< of the file, up to the length of the magic
  std::size_t record_head_;
  Level outer_;
  std::optional<Level> inner_;  ///< within a chunk
  std::optional<ChunkContent> content_;
  std::uint32_t chunk_crc_ = 0;
  bool chunk_failed_ = false;
  HeldMessages held_;
};

}  // namespace waymark::formats

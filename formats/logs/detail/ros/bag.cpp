#include <waymark/formats/logs/detail/ros/bag.hpp>

#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/ros/chunk_content.hpp>
#include <waymark/formats/logs/detail/ros/held_messages.hpp>
#include <waymark/formats/logs/detail/ros/record_level.hpp>
#include <waymark/formats/logs/detail/ros/ros_log.hpp>
#include <waymark/formats/logs/detail/ros/wire_cursor.hpp>
#include <waymark/formats/logs/detail/ros/wire_text.hpp>

namespace waymark::formats {
namespace {

constexpr unsigned kBagMessage = 0x02, kBagChunk = 0x05, kBagConnection = 0x07;
constexpr std::size_t kBagLength = 4;
/// A header holds a few short fields; a longer one is damaged, and where the next record begins is not known.
constexpr std::uint64_t kBagLongestHeader = 64U << 10U;
/// The data of a connection contain the definition of its type.
constexpr std::uint64_t kBagLongestConnection = 1U << 20U;
constexpr std::size_t kBagLongestName = 1024;

/// The fields "name=value" of a header, each behind its length.
struct BagHeader {
  explicit BagHeader(std::string_view bytes) : bytes_(bytes) {}
  /// Returns the value of a field; empty if there is none.
  [[nodiscard]] std::string_view field(std::string_view name) const {
    WireCursor from(bytes_);
    while (from.sound() && !from.rest().empty()) {
      const std::string_view entry = from.text();
      const std::size_t equals = entry.find('=');
      if (equals != std::string_view::npos && entry.substr(0, equals) == name)
        return entry.substr(equals + 1);
    }
    return {};
  }
  template <typename Number>
  [[nodiscard]] std::optional<Number> number(std::string_view name) const {
    const std::string_view value = field(name);
    if (value.size() != sizeof(Number)) return std::nullopt;
    return WireCursor(value).get<Number>();
  }

 private:
  std::string_view bytes_;
};

class BagDecoder final : public RosLogDecoder {
 public:
  using Level = RecordLevel<BagDecoder>;

  BagDecoder(const std::string& path, const LogRequest& request)
      : RosLogDecoder(path, request, "a ROS 1 bag"), outer_(*this, kBagLength) {}

  void take(std::string_view piece) override {
    if (magic_.size() < kBagMagic.size()) {
      const std::size_t part = std::min(kBagMagic.size() - magic_.size(), piece.size());
      magic_ += piece.substr(0, part);
      piece.remove_prefix(part);
    }
    if (magic_ == kBagMagic) outer_.take(piece);
  }

  [[nodiscard]] RecordStep begin(Level& level, std::string_view collected);
  void take_content(Level& level, std::string_view bytes);
  void end_content(Level& level);
  void passed(Level& /*level*/, std::string_view /*bytes*/) {}

 private:
  void end() override;
  [[nodiscard]] std::uint64_t place() const { return kBagMagic.size() + outer_.place(); }
  [[nodiscard]] RecordStep begin_data(bool inside, const BagHeader& header, std::uint64_t length,
                                      std::string_view data, std::size_t before);
  [[nodiscard]] RecordStep begin_message(const BagHeader& header, std::uint64_t length, std::string_view data,
                                         std::size_t before);
  void take_connection(const BagHeader& header, std::string_view data);
  void begin_chunk(const BagHeader& header);
  void fail_chunk(const char* error);
  void give_held();

  std::string magic_;
  Level outer_;
  std::optional<Level> inner_;  ///< within a chunk
  std::optional<ChunkContent> content_;
  HeldMessages held_;
  bool chunk_failed_ = false;
};

RecordStep BagDecoder::begin(Level& level, std::string_view collected) {
  WireCursor from(collected);
  const std::uint64_t header_length = from.get<std::uint32_t>();
  if (header_length > kBagLongestHeader) {
    corrupt_record(place(), "here no record begins; what follows is not read");
    return {RecordStep::Then::stop, 0};
  }
  const std::size_t before = kBagLength + static_cast<std::size_t>(header_length) + kBagLength;
  if (collected.size() < before) return {RecordStep::Then::collect, before};
  const BagHeader header(from.take(header_length));
  const std::uint64_t length = from.get<std::uint32_t>();
  return begin_data(&level != &outer_, header, length, from.rest(), before);
}

/// @param data as far as they are collected @param before size of what stands before the data
RecordStep BagDecoder::begin_data(bool inside, const BagHeader& header, std::uint64_t length,
                                  std::string_view data, std::size_t before) {
  const unsigned kind = header.number<std::uint8_t>("op").value_or(0);
  if (kind == kBagMessage) return begin_message(header, length, data, before);
  if (kind == kBagConnection) {
    if (length > kBagLongestConnection) {
      corrupt_record(place(), "connection: more than 1 MiB is no description of a type");
      return {RecordStep::Then::skip, length};
    }
    if (data.size() < length) return {RecordStep::Then::collect, before + length};
    take_connection(header, data);
    return {RecordStep::Then::skip, 0};
  }
  if (kind == kBagChunk && !inside) {
    begin_chunk(header);
    return {RecordStep::Then::stream, length};
  }
  return {RecordStep::Then::skip, length};
}

RecordStep BagDecoder::begin_message(const BagHeader& header, std::uint64_t length, std::string_view data,
                                     std::size_t before) {
  const auto channel = header.number<std::uint32_t>("conn");
  const auto time = header.number<std::uint64_t>("time");
  if (!channel || !time) {
    corrupt_record(place(), "message: its header has no connection and time");
    return {RecordStep::Then::skip, length};
  }
  if (data.empty()) {
    if (!wants(*channel)) return {RecordStep::Then::skip, length};
    if (length > kLongestMessage) {
      corrupt_record(place(), "message: more than 1 MiB is no message of this type");
      return {RecordStep::Then::skip, length};
    }
    if (length > 0) return {RecordStep::Then::collect, before + length};
  }
  // Seconds in the low half, nanoseconds in the high one.
  const auto log_time = static_cast<std::int64_t>(*time & 0xFFFFFFFFU) * kSecondNanoseconds +
                        static_cast<std::int64_t>(*time >> 32U);
  if (!inner_) {
    take_message(*channel, log_time, data, place());
  } else {
    held_.add({*channel, log_time, std::string(data)});
    if (held_.full()) give_held();
  }
  return {RecordStep::Then::skip, 0};
}

void BagDecoder::take_connection(const BagHeader& header, std::string_view data) {
  const auto id = header.number<std::uint32_t>("conn");
  const std::string_view topic = header.field("topic");
  const std::string_view type = BagHeader(data).field("type");
  const char* error =
      !id || topic.empty() || type.empty() ? "its topic or type is missing"
      : topic.size() > kBagLongestName || type.size() > kBagLongestName
          ? "its topic or type is too long"
          : add_channel(*id, {std::string(topic), std::string(type), RosType::other, RosEncoding::ros1});
  if (error != nullptr) corrupt_record(place(), std::string("connection: ") + error);
}

void BagDecoder::begin_chunk(const BagHeader& header) {
  const auto size = header.number<std::uint32_t>("size");
  inner_.emplace(*this, kBagLength);
  content_.emplace(size.value_or(0), [this](std::string_view bytes) { inner_->take(bytes); });
  chunk_failed_ = false;
  const char* error = size ? content_->open(header.field("compression")) : "its header has no size";
  if (error != nullptr) fail_chunk(error);
}

void BagDecoder::fail_chunk(const char* error) {
  if (chunk_failed_) return;
  chunk_failed_ = true;
  (void)held_.take();
  corrupt_record(place(), std::string("chunk: ") + error);
}

void BagDecoder::take_content(Level& /*level*/, std::string_view bytes) {
  if (chunk_failed_) return;
  if (const char* error = content_->take(bytes)) fail_chunk(error);
}

void BagDecoder::end_content(Level& /*level*/) {
  if (!chunk_failed_) {
    if (const char* error = content_->finish(0))
      fail_chunk(error);
    else if (inner_->within())
      corrupt_record(place(), "chunk: its last record is cut");
  }
  give_held();
  inner_.reset();
  content_.reset();
}

void BagDecoder::give_held() {
  for (const HeldMessage& message : held_.take())
    take_message(message.channel, message.log_time, message.bytes, place());
}

void BagDecoder::end() {
  if (magic_ != kBagMagic) {
    if (!magic_.empty()) corrupt_record(0, "it does not begin as a bag of version 2.0");
  } else if (outer_.within()) {
    if (content_ && !chunk_failed_) (void)content_->flush();
    give_held();
    corrupt_record(place(), "the file ends within this record; what came before is used");
  }
}

}  // namespace

std::unique_ptr<LogDecoder> BagReader::open(const std::string& path, const LogRequest& request) const {
  return std::make_unique<BagDecoder>(path, request);
}

Recognition BagReader::recognise(std::string_view head) const {
  if (!head.starts_with(kBagMagic)) return {};
  return {1, "it begins as a ROS 1 bag of version 2.0"};
}

}  // namespace waymark::formats

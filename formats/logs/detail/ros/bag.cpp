#include <waymark/formats/logs/detail/ros/bag.hpp>

#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/ros/chunked_log.hpp>
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

class BagDecoder final : public ChunkedLogDecoder<BagDecoder> {
 public:
  BagDecoder(const std::string& path, const LogRequest& request)
      : ChunkedLogDecoder(path, request, "a ROS 1 bag", kBagMagic, kBagLength) {}

  void take(std::string_view piece) override {
    (void)take_magic(piece);
    take_records(piece);
  }

  [[nodiscard]] RecordStep begin_record(Level& level, std::string_view collected);
  void pass_record(Level& /*level*/, std::string_view /*bytes*/) {}

 private:
  void end() override;
  [[nodiscard]] RecordStep begin_data(bool inside, const BagHeader& header, std::uint64_t length,
                                      std::string_view data, std::size_t before);
  [[nodiscard]] RecordStep begin_message(const BagHeader& header, std::uint64_t length, std::string_view data,
                                         std::size_t before);
  void take_connection(const BagHeader& header, std::string_view data);
  void begin_chunk(const BagHeader& header);
};

RecordStep BagDecoder::begin_record(Level& level, std::string_view collected) {
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
  return begin_data(!is_outer(level), header, length, from.rest(), before);
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
  take_or_hold(*channel, log_time, data);
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
  ChunkContent& content = begin_content(size.value_or(0), 0);
  const char* error = size ? content.open(header.field("compression")) : "its header has no size";
  if (error != nullptr) fail_chunk(error);
}

void BagDecoder::end() {
  if (!has_magic()) {
    if (!is_empty()) corrupt_record(0, "it does not begin as a bag of version 2.0");
  } else if (is_cut()) {
    give_cut_chunk();
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

#include <waymark/formats/logs/detail/ros/mcap.hpp>

#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>

#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/ros/chunked_log.hpp>
#include <waymark/formats/logs/detail/ros/wire_cursor.hpp>
#include <waymark/formats/logs/detail/ros/wire_text.hpp>

namespace waymark::formats {
namespace {

/// Opcode and length.
constexpr std::size_t kMcapRecordHead = 9;
/// Channel, sequence, log time, publish time.
constexpr std::size_t kMcapMessageHead = 2 + 4 + 8 + 8;
/// Start, end, uncompressed size, CRC, length of the name of the compression.
constexpr std::size_t kMcapChunkHead = 8 + 8 + 8 + 4 + 4;
/// The names at the beginning of a schema or channel; definitions and metadata may follow and are not read.
constexpr std::uint64_t kMcapNames = 4096;
constexpr std::size_t kMcapMostSchemas = 4096;

class McapDecoder final : public ChunkedLogDecoder<McapDecoder> {
 public:
  McapDecoder(const std::string& path, const LogRequest& request)
      : ChunkedLogDecoder(path, request, "an MCAP file", kMcapMagic, kMcapRecordHead) {}

  void take(std::string_view piece) override {
    add_to_crc(take_magic(piece));
    take_records(piece);
  }

  [[nodiscard]] RecordStep begin_record(Level& level, std::string_view collected);
  void pass_record(Level& level, std::string_view bytes) {
    if (is_outer(level)) add_to_crc(bytes);
  }

 private:
  void end() override;
  void add_to_crc(std::string_view bytes) {
    crc_ = static_cast<std::uint32_t>(
        ::crc32_z(crc_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  }
  [[nodiscard]] RecordStep begin_names(McapOpcode opcode, std::uint64_t length, std::string_view collected);
  [[nodiscard]] RecordStep begin_message(std::uint64_t length, std::string_view collected);
  [[nodiscard]] RecordStep begin_chunk(std::uint64_t length, std::string_view collected);
  void take_names(McapOpcode opcode, WireCursor from);

  std::uint32_t crc_ = 0;  ///< of all records before the current one, and the magic
  bool footer_ = false;
  std::map<std::uint16_t, std::string> schemas_;
};

constexpr RecordStep mcap_skipped(std::uint64_t size) {
  return {RecordStep::Then::skip, size};
}

/// Returns the step that goes on once the head and this many bytes of the content are there.
constexpr RecordStep mcap_collect(std::uint64_t size) {
  return {RecordStep::Then::collect, kMcapRecordHead + size};
}

RecordStep McapDecoder::begin_record(Level& level, std::string_view collected) {
  WireCursor from(collected);
  const McapOpcode opcode{from.get<std::uint8_t>()};
  const auto length = from.get<std::uint64_t>();
  const bool inside = !is_outer(level);
  // No file is as long as this, and places beyond it would overflow.
  constexpr std::uint64_t kMostBytes = 1ULL << 62U;
  if (opcode == McapOpcode{} || length > kMostBytes) {
    corrupt_record(place(), "here no record begins; what follows is not read");
    return {RecordStep::Then::stop, 0};
  }
  switch (opcode) {
    case McapOpcode::schema:
    case McapOpcode::channel:
      return begin_names(opcode, length, collected);
    case McapOpcode::message:
      return begin_message(length, collected);
    case McapOpcode::chunk:
      if (inside) break;
      return begin_chunk(length, collected);
    case McapOpcode::data_end:
      if (inside || length < 4) break;
      if (collected.size() == kMcapRecordHead) return mcap_collect(4);
      if (const auto told = from.get<std::uint32_t>(); told != 0 && told != crc_)
        corrupt_record(place(), "the checksum of all data is wrong: some of what was read is damaged");
      return mcap_skipped(length - 4);
    case McapOpcode::footer:
      if (inside) break;
      footer_ = true;
      return {RecordStep::Then::stop, 0};
    default:
      break;
  }
  return mcap_skipped(length);
}

RecordStep McapDecoder::begin_names(McapOpcode opcode, std::uint64_t length, std::string_view collected) {
  const std::uint64_t names = std::min(length, kMcapNames);
  if (collected.size() < kMcapRecordHead + names) return mcap_collect(names);
  take_names(opcode, WireCursor(collected.substr(kMcapRecordHead)));
  return mcap_skipped(length - names);
}

void McapDecoder::take_names(McapOpcode opcode, WireCursor from) {
  const auto id = from.get<std::uint16_t>();
  if (opcode == McapOpcode::schema) {
    const std::string_view name = from.text();
    if (!from.sound()) return corrupt_record(place(), "schema: it is cut, or its name is too long");
    if (schemas_.size() < kMcapMostSchemas) schemas_.try_emplace(id, name);
    return;
  }
  RosChannel channel;
  const auto schema = schemas_.find(from.get<std::uint16_t>());
  if (schema != schemas_.end()) channel.type_name = schema->second;
  channel.topic = from.text();
  channel.encoding = ros_encoding(from.text());
  const char* error =
      from.sound() ? add_channel(id, std::move(channel)) : "it is cut, or its names are too long";
  if (error != nullptr) corrupt_record(place(), std::string("channel: ") + error);
}

RecordStep McapDecoder::begin_message(std::uint64_t length, std::string_view collected) {
  if (length < kMcapMessageHead) {
    corrupt_record(place(), "message: it is shorter than its head");
    return mcap_skipped(length);
  }
  if (collected.size() < kMcapRecordHead + kMcapMessageHead) return mcap_collect(kMcapMessageHead);
  WireCursor from(collected.substr(kMcapRecordHead));
  const auto channel = from.get<std::uint16_t>();
  (void)from.get<std::uint32_t>();
  const auto log_time = static_cast<std::int64_t>(from.get<std::uint64_t>());
  if (collected.size() == kMcapRecordHead + kMcapMessageHead) {
    if (!wants(channel)) return mcap_skipped(length - kMcapMessageHead);
    if (length > kLongestMessage) {
      corrupt_record(place(), "message: more than 1 MiB is no message of this type");
      return mcap_skipped(length - kMcapMessageHead);
    }
    if (length > kMcapMessageHead) return mcap_collect(length);
  }
  const std::string_view bytes = collected.substr(kMcapRecordHead + kMcapMessageHead);
  take_or_hold(channel, log_time, bytes);
  return mcap_skipped(0);
}

RecordStep McapDecoder::begin_chunk(std::uint64_t length, std::string_view collected) {
  constexpr std::uint64_t kMcapLongestName = 64;
  if (collected.size() == kMcapRecordHead) {
    if (length >= kMcapChunkHead + 8) return mcap_collect(kMcapChunkHead);
    corrupt_record(place(), "chunk: it is shorter than its head");
    return mcap_skipped(length);
  }
  WireCursor from(collected.substr(kMcapRecordHead + 16));
  const auto size = from.get<std::uint64_t>();
  const auto crc = from.get<std::uint32_t>();
  const std::uint64_t name = from.get<std::uint32_t>();
  const std::uint64_t head = kMcapChunkHead + name + 8;
  if (name > kMcapLongestName || length < head) {
    corrupt_record(place(), "chunk: its head is damaged");
    return mcap_skipped(length - (collected.size() - kMcapRecordHead));
  }
  if (collected.size() < kMcapRecordHead + head) return mcap_collect(head);
  const std::string_view compression = from.take(name);
  const char* error = begin_content(size, crc).open(compression);
  if (error == nullptr && from.get<std::uint64_t>() != length - head)
    error = "its length is not that of its records";
  if (error != nullptr) fail_chunk(error);
  return {RecordStep::Then::stream, length - head};
}

void McapDecoder::end() {
  if (!has_magic()) {
    if (!is_empty()) corrupt_record(0, "it does not begin as an MCAP file of version 0");
    return;
  }
  if (is_cut()) {
    give_cut_chunk();
    corrupt_record(place(), "the file ends within this record; what came before is used");
  } else if (!footer_) {
    note("the file was not closed (it has no footer): it is read up to its end");
  }
}

}  // namespace

std::unique_ptr<LogDecoder> McapReader::open(const std::string& path, const LogRequest& request) const {
  return std::make_unique<McapDecoder>(path, request);
}

Recognition McapReader::recognise(std::string_view head) const {
  if (!head.starts_with(kMcapMagic)) return {};
  return {1, "it begins as an MCAP file"};
}

}  // namespace waymark::formats

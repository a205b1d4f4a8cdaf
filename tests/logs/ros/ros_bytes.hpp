/// Messages, MCAP files and bags made byte by byte from their specifications: mcap.dev/spec,
/// wiki.ros.org/Bags/Format/2.0, OMG DDSI-RTPS 2.5 and the definitions of the message types. Nothing here is
/// the writer's code.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace waymark_test {

/// How the numbers of a message stand in bytes.
enum class Wire { ros1, cdr_little, cdr_big };

/// Appends numbers and texts. CDR aligns a number to its size, counted behind the encapsulation; its texts end
/// with a zero that their length counts.
class WireWriter {
 public:
  explicit WireWriter(Wire form) : form_(form) {}

  template <typename Number>
  WireWriter& put(Number number) {
    if (form_ != Wire::ros1)
      bytes_.resize((bytes_.size() + sizeof number - 1) / sizeof number * sizeof number);
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    const bool swap = (form_ == Wire::cdr_big) != (std::endian::native == std::endian::big);
    for (std::size_t i = 0; i < sizeof number; ++i) bytes_ += raw[swap ? sizeof number - 1 - i : i];
    return *this;
  }
  WireWriter& text(std::string_view text) {
    const std::size_t zero = form_ == Wire::ros1 ? 0 : 1;
    put(static_cast<std::uint32_t>(text.size() + zero));
    bytes_ += text;
    bytes_.append(zero, '\0');
    return *this;
  }
  WireWriter& numbers(const std::vector<double>& values) {
    for (const double value : values) put(value);
    return *this;
  }
  /// std_msgs/Header; ROS 1 begins it with a running number.
  WireWriter& header(std::uint32_t seconds, std::uint32_t nanoseconds) {
    if (form_ == Wire::ros1) put(std::uint32_t{7});
    return put(seconds).put(nanoseconds).text("gps");
  }
  [[nodiscard]] std::string bytes() const {
    if (form_ == Wire::ros1) return bytes_;
    return std::string("\0", 1) + (form_ == Wire::cdr_big ? '\0' : '\1') + std::string(2, '\0') + bytes_;
  }

 private:
  Wire form_;
  std::string bytes_;
};

/// sensor_msgs/NavSatFix, 5 m further north every second, with sigmas of 1.5 m east and 2 m north.
inline std::string nav_sat_fix(Wire form, std::uint32_t second, std::int8_t status = 0,
                               double latitude_deg = 52.5) {
  return WireWriter(form)
      .header(1'700'000'000 + second, 250'000'000)
      .put(status)
      .put(std::uint16_t{1})
      .numbers({latitude_deg + 4.5e-5 * second, 13.4, 80})
      .numbers({2.25, 0, 0, 0, 4, 0, 0, 0, 9})
      .put(std::uint8_t{2})
      .bytes();
}

/// Little-endian without alignment, as both files have their own numbers.
template <typename... Numbers>
std::string little(Numbers... numbers) {
  WireWriter writer(Wire::ros1);
  (writer.put(numbers), ...);
  return writer.bytes();
}
inline std::string prefixed(std::string_view text) {
  return little(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

/// @name MCAP
///@{
inline const std::string kMcapBegin = "\x89MCAP0\r\n";
inline std::string mcap(std::uint8_t opcode, const std::string& content) {
  return little(opcode, std::uint64_t{content.size()}) + content;
}
/// A schema and a channel on it, both with this number.
inline std::string mcap_channel(std::uint16_t id, const std::string& topic, const std::string& type,
                                const std::string& encoding = "cdr") {
  return mcap(3, little(id) + prefixed(type) + prefixed("ros2msg") + prefixed("")) +
         mcap(4, little(id, id) + prefixed(topic) + prefixed(encoding) + little(std::uint32_t{0}));
}
inline std::string mcap_message(std::uint16_t channel, const std::string& bytes,
                                std::uint64_t log_time = 1'700'000'000'000'000'000) {
  return mcap(5, little(channel, std::uint32_t{0}, log_time, log_time) + bytes);
}
/// @param content the records as they stand in the file; `size` and `crc` are of the records uncompressed
inline std::string mcap_chunk(const std::string& compression, const std::string& content, std::uint64_t size,
                              std::uint32_t crc) {
  return mcap(6, little(std::uint64_t{0}, std::uint64_t{0}, size, crc) + prefixed(compression) +
                     little(std::uint64_t{content.size()}) + content);
}
/// A data section without a checksum, and a footer without a summary.
inline std::string mcap_end() {
  return mcap(15, little(std::uint32_t{0})) + mcap(2, std::string(20, '\0')) + kMcapBegin;
}
///@}

/// @name Bags
///@{
inline const std::string kBagBegin = "#ROSBAG V2.0\n";
inline std::string bag(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields) header += prefixed(field);
  return prefixed(header) + prefixed(data);
}
inline std::string bag_connection(std::uint32_t id, const std::string& topic, const std::string& type) {
  return bag({"op=\x07", "conn=" + little(id), "topic=" + topic},
             prefixed("topic=" + topic) + prefixed("type=" + type) + prefixed("md5sum=*") +
                 prefixed("message_definition="));
}
inline std::string bag_message(std::uint32_t connection, const std::string& bytes) {
  return bag({"op=\x02", "conn=" + little(connection),
              "time=" + little(std::uint32_t{1'700'000'000}, std::uint32_t{500'000'000})},
             bytes);
}
inline std::string bag_chunk(const std::string& compression, const std::string& content, std::size_t size) {
  return bag({"op=\x05", "compression=" + compression, "size=" + little(static_cast<std::uint32_t>(size))},
             content);
}
///@}

/// A frame of LZ4 with stored blocks (LZ4 frame format 1.6: the high bit of a block's size). Its descriptor
/// says independent blocks of at most 64 KB without checksums; 0x82 is the checksum of these two bytes.
inline std::string lz4_stored(const std::string& content) {
  return std::string("\x04\x22\x4D\x18\x60\x40\x82", 7) +
         little(static_cast<std::uint32_t>(content.size()) | 0x80000000U) + content + std::string(4, '\0');
}

}  // namespace waymark_test

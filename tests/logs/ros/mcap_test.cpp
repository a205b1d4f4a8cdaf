// MCAP files made here byte by byte from mcap.dev/spec.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include <zlib.h>
#include <zstd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/compression/codec.hpp>
#include <waymark/formats/logs/detail/ros/mcap.hpp>

#include "logs/log_pieces.hpp"
#include "logs/ros/ros_bytes.hpp"
#include "support/skip.hpp"

namespace mcap_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;
using Catch::Matchers::Message;

namespace {

constexpr std::size_t kFixes = 5;
const std::string kHead = kMcapBegin + mcap(1, prefixed("ros2") + prefixed("test"));
const std::string kFixChannel = mcap_channel(1, "/fix", "sensor_msgs/msg/NavSatFix");

std::string fixes() {
  std::string records;
  for (std::uint32_t second = 0; second < kFixes; ++second)
    records += mcap_message(1, nav_sat_fix(Wire::cdr_little, second));
  return records;
}

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string zstd(const std::string& content) {
  std::string out(::ZSTD_compressBound(content.size()), '\0');
  out.resize(::ZSTD_compress(out.data(), out.size(), content.data(), content.size(), 3));
  return out;
}

LogRequest request() {
  LogRequest made;
  made.time_scale = TimeScale::unix_time;
  return made;
}

LogData read(const std::string& file) {
  return check_pieces(McapReader(), file, "run.mcap", request());
}

std::vector<std::string> complaints(const std::string& file) {
  return read(file).corrupt_examples;
}

std::string at(std::size_t place, const std::string& what) {
  return "run.mcap:byte " + std::to_string(place) + ": " + what;
}

}  // namespace

TEST_CASE("MCAP: messages outside of chunks give the fixes that were written") {
  const LogData data = read(kHead + kFixChannel + fixes() + mcap_end());
  REQUIRE(data.fixes.size() == kFixes);
  CHECK(data.corrupt == 0);
  CHECK(data.fixes[2].stamp == Stamp{1'700'000'002'250'000'000});
  CHECK(data.fixes[2].latitude_deg == 52.5 + 4.5e-5 * 2);
  CHECK(data.fixes[2].longitude_deg == 13.4);
  CHECK(data.fixes[2].height_m == 80);
  CHECK(data.fixes[2].covariance_en == (Eigen::Matrix2d() << 2.25, 0, 0, 4).finished());
  CHECK(data.kinds.at("/fix (sensor_msgs/msg/NavSatFix)") == kFixes);
  CHECK(data.notes ==
        std::vector<std::string>{"run.mcap: stamps are those of the messages' headers, taken as Unix time"});
}

TEST_CASE("MCAP: chunks give the same messages in every compression") {
  const std::string compression = GENERATE("", "lz4", "zstd");
  if (compression == "lz4" && !lz4_codec()) return skip("this build has no lz4");
  const std::string records = kFixChannel + fixes();
  const std::string content = compression == "lz4"    ? lz4_stored(records)
                              : compression == "zstd" ? zstd(records)
                                                      : records;
  const LogData data =
      read(kHead + mcap_chunk(compression, content, records.size(), crc_of(records)) + mcap_end());
  CHECK(data.corrupt == 0);
  check_same(data, read(kHead + kFixChannel + fixes() + mcap_end()));
}

TEST_CASE("MCAP: a chunk that is not what it claims is left out and named, and the next one is read") {
  const std::string good =
      mcap_chunk("", kFixChannel + fixes(), kFixChannel.size() + fixes().size(), 0);  // 0: no checksum
  const auto after = [&](const std::string& chunk) { return read(kHead + chunk + good + mcap_end()); };
  const auto check_left_out = [&](const std::string& chunk, const std::string& what) {
    INFO(what);
    const LogData data = after(chunk);
    CHECK(data.fixes.size() == kFixes);
    CHECK(data.corrupt == 1);
    CHECK(data.corrupt_examples == std::vector<std::string>{at(kHead.size(), "chunk: " + what)});
  };
  const std::string records = kFixChannel + fixes();
  check_left_out(mcap_chunk("", records, records.size(), crc_of(records) ^ 1), "its checksum is wrong");
  check_left_out(mcap_chunk("snappy", records, records.size(), 0), "its compression is not known");
  check_left_out(mcap_chunk("zstd", "not Zstandard", records.size(), 0), "its compressed content is damaged");
  check_left_out(mcap_chunk("", records, records.size() + 1, 0), "it holds fewer bytes than it claims");
  check_left_out(mcap_chunk("", records, records.size() - 1, 0), "it holds more bytes than it claims");
  check_left_out(mcap_chunk("", records, std::uint64_t{1} << 40U, 0), "it claims more than 1 GiB");
  check_left_out(mcap(6, "short"), "it is shorter than its head");
}

TEST_CASE("MCAP: a wrong checksum of the data section is told, with its place") {
  const std::string data_section = kHead + kFixChannel + fixes();
  const std::string footer = mcap(2, std::string(20, '\0')) + kMcapBegin;
  CHECK(complaints(data_section + mcap(15, little(crc_of(data_section))) + footer).empty());
  CHECK(complaints(data_section + mcap(15, little(crc_of(data_section) ^ 1)) + footer) ==
        std::vector<std::string>{
            at(data_section.size(), "the checksum of all data is wrong: some of what was read is damaged")});
}

TEST_CASE("MCAP: a file that is cut gives what came before, and says where it was cut") {
  const std::string whole = kHead + kFixChannel + fixes();
  const std::size_t message = fixes().size() / kFixes;
  const LogData data = read(whole.substr(0, whole.size() - 1));
  CHECK(data.fixes.size() == kFixes - 1);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            at(whole.size() - message, "the file ends within this record; what came before is used")});
  const LogData open = read(whole);
  CHECK(open.fixes.size() == kFixes);
  CHECK(open.corrupt == 0);
  CHECK(open.notes.at(0) == "run.mcap: the file was not closed (it has no footer): it is read up to its end");
  // Within a chunk, the records before the cut are as good as any.
  const std::string records = kFixChannel + fixes();
  const std::string chunked = kHead + mcap_chunk("", records, records.size(), 0);
  const LogData half = read(chunked.substr(0, chunked.size() - message));
  CHECK(half.fixes.size() == kFixes - 1);
  CHECK(half.corrupt_examples ==
        std::vector<std::string>{
            at(kHead.size(), "the file ends within this record; what came before is used")});
}

TEST_CASE("MCAP: unknown opcodes are passed over, opcode 0 ends the reading") {
  // "Opcodes in the range 0x01-0x7F are reserved, 0x80-0xFF are for private use; 0x00 is not a valid opcode."
  CHECK(complaints(kHead + mcap(0x42, "later") + mcap(0x90, "own") + kFixChannel + fixes() + mcap_end())
            .empty());
  const std::string before = kHead + kFixChannel + fixes();
  const LogData data = read(before + mcap(0, "nothing") + fixes() + mcap_end());
  CHECK(data.fixes.size() == kFixes);
  CHECK(data.corrupt_examples.at(0) == at(before.size(), "here no record begins; what follows is not read"));
}

TEST_CASE("MCAP: a message that cannot be read is named with topic and place") {
  const std::string before = kHead + kFixChannel;
  const std::string fix = nav_sat_fix(Wire::cdr_little, 0);
  CHECK(complaints(before + mcap_message(1, fix.substr(0, 40)) + fixes() + mcap_end()) ==
        std::vector<std::string>{at(before.size(), "'/fix': the message is shorter than its type")});
  CHECK(complaints(before + mcap_message(1, nav_sat_fix(Wire::cdr_little, 0, 0, 91)) + mcap_end()) ==
        std::vector<std::string>{
            at(before.size(),
               "NavSatFix: its latitude is outside -90 .. 90, or its longitude outside -180 .. 180")});
  CHECK(complaints(before + mcap(5, "short") + fixes() + mcap_end()) ==
        std::vector<std::string>{at(before.size(), "message: it is shorter than its head")});
  CHECK(complaints(before + mcap(3, "\1") + fixes() + mcap_end()) ==
        std::vector<std::string>{at(before.size(), "schema: it is cut, or its name is too long")});
}

TEST_CASE("MCAP: stamps are Unix time, which the scale of a drive turns into GPS time") {
  LogRequest gps;
  gps.time_scale = TimeScale::gps;
  const LogData data = McapReader().read(kHead + kFixChannel + fixes() + mcap_end(), "run.mcap", gps);
  // GPS time began on 1980-01-06, 315964800 s after Unix time, and was 18 leap seconds ahead in 2023.
  CHECK(data.fixes.at(0).stamp == Stamp{(1'700'000'000 - 315'964'800 + 18) * 1'000'000'000LL + 250'000'000});
}

TEST_CASE("MCAP: a fix without a solution is counted as one, not as damage") {
  const LogData data = read(kHead + kFixChannel + mcap_message(1, nav_sat_fix(Wire::cdr_little, 9, -1)) +
                            fixes() + mcap_end());
  CHECK(data.without_fix == 1);
  CHECK(data.fixes.size() == kFixes);
  CHECK(data.corrupt == 0);
}

TEST_CASE("MCAP: a file without a readable schema, or with two that fit, is refused with its topics") {
  const std::string camera = mcap_channel(2, "/camera", "sensor_msgs/msg/Image") + mcap_message(2, "picture");
  CHECK_THROWS_MATCHES(
      read(kHead + camera + mcap_end()), InputError,
      Message("run.mcap: no topic has the messages that are asked for (NavSatFix); topics: '/camera' "
              "('sensor_msgs/msg/Image', 1 messages)"));
  // A channel of a schema that never came has no type.
  const std::string orphan = mcap(
      4, little(std::uint16_t{3}, std::uint16_t{9}) + prefixed("/lost") + prefixed("cdr") + prefixed(""));
  CHECK_THROWS_MATCHES(read(kHead + orphan + mcap_message(3, "?") + mcap_end()), InputError,
                       Message("run.mcap: no topic has the messages that are asked for (NavSatFix); topics: "
                               "'/lost' ('', 1 messages)"));
  const std::string two = kFixChannel + mcap_channel(2, "/rtk", "sensor_msgs/msg/NavSatFix") + fixes() +
                          mcap_message(2, nav_sat_fix(Wire::cdr_little, 0));
  CHECK_THROWS_MATCHES(read(kHead + two + mcap_end()), InputError,
                       Message("run.mcap: several topics fit; state 'topic'; topics: '/fix' "
                               "('sensor_msgs/msg/NavSatFix', 5 messages), '/rtk' "
                               "('sensor_msgs/msg/NavSatFix', 1 messages)"));
  LogRequest rtk = request();
  rtk.columns["topic"] = {"/rtk", "", ""};
  CHECK(McapReader().read(kHead + two + mcap_end(), "run.mcap", rtk).fixes.size() == 1);
}

TEST_CASE("MCAP: another file is not recognised, and refused at its first byte") {
  CHECK(McapReader().recognise(kHead).certainty == 1);
  CHECK(McapReader().recognise("\x89MCAP1\r\n").certainty == 0);
  CHECK_THROWS_MATCHES(
      McapReader().read("\x89MCAP1\r\n....", "run.mcap", request()), InputError,
      Message("run.mcap: none of 1 records could be used; first: run.mcap:byte 0: it does not "
              "begin as an MCAP file of version 0"));
}

}  // namespace mcap_test

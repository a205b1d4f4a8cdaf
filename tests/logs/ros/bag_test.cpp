// Bags made here byte by byte from wiki.ros.org/Bags/Format/2.0.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#ifdef WAYMARK_HAS_BZIP2
#include <bzlib.h>
#endif

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/compression/codec.hpp>
#include <waymark/formats/logs/detail/ros/bag.hpp>

#include "logs/log_pieces.hpp"
#include "logs/ros/ros_bytes.hpp"
#include "support/skip.hpp"

namespace bag_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;
using Catch::Matchers::Message;

namespace {

constexpr std::size_t kFixes = 5;
/// The record of the bag itself, op 3, is padded to 4096 bytes.
const std::string kHead =
    kBagBegin + bag({"op=\x03", "index_pos=" + little(std::uint64_t{0})}, std::string(4096, ' '));
const std::string kFixConnection = bag_connection(0, "/fix", "sensor_msgs/NavSatFix");

std::string fixes() {
  std::string records;
  for (std::uint32_t second = 0; second < kFixes; ++second)
    records += bag_message(0, nav_sat_fix(Wire::ros1, second));
  return records;
}

LogRequest request(StreamKind stream = StreamKind::gnss) {
  LogRequest made;
  made.time_scale = TimeScale::unix_time;
  made.stream = stream;
  return made;
}

LogData read(const std::string& file, const LogRequest& wanted = request()) {
  return check_pieces(BagReader(), file, "run.bag", wanted);
}

std::string at(std::size_t place, const std::string& what) {
  return "run.bag:byte " + std::to_string(place) + ": " + what;
}

#ifdef WAYMARK_HAS_BZIP2
std::string bz2(std::string content) {
  std::string out(content.size() + content.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned>(out.size());
  REQUIRE(::BZ2_bzBuffToBuffCompress(out.data(), &size, content.data(), static_cast<unsigned>(content.size()),
                                     9, 0, 0) == BZ_OK);
  out.resize(size);
  return out;
}
#endif

}  // namespace

TEST_CASE("bag: messages give the fixes that were written, at the stamps of their headers") {
  const LogData data = read(kHead + kFixConnection + fixes());
  REQUIRE(data.fixes.size() == kFixes);
  CHECK(data.corrupt == 0);
  CHECK(data.fixes[2].stamp == Stamp{1'700'000'002'250'000'000});
  CHECK(data.fixes[2].latitude_deg == 52.5 + 4.5e-5 * 2);
  CHECK(data.fixes[2].covariance_en == (Eigen::Matrix2d() << 2.25, 0, 0, 4).finished());
  CHECK(data.kinds.at("/fix (sensor_msgs/NavSatFix)") == kFixes);
}

TEST_CASE("bag: a Twist has the time of recording, seconds before nanoseconds") {
  const std::string twist = WireWriter(Wire::ros1).numbers({5.5, 0, 0, 0, 0, -0.25}).bytes();
  const LogData data =
      read(kHead + bag_connection(4, "/motion", "geometry_msgs/Twist") + bag_message(4, twist),
           request(StreamKind::odometry));
  REQUIRE(data.odometry.size() == 1);
  CHECK(data.odometry[0].stamp == Stamp{1'700'000'000'500'000'000});
  CHECK(data.odometry[0].speed_mps == 5.5);
  CHECK(data.odometry[0].yaw_rate_radps == -0.25);
  CHECK(data.notes.at(0) ==
        "run.bag: 1 messages have no stamp of their own: the time of recording stands in");
}

TEST_CASE("bag: chunks give the same messages in every compression") {
  const std::string records = kFixConnection + fixes();
  const LogData plain = read(kHead + records);
  check_same(read(kHead + bag_chunk("none", records, records.size())), plain);
  if (lz4_codec()) check_same(read(kHead + bag_chunk("lz4", lz4_stored(records), records.size())), plain);
#ifdef WAYMARK_HAS_BZIP2
  check_same(read(kHead + bag_chunk("bz2", bz2(records), records.size())), plain);
  std::string damaged = bz2(records);
  damaged[damaged.size() / 2] ^= 0x10;
  const LogData data = read(kHead + bag_chunk("bz2", damaged, records.size()) + records);
  // bzip2 finds damage at the end of a block: nothing of it is used but the records behind the chunk.
  REQUIRE(data.fixes.size() == kFixes);
  for (std::size_t i = 0; i < kFixes; ++i) CHECK(data.fixes[i].stamp == plain.fixes[i].stamp);
  REQUIRE(data.corrupt > 0);
  CHECK(data.corrupt_examples.back() == at(kHead.size(), "chunk: its compressed content is damaged"));
#endif
}

TEST_CASE("bag: a chunk of an unknown compression or size is named, and the records behind it are read") {
  const std::string records = kFixConnection + fixes();
  const auto check_left_out = [&](const std::string& chunk, const std::string& what) {
    const LogData data = read(kHead + chunk + records);
    CHECK(data.fixes.size() == kFixes);
    CHECK(data.corrupt_examples == std::vector<std::string>{at(kHead.size(), "chunk: " + what)});
  };
  check_left_out(bag_chunk("snappy", records, records.size()), "its compression is not known");
  check_left_out(bag({"op=\x05", "compression=none"}, records), "its header has no size");
}

TEST_CASE("bag: a file that is cut gives what came before, and says where it was cut") {
  const std::string whole = kHead + kFixConnection + fixes();
  const std::size_t message = fixes().size() / kFixes;
  const LogData data = read(whole.substr(0, whole.size() - 1));
  CHECK(data.fixes.size() == kFixes - 1);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            at(whole.size() - message, "the file ends within this record; what came before is used")});
}

TEST_CASE("bag: unknown kinds of records are passed over, lengths that cannot be end the reading") {
  const std::string before = kHead + kFixConnection;
  CHECK(read(before + bag({"op=\x63"}, "later") + bag({}, "no op") + fixes()).corrupt == 0);
  const LogData data = read(before + fixes() + std::string(8, '\xFF') + fixes());
  CHECK(data.fixes.size() == kFixes);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            at(before.size() + fixes().size(), "here no record begins; what follows is not read")});
}

TEST_CASE("bag: a record that lacks what its kind needs is named with its place") {
  const std::string before = kHead + kFixConnection;
  const auto first = [&](const std::string& record) {
    return read(before + record + fixes()).corrupt_examples.at(0);
  };
  CHECK(first(bag({"op=\x02", "conn=" + little(std::uint32_t{0})}, "x")) ==
        at(before.size(), "message: its header has no connection and time"));
  CHECK(first(bag({"op=\x07", "conn=" + little(std::uint32_t{3})}, prefixed("type=a/B"))) ==
        at(before.size(), "connection: its topic or type is missing"));
  CHECK(first(bag_message(0, "short")) == at(before.size(), "'/fix': the message is shorter than its type"));
}

TEST_CASE("bag: without a topic of a type that is read it is refused with its topics") {
  CHECK_THROWS_MATCHES(
      read(kHead + bag_connection(0, "/camera", "sensor_msgs/Image") + bag_message(0, "picture")), InputError,
      Message("run.bag: no topic has the messages that are asked for (NavSatFix); topics: '/camera' "
              "('sensor_msgs/Image', 1 messages)"));
  LogRequest rtk = request();
  rtk.columns["topic"] = {"/rtk", "", ""};
  CHECK_THROWS_MATCHES(read(kHead + kFixConnection + fixes(), rtk), InputError,
                       Message("run.bag: there is no topic '/rtk'; topics: '/fix' "
                               "('sensor_msgs/NavSatFix', 5 messages)"));
}

TEST_CASE("bag: another version is not recognised, and refused at its first byte") {
  CHECK(BagReader().recognise(kHead).certainty == 1);
  CHECK(BagReader().recognise("#ROSBAG V1.2\n").certainty == 0);
  CHECK_THROWS_MATCHES(BagReader().read("#ROSBAG V1.2\n....", "run.bag", request()), InputError,
                       Message("run.bag: none of 1 records could be used; first: run.bag:byte 0: it does not "
                               "begin as a bag of version 2.0"));
}

}  // namespace bag_test

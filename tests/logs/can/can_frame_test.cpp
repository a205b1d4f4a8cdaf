#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include <waymark/formats/logs/detail/can/can_frame.hpp>

namespace can_frame_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

/// The bytes of a data frame, or the error in them.
struct Bytes {
  std::vector<int> bytes;
  std::string what;
};

Bytes bytes_of(std::string_view line) {
  CanData data;
  Bytes result;
  result.what = read_can_data(split_can_line(line), data);
  for (std::size_t i = 0; i < data.size; ++i) result.bytes.push_back(data.bytes[i]);
  return result;
}

std::string trouble(std::string_view text) {
  const CanLine line = split_can_line(text);
  CHECK(line.kind == FrameKind::none);
  return std::to_string(line.column) + ": " + std::string(line.what);
}

}  // namespace

TEST_CASE("can frame: lines of candump -l") {
  const CanLine standard = split_can_line("(1627274455.023950) can0 7E8#03412F8C00000000");
  CHECK(standard.kind == FrameKind::data);
  CHECK(standard.id == 0x7E8);
  CHECK(standard.stamp == "1627274455.023950");
  CHECK(standard.interface == "can0");
  CHECK(bytes_of("(1.0) can0 7E8#03412F8C").bytes == std::vector<int>{0x03, 0x41, 0x2F, 0x8C});
  CHECK(split_can_line("(1.0) vcan12 17F00010#20").id == (0x17F00010 | kExtendedFrame));
  CHECK(split_can_line("(1.0) can0 00000010#20").id == (0x10 | kExtendedFrame));
  CHECK(bytes_of("(1.0) can0 123#").bytes.empty());
  CHECK(bytes_of("(1.0) can0 123#").what.empty());
  CHECK(bytes_of("(1.0) can0 123#aB.c1").bytes == std::vector<int>{0xAB, 0xC1});
  CHECK(bytes_of("(1.0) can0 123#0102 R").bytes == std::vector<int>{1, 2});  // candump -x
  CHECK(bytes_of("(1.0) can0 123#0102030405060708_E").bytes.size() == 8);    // raw length code
}

TEST_CASE("can frame: CAN FD, remote and error frames") {
  const std::string data(128, 'A');
  CHECK(bytes_of("(1.0) can0 123##1" + data).bytes == std::vector<int>(64, 0xAA));
  CHECK(bytes_of("(1.0) can0 123##0").bytes.empty());
  CHECK(bytes_of("(1.0) can0 123##1" + data + "00").what == "more than 64 bytes of data");
  CHECK(split_can_line("(1.0) can0 123#R").kind == FrameKind::remote);
  CHECK(split_can_line("(1.0) can0 123#R8").kind == FrameKind::remote);
  CHECK(split_can_line("(1.0) can0 20000080#0000000000000000").kind == FrameKind::error);
}

TEST_CASE("can frame: the console layout of candump -ta") {
  const char* line = " (1627274455.012500)  can0  7E8   [8]  03 41 0D 00 01 02 03 04";
  CHECK(split_can_line(line).id == 0x7E8);
  CHECK(split_can_line(line).interface == "can0");
  CHECK(bytes_of(line).bytes == std::vector<int>{3, 0x41, 0x0D, 0, 1, 2, 3, 4});
  CHECK(bytes_of(" (1.0)  can0  123   [2]  41 42   'AB'").bytes == std::vector<int>{0x41, 0x42});
  CHECK(bytes_of(" (1.0)  can0  123   [0]").what.empty());
  CHECK(bytes_of(" (1.0)  can0  RX - -  123   [1]  41").bytes == std::vector<int>{0x41});
  CHECK(bytes_of(" (1.0)  can0  17F00010  [02]  41 42").bytes == std::vector<int>{0x41, 0x42});
  CHECK(split_can_line(" (1.0)  can0  123   [8]  remote request").kind == FrameKind::remote);
  CHECK(split_can_line(" (1.0)  can0  20000080   [8]  00 00 00 00 00 00 00 00   ERRORFRAME").kind ==
        FrameKind::error);
  CHECK(bytes_of(" (1.0)  can0  123   [3]  41 42").what == "fewer bytes than the stated length");
}

TEST_CASE("can frame: stamps are exact to the nanosecond") {
  CHECK(can_stamp("1627274455.012500")->nanoseconds == 1'627'274'455'012'500'000);
  CHECK(can_stamp("1627274455.012500001")->nanoseconds == 1'627'274'455'012'500'001);
  CHECK(can_stamp("46408.584170")->nanoseconds == 46'408'584'170'000);
  CHECK(can_stamp("9223372036.854775")->nanoseconds == 9'223'372'036'854'775'000);
  CHECK_FALSE(can_stamp("9999999999.999999"));
  CHECK_FALSE(can_stamp("162727445a.012500"));
  CHECK_FALSE(can_stamp("2021-07-26 04:40:55.012500"));
  CHECK_FALSE(can_stamp(""));
}

TEST_CASE("can frame: what is no frame is told with its place") {
  CHECK(trouble("") == "1: expected a time stamp in parentheses, as candump writes");
  CHECK(trouble("  can0  7E8   [1]  03") == "3: expected a time stamp in parentheses, as candump writes");
  CHECK(trouble("(1627274455.0") == "2: the time stamp's ')' is missing");
  CHECK(trouble("(1.0)") == "6: expected an interface such as can0");
  CHECK(trouble("(1.0) can0") == "11: expected an id of 3 (000 .. 7FF) or 8 (.. 1FFFFFFF) hex digits");
  CHECK(trouble("(1.0) can0 12#00") == "12: expected an id of 3 (000 .. 7FF) or 8 (.. 1FFFFFFF) hex digits");
  CHECK(trouble("(1.0) can0 FFF#00") == "12: expected an id of 3 (000 .. 7FF) or 8 (.. 1FFFFFFF) hex digits");
  CHECK(trouble("(1.0) can0 FFFFFFFF#00") ==
        "12: expected an id of 3 (000 .. 7FF) or 8 (.. 1FFFFFFF) hex digits");
  CHECK(trouble("(1.0) can0 123x") == "15: expected '#' after the id");
  CHECK(trouble("(1.0) can0 123##") == "17: expected one hex digit of CAN FD flags after '##'");
  CHECK(trouble("(1.0) can0 123 x") == "16: expected '#' or '[' after the id");
  CHECK(trouble("(1.0) can0 123 [99] 00") == "19: expected a length of 0 to 64 bytes in brackets");
  CHECK(bytes_of("(1.0) can0 123#012").what == "half a byte: the data have an odd number of hex digits");
  CHECK(bytes_of("(1.0) can0 123#01xx").what == "expected hex digits as data");
}

}  // namespace can_frame_test

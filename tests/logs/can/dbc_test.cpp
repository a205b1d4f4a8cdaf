#include <catch2/catch.hpp>

#include <bit>
#include <cstring>
#include <random>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/detail/common/unit_words.hpp>

namespace dbc_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

Dbc parsed(const std::string& text) {
  return Dbc::parse(text, "car.dbc");
}

/// One message of 8 bytes with this signal.
DbcSignal signal_of(const std::string& definition) {
  return parsed("BO_ 170 WHEELS: 8 ECU\n SG_ S : " + definition + " [0|0] \"\" X\n").messages[0].signals[0];
}

CanData bytes(std::initializer_list<int> values) {
  CanData data;
  for (const int value : values) data.bytes[data.size++] = static_cast<std::uint8_t>(value);
  return data;
}

/// The bits of a signal by the specification: Intel signals grow from the start bit upwards, Motorola signals
/// begin with the most significant bit and go down within a byte, then on to the next byte's bit 7.
std::uint64_t bit_by_bit(const CanData& data, unsigned start, unsigned length, bool motorola) {
  std::uint64_t value = 0;
  unsigned place = start;
  for (unsigned i = 0; i < length; ++i) {
    const std::uint64_t bit = (data.bytes[place / 8] >> (place % 8)) & 1U;
    if (motorola) {
      value = value << 1U | bit;
      place = place % 8 == 0 ? place + 15 : place - 1;
    } else {
      value |= bit << i;
      ++place;
    }
  }
  return value;
}

}  // namespace

TEST_CASE("dbc: the parts of messages and signals") {
  const Dbc dbc = parsed(
      "VERSION \"\"\r\n"
      "NS_ :\r\n\tSG_MUL_VAL_\r\n\tSIG_VALTYPE_\r\n"
      "BO_ 2364540158 EEC1: 8 Engine\r\n"
      " SG_ EngineSpeed : 24|16@1+ (0.125,0) [0|8031.875] \"rpm\" Vector__XXX\r\n"
      "\r\n"
      "BO_ 36 KINEMATICS: 8 XXX\r\n"
      " SG_ YAW_RATE : 1|10@0- (0.244,-125) [-1.5E+2|1.5e2] \"\xB0/s\" XXX,YYY\r\n"
      "// SG_ YAW_RATE : 1|10@0+ (1,0) [0|0] \"\" XXX\r\n"
      "CM_ SG_ 36 YAW_RATE \"runs over\r\nBO_ 36 lines: 8 X\r\n\";\r\n"
      "VAL_ 36 YAW_RATE 0 \"none\";\r\n");
  REQUIRE(dbc.messages.size() == 2);
  CHECK(dbc.messages[0].id == (0x0CF004FEU | kExtendedFrame));
  CHECK(dbc.messages[0].name == "EEC1");
  const DbcSignal& yaw = dbc.messages[1].signals.at(0);
  CHECK(dbc.messages[1].signals.size() == 1);
  CHECK(yaw.start == 1);
  CHECK(yaw.length == 10);
  CHECK(yaw.big_endian);
  CHECK(yaw.number == SignalNumber::signed_integer);
  CHECK(yaw.factor == 0.244);
  CHECK(yaw.offset == -125);
  CHECK(yaw.unit == "°/s");
  CHECK(yaw.line == 9);
}

TEST_CASE("dbc: bits of both byte orders, anywhere, of any length") {
  std::mt19937 random(1);
  CanData data;
  data.size = 64;
  for (auto& byte : data.bytes) byte = static_cast<std::uint8_t>(random());
  for (int trial = 0; trial < 20000; ++trial) {
    DbcSignal signal;
    signal.big_endian = random() % 2 == 1;
    signal.start = static_cast<unsigned>(random() % 512);
    signal.length = static_cast<unsigned>(1 + random() % 64);
    if (signal.bytes_needed() > 64) continue;
    REQUIRE(signal.bits(data) == bit_by_bit(data, signal.start, signal.length, signal.big_endian));
  }
}

TEST_CASE("dbc: numbers") {
  CHECK(signal_of("0|16@1+ (1,0)").value(bytes({0x34, 0x12, 0, 0, 0, 0, 0, 0})) == 0x1234);
  CHECK(signal_of("7|16@0+ (1,0)").value(bytes({0x12, 0x34, 0, 0, 0, 0, 0, 0})) == 0x1234);
  CHECK(signal_of("0|16@1- (1,0)").value(bytes({0xFE, 0xFF, 0, 0, 0, 0, 0, 0})) == -2);
  CHECK(signal_of("0|64@1- (1,0)").value(bytes({255, 255, 255, 255, 255, 255, 255, 255})) == -1);
  CHECK(signal_of("0|64@1+ (1,0)").value(bytes({255, 255, 255, 255, 255, 255, 255, 255})) ==
        18446744073709551615.0);
  CHECK(signal_of("4|4@1- (1,0)").value(bytes({0x8F, 0, 0, 0, 0, 0, 0, 0})) == -8);
  // RAV4's WHEEL_SPEED_FR of the bytes 25B5: 9653 * 0.01 - 67.67.
  CHECK(signal_of("7|16@0+ (0.01,-67.67)").value(bytes({0x25, 0xB5, 0, 0, 0, 0, 0, 0})) == 28.86);
}

TEST_CASE("dbc: decimal factors give the decimal number that is meant") {
  const DbcSignal latitude = signal_of("1|28@1+ (1e-06,-90)");
  for (std::uint64_t raw = 146'098'655; raw < 146'099'655; ++raw) {
    CanData data = bytes({0, 0, 0, 0, 0, 0, 0, 0});
    const std::uint64_t word = raw << 1U;
    for (unsigned i = 0; i < 8; ++i) data.bytes[i] = static_cast<std::uint8_t>(word >> (8 * i));
    const std::string decimals = std::to_string(raw - 146'000'000);  // 56.098655 and so on
    REQUIRE(latitude.value(data) == std::stod("56.0" + decimals));
  }
  // An odd factor is multiplied as it stands.
  CHECK(signal_of("0|8@1+ (0.0174532925199432957,0)").value(bytes({180, 0, 0, 0, 0, 0, 0, 0})) ==
        Approx(3.14159265358979));
}

TEST_CASE("dbc: integers of a signal without a double between") {
  const DbcSignal epoch = signal_of("8|40@1+ (0.001,1577840400)");
  // 002#0150FC7F820B of a real log: 0x0B827FFC50 ms.
  CHECK(epoch.integer(bytes({0x01, 0x50, 0xFC, 0x7F, 0x82, 0x0B, 0, 0}), 1'000'000'000) ==
        (0x0B827FFC50LL + 1'577'840'400'000) * 1'000'000);
  CHECK_FALSE(signal_of("0|64@1+ (1,0)").integer(bytes({255, 255, 255, 255, 255, 255, 255, 255}), 1000));
}

TEST_CASE("dbc: floating-point signals") {
  const Dbc dbc = parsed(
      "BO_ 1 FLOATS: 12 X\n SG_ A : 0|32@1- (2,1) [0|0] \"\" X\n SG_ B : 39|64@0- (1,0) [0|0] \"\" X\n"
      "SIG_VALTYPE_ 1 A : 1;\nSIG_VALTYPE_ 1 B : 2;\n");
  CanData data;
  data.size = 12;
  const auto a = std::bit_cast<std::uint32_t>(1.5F);
  const auto b = std::bit_cast<std::uint64_t>(-0.1);
  for (unsigned i = 0; i < 4; ++i) data.bytes[i] = static_cast<std::uint8_t>(a >> (8 * i));
  for (unsigned i = 0; i < 8; ++i) data.bytes[4 + i] = static_cast<std::uint8_t>(b >> (8 * (7 - i)));
  CHECK(dbc.messages[0].signals[0].value(data) == 4);
  CHECK(dbc.messages[0].signals[1].value(data) == -0.1);
}

TEST_CASE("dbc: multiplexed signals are there for one value of the multiplexer") {
  const Dbc dbc = parsed(
      "BO_ 1 M: 2 X\n SG_ which M : 0|8@1+ (1,0) [0|0] \"\" X\n SG_ three m3 : 8|8@1+ (1,0) [0|0] \"\" X\n"
      " SG_ always : 8|8@1+ (1,0) [0|0] \"\" X\n");
  const DbcMessage& message = dbc.messages[0];
  CHECK(message.holds(message.signals[1], bytes({3, 0})));
  CHECK_FALSE(message.holds(message.signals[1], bytes({4, 0})));
  CHECK_FALSE(message.holds(message.signals[1], bytes({})));  // too short to tell
  CHECK(message.holds(message.signals[2], bytes({4, 0})));
}

TEST_CASE("dbc: extended multiplexing goes by ranges, level by level") {
  const Dbc dbc = parsed(
      "BO_ 2024 OBD: 8 X\n SG_ service M : 15|8@0+ (1,0) [0|0] \"\" X\n"
      " SG_ pid m65M : 23|8@0+ (1,0) [0|0] \"\" X\n SG_ speed m13 : 31|8@0+ (1,0) [0|0] \"km/h\" X\n"
      "SG_MUL_VAL_ 2024 pid service 65-65;\nSG_MUL_VAL_ 2024 speed pid 13-13, 20-22;\n");
  const DbcMessage& message = dbc.messages[0];
  const DbcSignal& speed = message.signals[2];
  CHECK(message.holds(speed, bytes({3, 0x41, 13, 50, 0, 0, 0, 0})));
  CHECK(message.holds(speed, bytes({3, 0x41, 21, 50, 0, 0, 0, 0})));
  CHECK_FALSE(message.holds(speed, bytes({3, 0x41, 14, 50, 0, 0, 0, 0})));
  CHECK_FALSE(message.holds(speed, bytes({3, 0x42, 13, 50, 0, 0, 0, 0})));
}

TEST_CASE("dbc: signals that editors keep without a message are passed over") {
  CHECK(parsed("BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 X\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\n"
               "BO_ 1 M: 1 X\n")
            .messages.size() == 1);
}

TEST_CASE("dbc: what is wrong is told with its place") {
  const auto check = [](const std::string& text, const std::string& message) {
    CHECK_THROWS_MATCHES(parsed(text), InputError, Message("car.dbc:" + message));
  };
  const std::string head = "BO_ 170 WHEELS: 8 ECU\n";
  check("", " no message (a line 'BO_ ...'): this is no DBC file");
  check("BO_ x", "1:5: BO_: expected the message's id, got 'x'");
  check("BO_ 170 WHEELS 8", "1:16: BO_ WHEELS: expected ':', got '8'");
  check("BO_ 170 WHEELS: 9999 X", "1:5: BO_ WHEELS: a length of 9999 bytes is more than a message can have");
  check("BO_ 2048 WHEELS: 8 X",
        "1:5: BO_ WHEELS: no frame can have the id 2048: standard ids are at most 2047; an extended "
        "id is written with 2147483648 added");
  check(head + "BO_ 170 OTHER: 8 X", "2:5: BO_ OTHER: the id 170 is already used by WHEELS in line 1");
  check(head + "BO_ 171 WHEELS: 8 X",
        "2:5: BO_ WHEELS: the name is already used by the message in line 1; rename one");
  check("SG_ S : 0|8@1+ (1,0) [0|0] \"\" X", "1:5: SG_: a signal before the first message (BO_)");
  check(head + " SG_ S : 0;8@1+ (1,0) [0|0] \"\" X",
        "2:11: SG_ S: expected '|', got ';8@1+ (1,0) [0|0] \"\"'");
  check(head + " SG_ S : 0|8@2+ (1,0) [0|0] \"\" X",
        "2:10: SG_ S: the byte order is 2: it must be 0 (Motorola) or 1 (Intel)");
  check(head + " SG_ S : 0|8@1 (1,0)", "2:16: SG_ S: expected '+' (unsigned) or '-' (signed), got '(1,0)'");
  check(head + " SG_ S : 0|8@1+ (nan,0) [0|0] \"\" X",
        "2:18: SG_ S: expected the factor, got 'nan,0) [0|0] \"\" X'");
  check(head + " SG_ S : 0|8@1+ (1,0) [0|0] \"m X", "2:29: SG_ S: the text's closing '\"' is missing");
  check(head + " SG_ S : 0|8@1+ (1,0) [0|0]",
        "2:28: SG_ S: expected the unit in quotes, got the end of the line");
  check(head + " SG_ S q : 0|8@1+ (1,0) [0|0] \"\" X",
        "2:8: SG_ S: 'q' is no multiplexing: expected 'M', 'm3' or 'm3M'");
}

TEST_CASE("dbc: a signal that cannot be read spoils only itself") {
  const auto check = [](const std::string& text, const std::string& trouble) {
    std::string found;
    const Dbc dbc = parsed(text);
    for (const DbcSignal& signal : dbc.messages.at(0).signals) {
      if (found.empty()) found = signal.trouble;
    }
    CHECK(found == "car.dbc:" + trouble);
  };
  const std::string head = "BO_ 170 WHEELS: 8 ECU\n";
  check(head + " SG_ S : 0|65@1+ (1,0) [0|0] \"\" X",
        "2:10: SG_ S: a length of 65 bits: there may be 1 to 64");
  check(head + " SG_ S : 60|8@1+ (1,0) [0|0] \"\" X",
        "2:10: SG_ S: start 60 and length 8 do not fit into the 8 bytes of WHEELS; correct one of them");
  check(head + " SG_ S : 4294967295|8@1+ (1,0) [0|0] \"\" X",
        "2:10: SG_ S: start 4294967295 and length 8 do not fit into the 8 bytes of WHEELS; correct one of "
        "them");
  check(head + " SG_ S : 56|9@0+ (1,0) [0|0] \"\" X",
        "2:10: SG_ S: start 56 and length 9 do not fit into the 8 bytes of WHEELS; correct one of them");
  check(head + " SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\n SG_ S : 8|8@1+ (1,0) [0|0] \"\" X",
        "3:6: SG_ S: WHEELS already has a signal of this name in line 2");
  check(head + " SG_ S m3 : 0|8@1+ (1,0) [0|0] \"\" X",
        "2:1: SG_ S: the signal is multiplexed, but WHEELS has no multiplexer (M)");
  check(head +
            " SG_ A M : 0|8@1+ (1,0) [0|0] \"\" X\n SG_ B m1M : 8|8@1+ (1,0) [0|0] \"\" X\n"
            " SG_ C m2 : 16|8@1+ (1,0) [0|0] \"\" X\n",
        "4:1: SG_ C: WHEELS has several multiplexers: a line SG_MUL_VAL_ must say which one is meant");
  check(head +
            " SG_ A m1M : 0|8@1+ (1,0) [0|0] \"\" X\n SG_ B m1M : 8|8@1+ (1,0) [0|0] \"\" X\n"
            "SG_MUL_VAL_ 170 A B 1-1;\nSG_MUL_VAL_ 170 B A 1-1;\n",
        "2:1: SG_ A: its multiplexers depend on each other in a circle");
  check(head + " SG_ A : 0|8@1+ (1,0) [0|0] \"\" X\nSG_MUL_VAL_ 170 A B 1-1;",
        "3:19: SG_MUL_VAL_: WHEELS has no signal 'B' to multiplex A");
  check(head + " SG_ A : 0|8@1+ (1,0) [0|0] \"\" X\nSIG_VALTYPE_ 170 A : 1;",
        "3:14: SIG_VALTYPE_: A has 8 bits, a float has 32");
}

TEST_CASE("dbc: units as DBC files write them") {
  CHECK(known_unit("kph") == "km/h");
  CHECK(known_unit("KM/H") == "km/h");
  CHECK(known_unit("°/s") == "deg/s");
  CHECK(known_unit("m/s²") == "m/s^2");
  CHECK(known_unit("G") == "g");
  CHECK(known_unit("furlong").empty());
}

}  // namespace dbc_test

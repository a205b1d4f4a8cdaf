// Logs of CAN frames by Vector and PEAK, several DBC files, and messages that need none.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/can/can_log.hpp>
#include <waymark/formats/text/stamp_text.hpp>

#include "logs/can/candump_frames.hpp"
#include "logs/log_pieces.hpp"

namespace can_layouts_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

namespace {

/// A request for the vehicle's speed without a DBC.
LogRequest speed_request(const std::string& signal = "OBD2.VehicleSpeed") {
  LogRequest request;
  request.stream = StreamKind::odometry;
  request.readings = odometry_channels();
  request.time_scale = TimeScale::unix_time;
  request.columns["speed"] = {signal, "", ""};
  return request;
}

LogData read(const std::string& format, const std::string& text, const LogRequest& request) {
  const CanLogReader reader(format);
  CHECK(reader.recognise(text).certainty > 0.5);
  return reader.read(text, "car.log", request);
}

std::vector<std::string> stamps_of(const LogData& data) {
  std::vector<std::string> result;
  for (const Stamp stamp : data.readings.stamps) result.push_back(decimal_seconds(stamp));
  return result;
}

std::vector<double> speeds_of(const LogData& data) {
  std::vector<double> result;
  for (std::size_t i = 0; i < data.readings.size(); ++i) result.push_back(data.readings.at(i, 0));
  return result;
}

using Texts = std::vector<std::string>;

// 41 0D 24: 0x24 = 36 km/h = 10 m/s; 0x48 = 20 m/s.
// 2021-07-26 10:14:15 UTC is 1627294455 s (date -u -d).
const Texts kStamps{"1627294455.015991000", "1627294456.016000000"};
const std::vector<double> kSpeeds{10, 20};

}  // namespace

TEST_CASE("can layouts: a frame of PEAK begins with its number, so a word and zeros are none") {
  const CanLogReader reader("trc");
  CHECK(reader.recognise("vertex_se2 0 0 0 0\nvertex_se2 1 1 0 0\n").certainty == 0);
  CHECK(reader.recognise("1) 0.5 7E8 3 41 0D 24\n2) 1.5 7E8 3 41 0D 48\n").certainty > 0.5);
}

TEST_CASE("asc: frames of Vector's logs, whose date is the origin of their seconds") {
  const std::string log =
      "date Mon Jul 26 10:14:15.000 am 2021\n"
      "base hex  timestamps absolute\n"
      "internal events logged\n"
      "// version 9.0.0\n"
      "Begin Triggerblock Mon Jul 26 10:14:15.000 am 2021\n"
      "   0.000000 Start of measurement\n"
      "   0.010000 1  Statistic: D 4 R 0 XD 0 XR 0 E 0 O 0 B 0.5%\n"
      "   0.015991 1  7E8             Rx   d 8 03 41 0D 24 00 00 00 00  Length = 245910 BitCount = 127 ID = 2024\n"
      "   0.500000 1  7DF             Tx   d 8 02 01 0D 00 00 00 00 00\n"
      "   0.600000 1  ErrorFrame\n"
      "   0.700000 1  7E8             Rx   r\n"
      "   0.800000 L1 2A              Rx     2 01 02\n"
      "   1.016000 1  7E8             Rx   d 8 03 41 0D 48 00 00 00 00\n"
      "End TriggerBlock\n";
  const LogData data = read("asc", log, speed_request());
  CHECK(stamps_of(data) == kStamps);
  CHECK(speeds_of(data) == kSpeeds);
  CHECK(data.corrupt == 0);
  CHECK(data.kinds.at("error frames") == 1);
  CHECK(data.kinds.at("remote frames") == 1);
  CHECK_THAT(data.notes.at(1),
             Contains("Mon Jul 26 10:14:15.000 am 2021, which is local time without a zone"));
  CHECK(data.notes.at(2) == "car.log: no DBC is stated: the messages of OBD-II and J1939 are known");
}

TEST_CASE("asc: decimal numbers, relative stamps, German dates, CAN FD") {
  const std::string head = "date Mon Jul 26 10:14:15 2021\n";
  CHECK(stamps_of(read("asc",
                       head + "base dec  timestamps relative\n"
                              "   0.015991 1  2024            Rx   d 8 3 65 13 36 0 0 0 0\n"
                              "   0.500000 1  100             Rx   d 1 255\n"
                              "   0.500009 1  2024            Rx   d 8 3 65 13 72 0 0 0 0\n",
                       speed_request())) == kStamps);
  const LogData flexible =
      read("asc",
           "date Son Okt 31 12:00:00.000 2021\nbase hex  timestamps absolute\n"
           "0.015991 CANFD   1 Rx  7E8                1 0 8  8 03 41 0D 24 00 00 00 00 0 0\n"
           "1.016000 CANFD   1 Rx  7E8  OBD_Answer    1 0 8  8 03 41 0D 48 00 00 00 00 0 0\n",
           speed_request());
  CHECK(speeds_of(flexible) == kSpeeds);
  CHECK(stamps_of(flexible).front() == "1635681600.015991000");  // 2021-10-31 12:00 UTC, by date
  // python-can's head has the time of the conversion; its block has that of the first frame.
  const LogData converted = read("asc",
                                 "date Tue Nov 24 11:37:31.201 AM 2026\nbase hex  timestamps absolute\n"
                                 "Begin Triggerblock Mon Jul 26 10:14:15.000 AM 2021\n"
                                 " 0.000000 Start of measurement\n"
                                 " 0.015991 1  7E8             Rx   d 8 03 41 0D 24 00 00 00 00\n",
                                 speed_request());
  CHECK(stamps_of(converted).front() == kStamps.front());
  const LogData undated = read("asc",
                               "base hex timestamps absolute\n"
                               "0.015991 1  7E8             Rx   d 8 03 41 0D 24 00 00 00 00\n",
                               speed_request());
  CHECK(stamps_of(undated) == Texts{"0.015991000"});
  CHECK_THAT(undated.notes.at(1), Contains("no date"));
}

TEST_CASE("asc: what is wrong with a line is said with its place") {
  const LogData data = read("asc",
                            "base hex timestamps absolute\n"
                            "0.1 1  7E8             Rx   d 8 03 41 0D 24 00 00 00 00\n"
                            "0.2 1  WheelSpeed      Rx   d 8 03 41 0D 24 00 00 00 00\n"
                            "0.3 1  7E8             Rx   d 8 03 41 0D\n"
                            "0.4 1  7E8             Rx   d 8 03 41 0D 24 00 00 00 00\n"
                            "0.5 1  7E8             Rx   d 8 03 41 0D 24 00 00 00 00\n",
                            speed_request());
  REQUIRE(data.corrupt == 2);
  CHECK_THAT(data.corrupt_examples.at(0), Contains("car.log:3:8: the id is no number"));
  CHECK_THAT(data.corrupt_examples.at(1), Contains("car.log:4:32: fewer bytes than the stated length"));
}

TEST_CASE("trc: frames of PEAK's logs of every version") {
  // 44403 days after 1899-12-30 is 2021-07-26; 10:14:15 is 0.42656250 of a day.
  const std::string start = ";$STARTTIME=44403.4265625\n";
  const auto [version, first, second] = GENERATE(table<std::string, std::string, std::string>({
      {"", "     1)     16 07E8  8  03 41 0D 24 00 00 00 00",
       "     2)   1016 07E8  8  03 41 0D 48 00 00 00 00"},
      {";$FILEVERSION=1.1\n", "     1)        15.991  Rx         07E8  8  03 41 0D 24 00 00 00 00",
       "     2)      1016.000  Rx         07E8  8  03 41 0D 48 00 00 00 00"},
      {";$FILEVERSION=1.2\n", "     1)        15.991 1  Rx         07E8  8  03 41 0D 24 00 00 00 00",
       "     2)      1016.000 1  Rx         07E8  8  03 41 0D 48 00 00 00 00"},
      {";$FILEVERSION=1.3\n", "     1)        15.991 1  Rx        07E8 -  8    03 41 0D 24 00 00 00 00",
       "     2)      1016.000 1  Rx        07E8 -  8    03 41 0D 48 00 00 00 00"},
      {";$FILEVERSION=2.0\n", "      1        15.991 DT     07E8 Rx 8  03 41 0D 24 00 00 00 00",
       "      2      1016.000 DT     07E8 Rx 8  03 41 0D 48 00 00 00 00"},
      {";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n",
       "      1        15.991 DT 1      07E8 Rx -  8    03 41 0D 24 00 00 00 00",
       "      2      1016.000 FD 1      07E8 Rx -  9    03 41 0D 48 00 00 00 00 00 00 00 00"},
  }));
  const std::string log =
      version + start + ";\n;   Start time: 26.07.2021 10:14:15.000.0\n" + first + "\n" + second + "\n";
  CAPTURE(log);
  const LogData data = read("trc", log, speed_request());
  CHECK(speeds_of(data) == kSpeeds);
  CHECK(data.corrupt == 0);
  if (version.empty())
    CHECK(stamps_of(data) == Texts{"1627294455.016000000", "1627294456.016000000"});
  else
    CHECK(stamps_of(data) == kStamps);
}

TEST_CASE("trc: warnings, errors, remote frames and status lines are no frames of data") {
  const LogData old = read("trc",
                           ";$FILEVERSION=1.1\n"
                           "1)  1.0  Rx     07E8  8  03 41 0D 24 00 00 00 00\n"
                           "2)  2.0  Warng  FFFFFFFF  4  00 00 00 08  BUSHEAVY\n"
                           "3)  3.0  Error  0001  5  00 00 00 00 00\n"
                           "4)  4.0  Rx     07E8  8  RTR\n",
                           speed_request());
  CHECK(old.kinds.at("remote frames") == 1);
  CHECK(old.kinds.at("error frames") == 1);
  CHECK(speeds_of(old) == std::vector<double>{10});
  const LogData data = read("trc",
                            ";$FILEVERSION=2.0\n"
                            "1  1.0 DT 07E8 Rx 8 03 41 0D 24 00 00 00 00\n"
                            "2  2.0 ST      Rx 4 00 00 00 00\n"
                            "3  3.0 ER      Rx 5 04 00 02 00 00\n"
                            "4  4.0 RR 07E8 Rx 8\n",
                            speed_request());
  CHECK(data.kinds.at("remote frames") == 1);
  CHECK(data.kinds.at("error frames") == 1);
  CHECK(data.corrupt == 0);
}

TEST_CASE("trc: a head without a column of times leaves no frame with a stamp") {
  CHECK_THROWS_MATCHES(
      CanLogReader("trc").read(";$COLUMNS=N,T,B,I,d,R,L,D\n1 DT 1 07E8 Rx - 8 03 41 0D 24 00 00 00 00\n",
                               "car.log", speed_request()),
      InputError,
      Catch::Matchers::Message("car.log: none of 1 records could be used; first: car.log:2:1: '' is no "
                               "time in decimal seconds"));
}

TEST_CASE("can: speed of OBD-II and J1939 without a DBC") {
  // J1939-71 by hand: CCVS1 bytes 2 and 3, 1/256 km/h a bit: 0x2400 = 36 km/h. Sender 00, priority 6.
  // FF: not available. VDC2 bytes 4 and 5, 1/8192 rad/s a bit from -3.92.
  LogRequest request = speed_request("WheelBasedVehicleSpeed");
  request.columns["yaw_rate"] = {"YawRate", "", ""};
  const LogData data = read("candump",
                            "(1.0) can0 18FEF100#FF0024FFFFFFFFFF\n"
                            "(1.1) can0 18F0090B#FFFFFF727DFFFFFF\n"
                            "(1.2) can0 18FEF100#FFFFFFFFFFFFFFFF\n"
                            "(1.3) can0 0CFEF127#FF0048FFFFFFFFFF\n",
                            request);
  REQUIRE(data.readings.size() == 4);
  CHECK(data.readings.at(0, 0) == 10);
  CHECK(data.readings.at(1, 1) == Approx(0x7D72 / 8192.0 - 3.92));
  CHECK(std::isnan(data.readings.at(2, 0)));
  CHECK(data.readings.at(3, 0) == 20);
  CHECK_THAT(
      fmt::format("{}", fmt::join(data.notes, "\n")),
      Contains("speed: 1 values of signal WheelBasedVehicleSpeed are outside its range or not available"));
  CHECK(speeds_of(read("candump", "(1.0) can0 18DAF110#03410D2400000000\n",
                       speed_request("OBD2_EXTENDED.VehicleSpeed"))) == std::vector<double>{10});
}

TEST_CASE("can: a DBC of J1939 holds for every sender, an exact id comes before") {
  // 18FEF1FE + 80000000 = 2566844926: the null address. 18FEF103 + 80000000 = 2566844675: one sender.
  LogRequest request = speed_request("ANY.V");
  request.companions["dbc"] = {{"truck.dbc",
                                "BO_ 2566844926 ANY: 8 X\n SG_ V : 8|16@1+ (0.00390625,0) [0|0] \"km/h\" X\n"
                                "BO_ 2566844675 OTHER: 8 X\n SG_ W : 8|16@1+ (1,0) [0|0] \"km/h\" X\n"}};
  const LogData data = read("candump",
                            "(1.0) can0 18FEF100#FF0024FFFFFFFFFF\n"
                            "(1.1) can0 18FEF103#FF0048FFFFFFFFFF\n",
                            request);
  CHECK(speeds_of(data) == std::vector<double>{10});
  CHECK(data.kinds.at("OTHER") == 1);
}

TEST_CASE("can: the messages of the standards stand behind those of a DBC file") {
  LogRequest request = speed_request("OBD2.VehicleSpeed");
  request.columns["yaw_rate"] = {"R", "", ""};
  request.companions["dbc"] = {{"gyro.dbc", "BO_ 17 GYRO: 2 X\n SG_ R : 0|8@1+ (0.1,0) [0|0] \"rad/s\" X\n"}};
  const std::string log = "(1.0) can0 7E8#03410D2400000000\n(1.0) can0 011#0200\n";
  const LogData data = read("candump", log, request);
  CHECK(data.readings.at(0, 0) == 10);
  CHECK(data.readings.at(1, 1) == Approx(0.2));
  // A file that has the id, or the name, comes first.
  request.columns["speed"] = {"VehicleSpeed", "", ""};
  request.companions["dbc"] = {{"car.dbc",
                                "BO_ 2024 OBD: 8 X\n SG_ VehicleSpeed : 24|8@1+ (1,0) [0|0] \"m/s\" X\n"
                                "BO_ 17 GYRO: 2 X\n SG_ R : 0|8@1+ (0.1,0) [0|0] \"rad/s\" X\n"}};
  CHECK(read("candump", log, request).readings.at(0, 0) == 36);
}

TEST_CASE("can: several DBC files are one, and what two of them define differently stays apart by name") {
  LogRequest request = speed_request("V");
  const CompanionFile wheels{"wheels.dbc", "BO_ 16 WHEELS: 2 X\n SG_ V : 0|8@1+ (1,0) [0|0] \"m/s\" X\n"};
  const CompanionFile gyro{"gyro.dbc", "BO_ 17 GYRO: 2 X\n SG_ R : 0|8@1+ (0.1,0) [0|0] \"rad/s\" X\n"};
  const CompanionFile other{"other.dbc", "BO_ 16 COUNT: 2 X\n SG_ N : 8|8@1+ (2,0) [0|0] \"m/s\" X\n"};
  request.columns["yaw_rate"] = {"R", "", ""};
  request.companions["dbc"] = {wheels, gyro, wheels};
  const std::string log = "(1.0) can0 010#0507\n(1.0) can0 011#0200\n";
  const LogData data = read("candump", log, request);
  CHECK(data.readings.at(0, 0) == 5);
  CHECK(data.readings.at(1, 1) == Approx(0.2));
  request.companions["dbc"] = {wheels, gyro, other};
  request.columns["wheel_speed_rear_left"] = {"N", "", ""};
  const LogData both = read("candump", log, request);
  CHECK(both.kinds.at("WHEELS") == 1);
  CHECK(both.kinds.at("COUNT") == 1);
  request.companions["dbc"] = {wheels};
  CHECK_THROWS_MATCHES(read("candump", log, request), InputError,
                       Message("car.log: yaw_rate: wheels.dbc has no signal 'R'; did you mean 'V'?"));
}

}  // namespace can_layouts_test

// No recording is among the data: messages are the examples of NovAtel's manual (OEM7 Commands and Logs;
// support article "ASCII to binary log conversion"), and ones made by hand from its tables.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/novatel/novatel.hpp>
#include <waymark/formats/logs/detail/novatel/novatel_message.hpp>

#include "logs/log_pieces.hpp"

namespace novatel_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

const std::string kManualBestpos =
    "#BESTPOSA,COM1,0,47.0,FINESTEERING,1803,27504.000,00000000,6145,9603;SOL_COMPUTED,L1_FLOAT,32."
    "81519645735,"
    "35.00791046612,19.9359,20.3000,WGS84,0.0363,0.0538,0.0956,\"0\",3.000,0.000,18,9,9,0,0,00,00,01*"
    "ecbd3409\r\n";
const std::string kManualBestgnsspos =
    "#BESTGNSSPOSA,USB1,0,65.0,FINESTEERING,2209,487877.000,02000020,c292,16809;SOL_COMPUTED,PPP,51."
    "15043712234,"
    "-114.03067870773,1097.3556,-17.0001,WGS84,0.0176,0.0123,0.0317,\"TSTR\",17.000,0.000,42,38,38,37,00,00,"
    "3f,37"
    "*5fea7d4b\r\n";
const std::string kManualBestvel =
    "#BESTVELA,USB1,0,57.5,FINESTEERING,2209,502223.000,02000020,10a2,16809;SOL_COMPUTED,PPP,0.250,13.000,0."
    "0025,"
    "28.358727,0.0021,0*e9418656\r\n";
const std::string kManualInspvax =
    "#INSPVAXA,USB1,0,65.5,FINESTEERING,2209,490782.000,02000020,46eb,16809;INS_SOLUTION_GOOD,INS_PPP,51."
    "15043710672,"
    "-114.03067871892,1097.3598,-17.0001,-0.0016,0.0002,0.0029,-0.308665944,0.297893298,157.960833016,0.1816,"
    "0.1816,"
    "0.1808,0.0018,0.0018,0.0016,0.0292,0.0292,0.0582,13000045,0*a74644a2\r\n";
const std::string kManualInspva =
    "#INSPVAA,USB1,0,67.5,FINESTEERING,2209,490558.000,02000020,18bc,16809;2209,490558.000000000,51."
    "15043714042,"
    "-114.03067871718,1080.3548,0.0051,-0.0014,-0.0012,-0.296402993,0.311887972,157.992156267,INS_SOLUTION_"
    "GOOD"
    "*cc698020\r\n";
const std::string kManualInspvas =
    "%INSPVASA,2209,490712.000;2209,490712.000000000,51.15043713712,-114.03067872932,1080.3580,0.0014,-0."
    "0007,0.0015,"
    "-0.293782412,0.302470613,157.989827209,INS_SOLUTION_GOOD*a87ab88b\r\n";

/// A message with its checksum, by the algorithm as the manual prints it.
std::string message(const std::string& text) {
  std::uint32_t crc = 0;
  for (const char c : text.substr(1)) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  char digits[10];
  std::snprintf(digits, sizeof digits, "*%08x", crc);
  return text + digits + "\r\n";
}

std::string bestpos(const std::string& seconds, const std::string& body,
                    const std::string& status = "FINESTEERING") {
  return message("#BESTPOSA,COM1,0,47.0," + status + ",1803," + seconds + ",00000000,6145,9603;" + body);
}
const std::string kBody = "SOL_COMPUTED,SINGLE,32.5,35.25,20,10,WGS84,3,2,4,\"\",0,0,18,9,9,0,0,00,00,01";

std::string bestvel(const std::string& seconds, const std::string& body) {
  return message("#BESTVELA,COM1,0,47.0,FINESTEERING,1803," + seconds + ",00000000,6145,9603;" + body);
}

LogData decode(const std::string& text, const LogRequest& request = {}) {
  const auto decoder = NovatelReader().open("run.log", request);
  decoder->take(text);
  decoder->finish();
  return decoder->data();
}

LogRequest truth() {
  LogRequest request;
  request.stream = StreamKind::truth;
  return request;
}

std::string first_complaint(const std::string& text) {
  return decode(text).corrupt_examples.at(0);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

}  // namespace

TEST_CASE("novatel by specification: BESTPOS of the manual") {
  const LogData data = decode(kManualBestpos);
  REQUIRE(data.fixes.size() == 1);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.stamp.nanoseconds == (1803LL * 604800 + 27504) * kSecond);
  CHECK(fix.latitude_deg == 32.81519645735);
  CHECK(fix.longitude_deg == 35.00791046612);
  CHECK(fix.height_m == Approx(19.9359 + 20.3));
  CHECK(fix.covariance_en(0, 0) == Approx(0.0538 * 0.0538));  // longitude
  CHECK(fix.covariance_en(1, 1) == Approx(0.0363 * 0.0363));
  CHECK(!fix.speed_mps);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"BESTPOSA", 1}});
  CHECK(data.notes == std::vector<std::string>{"run.log: positions by type: 1 L1_FLOAT"});
}

TEST_CASE(
    "novatel by specification: heights of BESTGNSSPOS, INSPVAX and INSPVA in the manual are one antenna's") {
  // Within five centimetres above the ellipsoid, although the first two are given above the geoid.
  CHECK(decode(kManualBestgnsspos).fixes.at(0).height_m == Approx(1080.3555));
  CHECK(decode(kManualInspvax, truth()).truth.at(0).height_m == Approx(1080.3597));
  CHECK(decode(kManualInspva, truth()).truth.at(0).height_m == 1080.3548);
  CHECK(decode(kManualInspvas, truth()).truth.at(0).height_m == 1080.358);
}

TEST_CASE("novatel by specification: the azimuth, clockwise from north, becomes a heading") {
  const LogData data = decode(kManualInspvax, truth());
  CHECK(*data.truth.at(0).heading_rad == Approx((90 - 157.960833016) * std::numbers::pi / 180));
  CHECK(*decode(kManualInspva, truth()).truth.at(0).heading_rad ==
        Approx((90 - 157.992156267) * std::numbers::pi / 180));
  const std::string west = message(
      "#INSPVAA,COM1,0,0,FINE,2209,490558.000,0,0,0;2209,490558.123456789,51,-114,1080,0,0,0,0,0,315,INS_"
      "SOLUTION_FREE");
  const LogData fine = decode(west, truth());
  CHECK(*fine.truth.at(0).heading_rad == Approx(3 * std::numbers::pi / 4));
  CHECK(fine.truth.at(0).stamp.nanoseconds == (2209LL * 604800 + 490558) * kSecond + 123'456'789);
}

TEST_CASE("novatel by specification: an inertial velocity has its sigmas") {
  const std::string text = message(
      "#INSPVAXA,USB1,0,65.5,FINESTEERING,2209,490782.000,02000020,46eb,16809;INS_SOLUTION_GOOD,INS_RTKFIXED,"
      "51,-114,"
      "1097,-17,4,3,0,0,0,36,0.2,0.1,0.3,0.05,0.05,0.05,1,1,1,0,0");
  const GeodeticFix fix = decode(text).fixes.at(0);
  CHECK(*fix.speed_mps == Approx(5));
  CHECK(*fix.course_rad == Approx(std::atan2(3, 4)));
  CHECK(*fix.speed_sigma_mps == Approx(0.05));
  CHECK(*fix.course_sigma_rad == Approx(0.01));
  CHECK(fix.covariance_en(0, 0) == Approx(0.01));
}

TEST_CASE("novatel by specification: the velocity of a position's time may stand before or behind it") {
  const std::string speed = "SOL_COMPUTED,DOPPLER_VELOCITY,0.150,0.000,5,90,0,0";
  const LogData data = decode(bestpos("10.0", kBody) + bestvel("10.0", speed) + bestvel("11.0", speed) +
                              bestpos("11.0", kBody) + bestpos("12.0", kBody) + bestvel("12.5", speed) +
                              bestpos("13.0", kBody));
  REQUIRE(data.fixes.size() == 4);
  CHECK(*data.fixes[0].speed_mps == 5);
  CHECK(*data.fixes[0].course_rad == Approx(std::numbers::pi / 2));
  CHECK(data.fixes[1].speed_mps);
  CHECK(!data.fixes[2].speed_mps);
  CHECK(!data.fixes[3].speed_mps);
  CHECK(data.records == 4);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"BESTPOSA", 4}, {"BESTVELA", 3}});
  CHECK(data.notes.at(1) ==
        "run.log: BESTVEL states latencies up to 0.15 s: its speeds and courses are up to that much "
        "older than their fixes");
}

TEST_CASE("novatel by specification: the best kind of position is read, from its first message on") {
  const std::string text = kManualBestpos + kManualBestgnsspos + kManualBestpos + kManualInspvax;
  const LogData fixes = decode(text);
  REQUIRE(fixes.fixes.size() == 2);
  CHECK(fixes.fixes[1].latitude_deg == 51.15043712234);
  CHECK(fixes.kinds ==
        std::map<std::string, std::size_t>{{"BESTGNSSPOSA", 1}, {"BESTPOSA", 2}, {"INSPVAXA", 1}});
  const LogData reference = decode(text + kManualInspva, truth());
  REQUIRE(reference.truth.size() == 3);
  CHECK(!reference.truth[1].heading_rad);
  CHECK(reference.truth[2].heading_rad);
}

TEST_CASE("novatel by specification: without a solution or a time there is no fix") {
  const LogData data = decode(bestpos("10.0", replaced(kBody, "SOL_COMPUTED", "INSUFFICIENT_OBS")) +
                              bestpos("11.0", replaced(kBody, "SINGLE", "NONE")) +
                              bestpos("12.0", kBody, "UNKNOWN") + bestpos("13.0", kBody));
  CHECK(data.fixes.size() == 1);
  CHECK(data.without_fix == 3);
  CHECK(data.corrupt == 0);
  CHECK(data.notes == std::vector<std::string>{
                          "run.log: positions by type: 1 SINGLE",
                          "run.log: 1 positions of a receiver that does not know the time yet were skipped",
                          "run.log: 3 of 4 records are marked as without a fix"});
}

TEST_CASE("novatel: what else stands in the log is passed over and counted") {
  const LogData data = decode("$GPGGA,1\n" + kManualBestpos + message("#RANGEA,COM1,0,1,FINE,1,2,3,4,5;x") +
                              "<BESTPOS COM1 0 47\n\n" + bestpos("1", replaced(kBody, "WGS84", "USER")));
  CHECK(data.fixes.size() == 2);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"BESTPOSA", 2}, {"RANGEA", 1}});
  CHECK(data.notes ==
        std::vector<std::string>{"run.log: 1 lines are abbreviated ASCII (`<BESTPOS`), which has no checksum "
                                 "and is not read; let the receiver log BESTPOSA",
                                 "run.log: 1 lines that are no NovAtel messages were skipped",
                                 "run.log: positions by type: 1 L1_FLOAT, 1 SINGLE",
                                 "run.log: positions of datum 'USER' are taken as WGS84"});
  CHECK_THROWS_MATCHES(
      decode("<BESTPOS COM1 0 47\n<     SOL_COMPUTED\n"), InputError,
      Message("run.log: 1 lines are abbreviated ASCII (`<BESTPOS`), which has no checksum and is not "
              "read; let the receiver log BESTPOSA"));
}

TEST_CASE("novatel: the type of a position tells its quality, BESTPOS satellites and age of corrections") {
  const auto told = [](const std::string& type) {
    const std::string body = replaced(replaced(kBody, "SINGLE", type), "\"\",0,0,18,9", "\"\",2.5,0,18,9");
    return decode(bestpos("10", body)).fixes.at(0).told;
  };
  CHECK(told("SINGLE").quality == FixQuality::single);
  CHECK(told("PSRDIFF").quality == FixQuality::differential);
  CHECK(told("WAAS").quality == FixQuality::differential);
  CHECK(told("NARROW_FLOAT").quality == FixQuality::floating);
  CHECK(told("PPP_CONVERGING").quality == FixQuality::floating);
  CHECK(told("NARROW_INT").quality == FixQuality::fixed);
  CHECK(told("INS_RTKFIXED").quality == FixQuality::fixed);
  CHECK(told("PROPAGATED").quality == FixQuality::dead_reckoned);
  CHECK(told("FIXEDHEIGHT").quality == FixQuality::unknown);
  CHECK(told("NARROW_INT").satellites == 9);
  CHECK(told("NARROW_INT").correction_age_s == 2.5);
}

TEST_CASE("novatel: what is wrong with a message is said with its place") {
  CHECK(first_complaint(replaced(kManualBestpos, "32.8", "32.9")) ==
        "run.log:1:1: BESTPOSA: its checksum is ecbd3409, that of its text " + [] {
          const std::string wrong = replaced(kManualBestpos, "32.8", "32.9");
          const std::string right = message(wrong.substr(0, wrong.find('*')));
          return right.substr(right.find('*') + 1, 8);
        }());
  CHECK(first_complaint(kManualBestpos.substr(0, 100)) ==
        "run.log:1:1: BESTPOSA: no checksum: the line is cut off");
  CHECK(first_complaint(message("#BESTPOSA,COM1,0,47.0,FINE,1803")) ==
        "run.log:1:1: BESTPOSA: no ';' ends its header");
  CHECK(first_complaint(message("#BESTPOSA,COM1;1")) == "run.log:1:1: BESTPOSA: its header has no time");
  CHECK(first_complaint(bestpos("10", "SOL_COMPUTED,SINGLE,1,2")) ==
        "run.log:1:86: BESTPOSA: expected 10 fields, got 4");
  CHECK(first_complaint(bestpos("10", replaced(kBody, "32.5", "92.5"))) ==
        "run.log:1:83: BESTPOSA: latitude: 92.5 is outside -90 .. 90");
  CHECK(first_complaint(bestpos("10", replaced(kBody, "35.25", "x"))) ==
        "run.log:1:88: BESTPOSA: longitude: expected a number, got 'x'");
  CHECK(first_complaint(bestpos("700000", kBody)) ==
        "run.log:1:1: BESTPOSA: expected a GPS week and its seconds, got '1803' '700000'");
  const std::string of_no_quality = replaced(kBody, "SINGLE", "FIXEDHEIGHT");
  CHECK(first_complaint(bestpos("10", replaced(of_no_quality, ",3,2,4", ",0,0,0"))) ==
        "run.log:1:111: BESTPOSA: the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'");
  CHECK(first_complaint(bestvel("10", "SOL_COMPUTED,DOPPLER_VELOCITY,0.150,0.000,-5,90,0,0")) ==
        "run.log:1:105: BESTVELA: horizontal speed: -5 is outside 0 .. 1000");
}

TEST_CASE("novatel: a request that it cannot meet is refused") {
  LogRequest request;
  request.stream = StreamKind::odometry;
  CHECK_THROWS_MATCHES(
      decode("", request), InputError,
      Message("run.log: a NovAtel log holds no odometry; it gives the streams gnss and truth"));
}

TEST_CASE("novatel: pieces of any length give the same") {
  const std::string text = kManualBestpos + kManualBestgnsspos + kManualBestvel + "<BESTPOS\n#BESTPOSA,\n" +
                           kManualInspvax + kManualInspva + kManualBestpos.substr(0, 99);
  waymark_test::check_pieces(NovatelReader(), text, "run.log", {});
  waymark_test::check_pieces(NovatelReader(), text, "run.log", truth());
}

TEST_CASE("novatel: it is known by right checksums") {
  const Recognition known =
      NovatelReader().recognise("$GPGGA,1\n" + kManualBestpos + kManualInspva + kManualBestvel);
  CHECK(known.certainty == 0.75);
  CHECK(known.evidence == "3 of 4 lines are NovAtel messages with a right checksum");
  CHECK(NovatelReader().recognise(replaced(kManualBestpos, "32.8", "32.9")).certainty == 0);
  CHECK(NovatelReader().recognise("# a comment, and text\n").certainty == 0);
}

}  // namespace novatel_test

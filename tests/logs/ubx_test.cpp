#include <catch2/catch.hpp>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <string>

#include <waymark/core/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/ubx.hpp>
#include <waymark/formats/text_file.hpp>

#include "logs/ubx_bytes.hpp"
#include "support/paths.hpp"

using namespace waymark;
using namespace waymark_test;
using Catch::Matchers::Message;
using Notes = std::vector<std::string>;

namespace {

LogData read(std::string_view bytes, const LogRequest& request = {}) {
  return UbxReader().read(bytes, "log.ubx", request);
}

std::string pvt_frame(const UbxBytes& pvt) {
  return ubx_frame(0x0107, pvt.bytes());
}

/// What the log says where read() would throw for the want of samples.
LogData decode(std::string_view bytes, const LogRequest& request = {}) {
  const auto decoder = UbxReader().open("log.ubx", request);
  decoder->take(bytes);
  decoder->finish();
  return decoder->data();
}

bool has_note(const LogData& data, const std::string& text) {
  for (const std::string& note : data.notes) {
    if (note == "log.ubx: " + text) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("ubx, by the specification: NAV-PVT") {
  const LogData data = read(pvt_frame(nav_pvt()));
  REQUIRE(data.fixes.size() == 1);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.stamp.nanoseconds == kGps - 250);
  CHECK(fix.latitude_deg == 55.5);
  CHECK(fix.longitude_deg == 12.25);
  CHECK(fix.height_m == 30);
  CHECK(fix.covariance_en.isApprox(Eigen::Matrix2d(2 * Eigen::Matrix2d::Identity())));  // (2 m)^2 / 2
  CHECK(*fix.speed_mps == 10);
  CHECK(*fix.speed_sigma_mps == 0.5);
  CHECK(*fix.course_rad == Approx(std::numbers::pi / 2));
  CHECK(*fix.course_sigma_rad == Approx(std::numbers::pi / 90));
  CHECK(fix.line == 1);
  CHECK(data.records == 1);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"NAV-PVT", 1}});
  CHECK(data.notes == Notes{"log.ubx: positions: 0 of NAV-HPPOSLLH, 1 of NAV-PVT, 0 of NAV-POSLLH",
                            "log.ubx: 1 fixes with hAcc read as drms (not stated)"});
}

TEST_CASE("ubx: stamps come out on the scale asked for, with the offset") {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.time_offset_s = -0.5;
  CHECK(read(pvt_frame(nav_pvt()), request).fixes.at(0).stamp.nanoseconds == kUtc - 250 - 500'000'000);
}

TEST_CASE("ubx: what a stated accuracy means") {
  LogRequest request;
  request.accuracy = AccuracyMeaning::percent95;
  CHECK(read(pvt_frame(nav_pvt()), request).fixes.at(0).covariance_en(0, 0) == Approx(1));
  request.accuracy = AccuracyMeaning::cep50;
  CHECK(read(pvt_frame(nav_pvt()), request).fixes.at(0).covariance_en(1, 1) ==
        Approx(2.885390082));  // 4 / (2 ln 2)
}

TEST_CASE("ubx, by the specification: the covariance of NAV-COV has axes north, east") {
  UbxBytes cov(64);
  cov.u32(0, kItowMs).u8(5, 1).f32(16, 9).f32(20, -1.5F).f32(28, 4);
  const std::string log = pvt_frame(nav_pvt()) + ubx_frame(0x0136, cov.bytes()) + nav_eoe(kItowMs);
  Eigen::Matrix2d east_north;
  east_north << 4, -1.5, -1.5, 9;
  CHECK(read(log).fixes.at(0).covariance_en == east_north);
  CHECK(has_note(read(log), "1 fixes with the covariance of NAV-COV"));

  SECTION("invalid by its flag: hAcc is read") {
    cov.u8(5, 0);
    CHECK(read(pvt_frame(nav_pvt()) + ubx_frame(0x0136, cov.bytes())).fixes.at(0).covariance_en(0, 0) ==
          Approx(2));
  }
  SECTION("not positive definite: hAcc is read, and it is said") {
    for (const float wrong : {6.0F, std::numeric_limits<float>::quiet_NaN()}) {
      cov.f32(20, wrong);
      const LogData data = read(pvt_frame(nav_pvt()) + ubx_frame(0x0136, cov.bytes()));
      CHECK(data.fixes.at(0).covariance_en(0, 0) == Approx(2));
      CHECK(has_note(data, "1 covariances of NAV-COV are not positive definite and were passed over"));
    }
  }
}

TEST_CASE("ubx, by the specification: the best position of an epoch is used") {
  UbxBytes precise(36);
  precise.u32(4, kItowMs)
      .u32(8, 122'500'000)
      .u32(12, 555'000'000)
      .u32(16, 30'000)
      .u8(24, -7)
      .u8(25, 99)
      .u8(26, -9);
  precise.u32(28, 140);
  UbxBytes plain(28);
  plain.u32(0, kItowMs).u32(4, 122'500'001).u32(8, 555'000'001).u32(12, 1).u32(20, 2000);
  const std::string log =
      ubx_frame(0x0102, plain.bytes()) + pvt_frame(nav_pvt()) + ubx_frame(0x0114, precise.bytes());
  const LogData data = read(log);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].latitude_deg == 55.500000099);
  CHECK(data.fixes[0].longitude_deg == 12.249999993);
  CHECK(data.fixes[0].height_m == 29.9991);
  CHECK(data.fixes[0].covariance_en(0, 0) == Approx(0.014 * 0.014 / 2));
  CHECK(data.fixes[0].line == 3);
  CHECK(*data.fixes[0].speed_mps == 10);
  CHECK(has_note(data, "positions: 1 of NAV-HPPOSLLH, 0 of NAV-PVT, 0 of NAV-POSLLH"));
  precise.u8(3, 1);  // invalidLlh
  const LogData without =
      read(ubx_frame(0x0102, plain.bytes()) + pvt_frame(nav_pvt()) + ubx_frame(0x0114, precise.bytes()));
  CHECK(without.fixes.at(0).latitude_deg == 55.5);
}

TEST_CASE("ubx, by the specification: older receivers: NAV-POSLLH, NAV-VELNED and NAV-SOL") {
  UbxBytes plain(28);
  plain.u32(0, kItowMs).u32(4, -1'224'018'416).u32(8, -377'717'234).u32(12, -25'082).u32(20, 600);
  UbxBytes velocity(36);
  velocity.u32(0, kItowMs).u32(20, 1041).u32(24, 22'381'710).u32(28, 8).u32(32, 73'888);
  UbxBytes solution(52);
  solution.u32(0, kItowMs).u32(4, 125'000).u16(8, 2268).u8(10, 3).u8(11, 0x0D);
  const std::string rest = ubx_frame(0x0112, velocity.bytes()) + ubx_frame(0x0106, solution.bytes());
  const LogData data = read(ubx_frame(0x0102, plain.bytes()) + rest);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].stamp.nanoseconds == kGps + 125'000);
  CHECK(data.fixes[0].latitude_deg == -37.7717234);
  CHECK(data.fixes[0].longitude_deg == -122.4018416);
  CHECK(data.fixes[0].height_m == -25.082);
  CHECK(*data.fixes[0].speed_mps == 10.41);
  CHECK(*data.fixes[0].speed_sigma_mps == 0.08);
  CHECK(*data.fixes[0].course_rad == Approx(223.8171 * std::numbers::pi / 180));
  CHECK(*data.fixes[0].course_sigma_rad == Approx(0.73888 * std::numbers::pi / 180));

  SECTION("NAV-STATUS tells of the fix where NAV-SOL does not, NAV-TIMEGPS of the week") {
    UbxBytes status(16);
    status.u32(0, kItowMs).u8(4, 3).u8(5, 0x00);
    UbxBytes week(16);
    week.u32(0, kItowMs).u32(4, -3).u16(8, 2268).u8(11, 0x03);
    const std::string time = ubx_frame(0x0120, week.bytes());
    CHECK(decode(ubx_frame(0x0102, plain.bytes()) + ubx_frame(0x0103, status.bytes()) + time).without_fix ==
          1);
    status.u8(5, 0x01);
    const LogData good = read(ubx_frame(0x0102, plain.bytes()) + ubx_frame(0x0103, status.bytes()) + time);
    CHECK(good.fixes.at(0).stamp.nanoseconds == kGps - 3);
    const LogData stateless = read(ubx_frame(0x0102, plain.bytes()) + time);
    CHECK(has_note(stateless, "1 positions come without a word on the fix and are taken as fixes"));
  }
  SECTION("NAV-TIMEUTC tells the date") {
    UbxBytes utc(20);
    utc.u32(0, kItowMs)
        .u32(8, -7)
        .u16(12, 2023)
        .u8(14, 6)
        .u8(15, 28)
        .u8(16, 14)
        .u8(17, 52)
        .u8(18, 12)
        .u8(19, 0x07);
    CHECK(read(ubx_frame(0x0102, plain.bytes()) + ubx_frame(0x0121, utc.bytes()))
              .fixes.at(0)
              .stamp.nanoseconds == kGps - 7);
  }
}

TEST_CASE("ubx: iTOW goes on over the end of a week") {
  constexpr std::int64_t kWeekMs = 604'800'000;
  const auto position = [](std::int64_t itow_ms) {
    return ubx_frame(0x0102, UbxBytes(28).u32(0, itow_ms).u32(20, 600).bytes());
  };
  UbxBytes week(16);
  week.u32(0, kWeekMs - 1000).u16(8, 2268).u8(11, 0x03);
  const LogData data =
      read(ubx_frame(0x0120, week.bytes()) + position(kWeekMs - 1000) + position(0) + position(1000));
  REQUIRE(data.fixes.size() == 3);
  const std::int64_t next_week = 2269 * kWeekMs * 1'000'000;
  CHECK(data.fixes[0].stamp.nanoseconds == next_week - 1'000'000'000);
  CHECK(data.fixes[1].stamp.nanoseconds == next_week);
  CHECK(data.fixes[2].stamp.nanoseconds == next_week + 1'000'000'000);
  CHECK(has_note(data, "2 epochs without a valid date or week: the week is that of the epochs before"));
}

TEST_CASE("ubx: without a week a position is corrupt, unless one is stated") {
  const std::string log = ubx_frame(0x0102, UbxBytes(28).u32(0, kItowMs).u32(20, 600).bytes());
  CHECK_THROWS_MATCHES(
      read(log), InputError,
      Message("log.ubx: none of 1 records could be used; first: log.ubx:byte 0: neither a valid "
              "date nor a GPS week has come yet; state 'gps_week' to use the positions before"));
  LogRequest request;
  request.gps_week = 2268;
  const LogData data = read(log, request);
  CHECK(data.fixes.at(0).stamp.nanoseconds == kGps);
  CHECK(has_note(data, "the first epochs tell no GPS week, the stated week 2268 is used"));
}

TEST_CASE("ubx: a date whose seconds are not resolved takes those of iTOW") {
  UbxBytes pvt = nav_pvt();
  pvt.u8(11, 0x03).u8(10, 14);  // 16 leap seconds assumed: two seconds late
  const LogData data = read(pvt_frame(pvt));
  CHECK(data.fixes.at(0).stamp.nanoseconds == kGps - 250);
  CHECK(has_note(data,
                 "1 dates are not fully resolved and differ from iTOW by whole seconds; iTOW is followed"));
  pvt.u8(11, 0x07);
  const LogData resolved = read(pvt_frame(pvt));
  CHECK(resolved.fixes.at(0).stamp.nanoseconds == kGps - 250 + 2'000'000'000);
  CHECK(has_note(resolved, "1 dates differ from iTOW by a second or more; the dates are followed"));
}

TEST_CASE("ubx: the leap second of 2016 is an instant of its own on the GPS scale") {
  UbxBytes pvt = nav_pvt();
  pvt.u16(4, 2016).u8(6, 12).u8(7, 31).u8(8, 23).u8(9, 59).u8(10, 60).u32(16, 0);
  // 2016-12-31 was a Saturday: 23:59:60 is 17 s before the end of the week and 86400 + 17 leap seconds in:
  // week 1930 ended.
  const std::int64_t gps = (1'483'228'800LL - 315'964'800 + 17) * 1'000'000'000;
  pvt.u32(0, gps / 1'000'000 % 604'800'000);
  CHECK(read(pvt_frame(pvt)).fixes.at(0).stamp.nanoseconds == gps);
}

TEST_CASE("ubx: dates that are not valid or do not exist fall back on the week") {
  UbxBytes week(16);
  week.u32(0, kItowMs).u16(8, 2268).u8(11, 0x03);
  for (const auto& wrong :
       {nav_pvt().u8(11, 0x01), nav_pvt().u8(11, 0x02), nav_pvt().u8(6, 13), nav_pvt().u8(7, 31),
        nav_pvt().u16(4, 9999), nav_pvt().u8(8, 24), nav_pvt().u32(16, 1'000'000'001)}) {
    CHECK(read(pvt_frame(wrong) + ubx_frame(0x0120, week.bytes())).fixes.at(0).stamp.nanoseconds == kGps);
    CHECK(decode(pvt_frame(wrong)).corrupt == 1);
  }
}

TEST_CASE("ubx: which fixes are fixes") {
  const auto with = [](int type, int flags) { return pvt_frame(nav_pvt().u8(20, type).u8(21, flags)); };
  for (const int type : {0, 5, 6, 255}) CHECK(decode(with(type, 1)).without_fix == 1);
  CHECK(decode(with(3, 0)).without_fix == 1);
  CHECK(decode(pvt_frame(nav_pvt().u8(78, 1))).without_fix == 1);  // flags3: invalidLlh
  const LogData data = read(with(1, 1) + with(2, 1) + with(3, 0x81) + with(4, 0x41) + with(0, 1));
  CHECK(data.fixes.size() == 4);
  CHECK(has_note(data, "1 positions by dead reckoning alone, 1 by GNSS and dead reckoning combined"));
  CHECK(has_note(data, "1 positions with carrier phases fixed, 1 with carrier phases as floats"));
  CHECK(has_note(data, "1 of 5 records are marked as without a fix"));
  CHECK(has_note(data, "4 epochs repeat the iTOW of the one before"));
  CHECK_THROWS_MATCHES(read(with(0, 1)), InputError,
                       Message("log.ubx: not one fix in 1 records (1 are marked as without a fix)"));
}

TEST_CASE("ubx: a position without accuracy takes the stated default, or is corrupt") {
  for (const std::int64_t none : {0LL, 0xFFFFFFFFLL}) {
    const std::string log = pvt_frame(nav_pvt().u32(40, none));
    CHECK(decode(log).corrupt_examples ==
          Notes{"log.ubx:byte 0: no accuracy is given: state 'default_sigma'"});
    LogRequest request;
    request.default_sigma_m = 7;
    const LogData data = read(log, request);
    CHECK(data.fixes.at(0).covariance_en(1, 1) == 49);
    CHECK(has_note(data, "1 fixes give no accuracy, the stated default sigma of 7 m is used"));
  }
}

TEST_CASE("ubx: what is corrupt is told with its place") {
  CHECK(decode(pvt_frame(nav_pvt().u32(28, 900'000'001))).corrupt_examples ==
        Notes{"log.ubx:byte 0: the position 90.0000001, 12.25 is outside -90 .. 90, -180 .. 180"});
  CHECK(decode(pvt_frame(nav_pvt().u32(0, 604'800'000))).corrupt_examples ==
        Notes{"log.ubx:byte 0: iTOW 604800000 ms lies beyond the end of a week"});
  CHECK(decode("junk" + ubx_frame(0x0107, std::string(83, 'x'))).corrupt_examples ==
        Notes{"log.ubx:byte 4: NAV-PVT: 83 bytes, where the message has at least 84"});
  CHECK(decode(ubx_frame(0x0107, "")).corrupt == 0);  // a poll

  std::string wrong = pvt_frame(nav_pvt());
  wrong[30] ^= 1;
  const std::string good = pvt_frame(nav_pvt(1));
  const LogData data = read("$GPGGA,1*00\r\n" + wrong + good);
  CHECK(data.fixes.size() == 1);
  CHECK(data.fixes[0].line == 1);
  CHECK(data.records == 2);
  CHECK(data.corrupt_examples == Notes{"log.ubx:byte 13: NAV-PVT: the checksum is wrong"});
  CHECK(has_note(data, "113 bytes that belong to no UBX frame were passed over"));

  const LogData cut = read(good + good.substr(0, 50));
  CHECK(cut.fixes.size() == 1);
  CHECK(cut.corrupt_examples == Notes{"log.ubx:byte 100: NAV-PVT: the log ends within the message"});
}

TEST_CASE("ubx: a corrupt length swallows no frames") {
  const std::string good = pvt_frame(nav_pvt()) + pvt_frame(nav_pvt(1)) + pvt_frame(nav_pvt(2));
  for (const int length : {93, 200, 8192, 8193, 0xFFFF}) {
    std::string wrong = pvt_frame(nav_pvt());
    wrong[4] = static_cast<char>(length & 0xFF);
    wrong[5] = static_cast<char>(length >> 8);
    const LogData data = read(wrong + good);
    CHECK(data.fixes.size() == 3);
    CHECK(data.corrupt == 1);
    CHECK(data.corrupt_examples.at(0).starts_with("log.ubx:byte 0: NAV-PVT: "));
    if (length > 8192)
      CHECK(data.corrupt_examples[0] == "log.ubx:byte 0: NAV-PVT: a length of " + std::to_string(length) +
                                            " bytes, which no message has");
  }
  // Sync bytes by chance in other binary data are no record: no class of the protocol follows.
  const LogData data = read(std::string("\xB5\xB5\x62\x77\x07\x02\x00", 7) + good + "\xB5");
  CHECK(data.fixes.size() == 3);
  CHECK(data.corrupt == 0);
}

TEST_CASE("ubx: truth has the vehicle's heading where it is valid") {
  LogRequest request;
  request.stream = StreamKind::truth;
  UbxBytes pvt = nav_pvt();
  pvt.u32(84, 3'000'000);
  CHECK(!read(pvt_frame(pvt), request).truth.at(0).heading_rad);
  pvt.u8(21, 0x21);
  const LogData data = read(pvt_frame(pvt), request);
  REQUIRE(data.truth.size() == 1);
  CHECK(data.truth[0].stamp.nanoseconds == kGps - 250);
  CHECK(data.truth[0].height_m == 30);
  CHECK(*data.truth[0].heading_rad == Approx(std::numbers::pi / 3));  // 30 degrees east of north
  pvt.u32(84, 27'000'000);
  CHECK(*read(pvt_frame(pvt), request).truth.at(0).heading_rad == Approx(std::numbers::pi));
}

TEST_CASE("ubx, by the specification: HNR-PVT is read where it is asked for, and then alone") {
  UbxBytes high(72);
  high.u32(0, kItowMs + 100).u16(4, 2023).u8(6, 6).u8(7, 28).u8(8, 14).u8(9, 52).u8(10, 12).u8(11, 7);
  high.u32(12, 100'000'003).u8(16, 4).u8(17, 0x11).u32(20, 10'000'000).u32(24, 20'000'000).u32(28, 4000);
  high.u32(36, 1500).u32(44, 4'500'000).u32(48, 0).u32(52, 3000).u32(60, 100).u32(64, 100'000);
  const std::string log = pvt_frame(nav_pvt()) + ubx_frame(0x2800, high.bytes());
  const LogData navigation = read(log);
  CHECK(navigation.fixes.size() == 1);
  CHECK(has_note(navigation,
                 "1 positions of HNR-PVT, dead-reckoned between the navigation epochs, were passed over "
                 "('position: HNR-PVT' among the columns reads them instead)"));
  LogRequest request;
  request.columns["position"] = {"HNR-PVT", "", ""};
  const LogData data = read(log, request);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].stamp.nanoseconds == kGps + 100'000'003);
  CHECK(data.fixes[0].latitude_deg == 2);
  CHECK(data.fixes[0].longitude_deg == 1);
  CHECK(data.fixes[0].covariance_en(0, 0) == Approx(4.5));
  CHECK(*data.fixes[0].speed_mps == 1.5);
  CHECK(*data.fixes[0].course_rad == Approx(std::numbers::pi / 4));
  CHECK(
      has_note(data,
               "1 positions of HNR-PVT: dead-reckoned on from the last GNSS epoch, so their errors are those "
               "of that epoch and no new ones"));
  request.stream = StreamKind::truth;
  CHECK(*read(log, request).truth.at(0).heading_rad == Approx(std::numbers::pi / 2));
}

TEST_CASE("ubx: what cannot be read at all is an error that says why") {
  CHECK_THROWS_MATCHES(read(""), InputError, Message("log.ubx: the log holds no records"));
  CHECK_THROWS_MATCHES(read("$GPGGA,1*00\r\n"), InputError, Message("log.ubx: the log holds no records"));
  LogRequest request;
  request.columns["time"] = {"t", "", ""};
  CHECK_THROWS_MATCHES(
      read("", request), InputError,
      Message("log.ubx: a UBX log has no column for 'time'; only 'position' may be stated, as "
              "'NAV-PVT' (all navigation messages) or 'HNR-PVT'"));
  request.columns = {{"position", {"NAV-SOL", "", ""}}};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.ubx: 'position' of a UBX log is 'NAV-PVT' (all navigation messages) or "
                               "'HNR-PVT', got 'NAV-SOL'"));
  request.columns.clear();
  request.gps_week = -1;
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.ubx: 'gps_week' -1 is outside 0 .. 10000"));
  request.gps_week = 0;
  request.companions["dbc"] = {"a.dbc", ""};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.ubx: a UBX log takes no 'dbc' file; leave it out"));
}

TEST_CASE("ubx: a log is known by its frames") {
  const auto certainty = [](std::string_view head) { return UbxReader().recognise(head).certainty; };
  const std::string pvt = pvt_frame(nav_pvt());
  CHECK(certainty("") == 0);
  CHECK(certainty("$GPGGA,1*00\r\n") == 0);
  CHECK(certainty(pvt) == Approx(0.9));
  std::string mixed;
  for (int i = 0; i < 3; ++i)
    mixed += "$GPGGA,of,NMEA,there,is,much,more,than,of,UBX" + std::string(900, ',') + pvt;
  CHECK(certainty(mixed) == 1);
  CHECK(UbxReader().recognise(mixed).evidence ==
        "3 UBX frames with a right checksum, 3 of them with a position");
  const std::string silent = nav_eoe(1) + nav_eoe(2) + nav_eoe(3);
  CHECK(certainty(silent + std::string(36, ' ')) == Approx(0.45));
}

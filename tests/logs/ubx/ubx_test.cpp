#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "logs/nmea/nmea_sentences.hpp"
#include "logs/ubx/ubx_epochs.hpp"

namespace ubx_test {

using namespace waymark;
using namespace waymark_test;
using namespace waymark_test::ubx_samples;

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
      CHECK(has_note(data, "1 covariances of NAV-COV are not positive definite and were skipped"));
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
    CHECK(has_note(stateless, "1 positions do not state whether there is a fix and are taken as fixes"));
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

TEST_CASE("ubx: a position without accuracy takes the stated default, else what is usual for its quality") {
  for (const std::int64_t none : {0LL, 0xFFFFFFFFLL}) {
    const std::string log = pvt_frame(nav_pvt().u32(40, none));
    CHECK(read(log).fixes.at(0).covariance_en(1, 1) == 9);
    LogRequest request;
    request.default_sigma_m = 7;
    const LogData data = read(log, request);
    CHECK(data.fixes.at(0).covariance_en(1, 1) == 49);
    CHECK(has_note(data, "1 fixes have no accuracy; the stated default sigma of 7 m is used"));
  }
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
                 "1 positions of HNR-PVT, dead-reckoned between the navigation epochs, were skipped "
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
  CHECK(has_note(data,
                 "1 positions of HNR-PVT are dead-reckoned from the last GNSS epoch and share its error"));
  request.stream = StreamKind::truth;
  CHECK(*read(log, request).truth.at(0).heading_rad == Approx(std::numbers::pi / 2));
}

TEST_CASE("ubx, by the specification: Earth-centred positions and velocities, NAV-POSECEF and NAV-SOL") {
  // 100 m above the equator at 90 degrees east: there east is -x, and north is z.
  UbxBytes position(20);
  position.u32(0, kItowMs).u32(8, 637'823'700).u32(16, 500);
  UbxBytes velocity(20);
  velocity.u32(0, kItowMs).u32(4, -300).u32(12, 400).u32(16, 10);
  UbxBytes week(16);
  week.u32(0, kItowMs).u16(8, 2268).u8(11, 0x03);
  UbxBytes solution(52);
  solution.u32(0, kItowMs).u16(8, 2268).u8(10, 3).u8(11, 0x0D).u32(16, 637'823'700).u32(24, 500);
  solution.u32(28, -300).u32(36, 400).u32(40, 10).u8(47, 9);
  const std::string parts = ubx_frame(0x0101, position.bytes()) + ubx_frame(0x0111, velocity.bytes()) +
                            ubx_frame(0x0120, week.bytes());
  for (const std::string& log : {parts, ubx_frame(0x0106, solution.bytes())}) {
    const LogData data = read(log);
    REQUIRE(data.fixes.size() == 1);
    const GeodeticFix& fix = data.fixes[0];
    CHECK(fix.latitude_deg == Approx(0).margin(1e-9));
    CHECK(fix.longitude_deg == Approx(90).epsilon(1e-12));
    CHECK(fix.height_m == Approx(100).margin(1e-6));
    CHECK(*fix.speed_mps == Approx(5));
    CHECK(*fix.course_rad == Approx(std::atan2(3, 4)));
    CHECK(fix.covariance_en(0, 0) == Approx(12.5));  // (5 m)^2 / 2
    CHECK(fix.stamp.nanoseconds == kGps);
  }
  CHECK(read(ubx_frame(0x0106, solution.bytes())).fixes[0].told.satellites == 9);
  solution.u32(16, 0);  // a receiver without a fix writes zeros
  CHECK(decode(ubx_frame(0x0106, solution.bytes())).fixes.empty());
}

TEST_CASE("ubx: quality, satellites, HDOP and age of corrections are told") {
  const auto told = [](int type, int flags) {
    UbxBytes pvt = nav_pvt();
    pvt.u8(20, type).u8(21, flags).u8(23, 14).u16(78, 4U << 1U);  // corrections of 5 to 10 s
    UbxBytes dop(18);
    dop.u32(0, kItowMs).u16(12, 85);
    return read(pvt_frame(pvt) + ubx_frame(0x0104, dop.bytes())).fixes.at(0).told;
  };
  CHECK(told(3, 0x01).quality == FixQuality::single);
  CHECK(told(3, 0x03).quality == FixQuality::differential);
  CHECK(told(3, 0x43).quality == FixQuality::floating);
  CHECK(told(3, 0x83).quality == FixQuality::fixed);
  CHECK(told(1, 0x01).quality == FixQuality::dead_reckoned);
  CHECK(told(3, 0x01).satellites == 14);
  CHECK(told(3, 0x01).hdop == 0.85);
  CHECK(told(3, 0x03).correction_age_s == 10);
}

TEST_CASE("ubx: where no frame has a position, NMEA sentences between the frames have it") {
  namespace nmea = waymark_test::nmea_samples;
  const std::string raw = ubx_frame(0x0215, std::string(16, 'r'));
  const std::string log =
      raw + nmea::rmc("000001") + nmea::gga("000001") + raw + nmea::rmc("000002") + nmea::gga("000002") + raw;
  LogRequest request;
  request.default_sigma_m = 3;
  const LogData data = read(log, request);
  REQUIRE(data.fixes.size() == 2);
  CHECK(data.fixes[1].latitude_deg == Approx(48 + 10.8509 / 60));
  CHECK(data.kinds.at("RXM-RAWX") == 3);
  CHECK(data.kinds.at("GPGGA") == 2);
  CHECK(has_note(data,
                 "no UBX message holds a position; they are those of the NMEA sentences between the frames"));
  // Of both kinds together only the first complaints are kept.
  std::string damaged = log;
  for (int i = 0; i < 8; ++i) {
    std::string frame = raw;
    frame.back() ^= 1;
    std::string sentence = nmea::gga("000003");
    sentence[20] ^= 1;
    damaged += frame + sentence;
  }
  const LogData complained = read(damaged, request);
  CHECK(complained.corrupt >= 16);
  CHECK(complained.corrupt_examples.size() == kCorruptExamples);
  // Frames with positions come first.
  CHECK(read(pvt_frame(nav_pvt()) + nmea::rmc("000001") + raw, request).fixes.at(0).latitude_deg == 55.5);
}

}  // namespace ubx_test

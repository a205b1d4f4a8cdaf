#include <catch2/catch.hpp>

#include "logs/ubx/ubx_epochs.hpp"

namespace ubx_time_test {

using namespace waymark;
using namespace waymark_test;
using namespace waymark_test::ubx_samples;

TEST_CASE("ubx: stamps come out on the scale asked for, with the offset") {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.time_offset_s = -0.5;
  CHECK(read(pvt_frame(nav_pvt()), request).fixes.at(0).stamp.nanoseconds == kUtc - 250 - 500'000'000);
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
      Message("log.ubx: none of 1 records could be used; first: log.ubx:byte 0: there is no valid "
              "date and no GPS week yet; state 'time: {week: ...}' to use this position"));
  LogRequest request;
  request.gps_week = 2268;
  const LogData data = read(log, request);
  CHECK(data.fixes.at(0).stamp.nanoseconds == kGps);
  CHECK(has_note(data, "the first epochs state no GPS week; the stated week 2268 is used"));
}

TEST_CASE("ubx: a date whose seconds are not resolved takes those of iTOW") {
  UbxBytes pvt = nav_pvt();
  pvt.u8(11, 0x03).u8(10, 14);  // 16 leap seconds assumed: two seconds late
  const LogData data = read(pvt_frame(pvt));
  CHECK(data.fixes.at(0).stamp.nanoseconds == kGps - 250);
  CHECK(has_note(data, "1 dates are not fully resolved and differ from iTOW by whole seconds; iTOW is used"));
  pvt.u8(11, 0x07);
  const LogData resolved = read(pvt_frame(pvt));
  CHECK(resolved.fixes.at(0).stamp.nanoseconds == kGps - 250 + 2'000'000'000);
  CHECK(has_note(resolved, "1 dates differ from iTOW by a second or more; the dates are used"));
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

}  // namespace ubx_time_test

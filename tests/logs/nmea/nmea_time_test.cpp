#include <catch2/catch.hpp>

#include "logs/nmea/nmea_sentences.hpp"

namespace nmea_time_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test::nmea_samples;

TEST_CASE("nmea: the day is counted over midnight, and before the first date backwards") {
  const LogData data = read(gga("235958") + gga("235959") + gga("000000") + rmc("000001", "010100") +
                            gga("000002") + gga("235959.9") + gga("000000") + rmc("000001", "311299"));
  std::vector<std::int64_t> stamps;
  for (const GeodeticFix& fix : data.fixes) stamps.push_back(fix.stamp.nanoseconds);
  CHECK(stamps == std::vector<std::int64_t>{at("1999-12-31T23:59:58Z"), at("1999-12-31T23:59:59Z"),
                                            at("2000-01-01T00:00:00Z"), at("2000-01-01T00:00:01Z"),
                                            at("2000-01-01T00:00:02Z"), at("2000-01-01T23:59:59.9Z"),
                                            at("2000-01-02T00:00:00Z"), at("1999-12-31T00:00:01Z")});
  CHECK(noted(data, "3 fixes before the first date take the day from it"));
  CHECK(noted(data, "the time of day jumps back by more than 12 h 2 times, which is taken for midnight"));
}

TEST_CASE("nmea: two-digit years are of 1980 to 2079, and ZDA wins") {
  CHECK(read(rmc("000000", "060180")).fixes[0].stamp.nanoseconds == at("1980-01-06T00:00:00Z"));
  CHECK(read(rmc("000000", "311279")).fixes[0].stamp.nanoseconds == at("2079-12-31T00:00:00Z"));
  CHECK(read(rmc("000000") + line("GPZDA,000000,29,02,2024,,")).fixes[0].stamp.nanoseconds ==
        at("2024-02-29T00:00:00Z"));
}

TEST_CASE("nmea: a log without a date needs one to be stated") {
  CHECK_THROWS_MATCHES(
      read(gga("235959") + gga("000000")), InputError,
      Message("log.nmea: none of the first 2 fixes has a date (RMC and ZDA sentences give one); "
              "state that of the first record, such as `time: {date: 2009-04-01}`"));
  LogRequest request = utc();
  request.date = stamp_from_iso8601("2009-04-01T00:00:00Z");
  const LogData data = read(gga("235959") + gga("000000"), request);
  CHECK(data.fixes[1].stamp.nanoseconds == at("2009-04-02T00:00:00Z"));
  CHECK(noted(data, "the log gives no date, the stated one is that of its first fix"));
  CHECK(noted(read(gga("235959") + rmc("000000", "050509"), request),
              "the log gives its date itself; the stated one counts before the log's first only"));
  std::string endless;
  for (int k = 0; k < 5000; ++k) endless += gga(k % 2 == 0 ? "000001" : "000002");
  CHECK_THROWS_MATCHES(
      read(endless + rmc("000001")), InputError,
      Message("log.nmea: none of the first 4096 fixes has a date (RMC and ZDA sentences give one); "
              "state that of the first record, such as `time: {date: 2009-04-01}`"));
}

TEST_CASE("nmea: days are counted as far as stamps reach") {
  LogRequest request = utc();
  request.date = stamp_from_iso8601("2200-12-31T00:00:00Z");
  const LogData data = read(gga("235959") + gga("000000"), request);
  CHECK(data.fixes.size() == 1);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.nmea:2:1: so many midnights have passed that the date is after 2200"});
}

TEST_CASE("nmea: stamps come out on the scale asked for, with the offset, leap seconds included") {
  LogRequest request = utc();
  request.time_scale = TimeScale::gps;
  request.time_offset_s = -0.25;
  // 15 leap seconds in April 2009; GPS began at POSIX 315964800.
  CHECK(read(rmc("124022"), request).fixes[0].stamp.nanoseconds ==
        at("2009-04-01T12:40:22Z") + (15 - 315'964'800LL) * 1'000'000'000 - 250'000'000);
  const LogData data = read(rmc("235960", "311216") + rmc("000000", "010117"));
  CHECK(data.fixes[0].stamp.nanoseconds == at("2017-01-01T00:00:00Z"));
  CHECK(data.fixes[1].stamp.nanoseconds == at("2017-01-01T00:00:00Z"));
  CHECK(noted(data, "1 fixes in a leap second are stamped as one second later"));
}

}  // namespace nmea_time_test

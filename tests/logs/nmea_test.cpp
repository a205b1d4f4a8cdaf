#include <catch2/catch.hpp>

#include <algorithm>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <string>

#include <Eigen/Eigenvalues>

#include <waymark/core/error.hpp>
#include <waymark/formats/iso8601.hpp>
#include <waymark/formats/logs/nmea.hpp>
#include <waymark/formats/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "support/paths.hpp"

using namespace waymark;
using Catch::Matchers::Message;

namespace {

/// A line with `$` and the checksum as the standard defines it.
std::string line(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", sum);
  return "$" + body + tail;
}

std::string rmc(const std::string& time, const std::string& date = "010409") {
  return line("GPRMC," + time + ",A,4810.8509,N,01133.9095,E,10,90," + date + ",,,A");
}
std::string gga(const std::string& time) {
  return line("GPGGA," + time + ",4810.8509,N,01133.9095,E,1,04,2.5,500.5,M,46.5,M,,");
}

LogRequest utc() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 10;
  return request;
}

LogData read(const std::string& text, const LogRequest& request = utc()) {
  return NmeaReader().read(text, "log.nmea", request);
}

std::int64_t at(const char* iso) {
  return stamp_from_iso8601(iso).value().nanoseconds;
}

bool noted(const LogData& data, const std::string& note) {
  return std::find(data.notes.begin(), data.notes.end(), "log.nmea: " + note) != data.notes.end();
}

/// The only complaint about a text.
std::string complaint(const std::string& text, const LogRequest& request = utc()) {
  const LogData data = read(rmc("000000") + text + rmc("000009"), request);
  REQUIRE(data.corrupt_examples.size() == 1);
  return data.corrupt_examples[0];
}

}  // namespace

TEST_CASE("nmea: the sentences of one time are one fix") {
  const LogData data =
      read(rmc("124022.25") + gga("124022.25") + line("GPGST,124022.25,1.2,,,,3,4,5") + line("GPGSV,1,1,00"));
  REQUIRE(data.fixes.size() == 1);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.stamp.nanoseconds == at("2009-04-01T12:40:22.25Z"));
  CHECK(fix.latitude_deg == Approx(48 + 10.8509 / 60).epsilon(1e-15));
  CHECK(fix.longitude_deg == Approx(11 + 33.9095 / 60).epsilon(1e-15));
  CHECK(fix.height_m == 547);  // altitude + geoid separation: above the ellipsoid
  CHECK(*fix.speed_mps == Approx(18520.0 / 3600));
  CHECK(*fix.course_rad == Approx(std::numbers::pi / 2));
  CHECK(fix.covariance_en == (Eigen::Matrix2d() << 16, 0, 0, 9).finished());  // GST: north, then east
  CHECK(fix.line == 2);
  CHECK(data.records == 1);
  CHECK(data.kinds ==
        std::map<std::string, std::size_t>{{"GPGGA", 1}, {"GPGST", 1}, {"GPGSV", 1}, {"GPRMC", 1}});
  CHECK(data.notes ==
        std::vector<std::string>{"log.nmea: 1 fixes with GST read as 1sigma; 0 of them with the "
                                 "correlation of its error ellipse"});
}

TEST_CASE("nmea: any order of the sentences and any talker give the same fixes") {
  const auto epoch = [](const std::string& t, bool reversed) {
    const std::string parts[] = {line("GNRMC," + t + ",A,4810.8509,N,01133.9095,W,10,90,010409,,,A,V"),
                                 line("GAGGA," + t + ",4810.8509,N,01133.9095,W,2,04,2.5,500.5,M,46.5,M,,"),
                                 line("BDZDA," + t + ",01,04,2009,00,00"),
                                 line("GLGST," + t + ",9,,,,3,4,5")};
    std::string text;
    for (int k = 0; k < 4; ++k) text += parts[reversed ? 3 - k : k];
    return text;
  };
  const LogData one = read(epoch("000001", false) + epoch("000002", false));
  const LogData other = read(epoch("000001", true) + epoch("000002", true));
  REQUIRE(one.fixes.size() == 2);
  REQUIRE(other.fixes.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(one.fixes[k].stamp == other.fixes[k].stamp);
    CHECK(one.fixes[k].longitude_deg == other.fixes[k].longitude_deg);
    CHECK(one.fixes[k].height_m == other.fixes[k].height_m);
    CHECK(one.fixes[k].covariance_en == other.fixes[k].covariance_en);
    CHECK(one.fixes[k].longitude_deg < 0);
  }
}

TEST_CASE("nmea: GNS, GLL and VTG stand in for what is not there") {
  const LogData data =
      read(rmc("000001") + line("GNGNS,000002,4810.8509,S,01133.9095,E,AN,05,1.2,100.5,-20.25,,") +
           line("GNVTG,45,T,44,M,,N,36,K,A") + line("GPGLL,4810.0000,N,01133.0000,E,000003,A,A"));
  REQUIRE(data.fixes.size() == 3);
  CHECK(data.fixes[1].latitude_deg < 0);
  CHECK(data.fixes[1].height_m == 80.25);
  CHECK(*data.fixes[1].speed_mps == Approx(10));
  CHECK(*data.fixes[1].course_rad == Approx(std::numbers::pi / 4));
  CHECK(data.fixes[2].latitude_deg == Approx(48 + 10.0 / 60));
  CHECK(std::isnan(data.fixes[2].height_m));
  CHECK(!data.fixes[2].speed_mps);
}

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

TEST_CASE("nmea: what no accuracy can be is none") {
  LogRequest request = utc();
  request.range_error_m = 4;
  for (const char* errors : {"0,4", "3,", "99999999,4", "0.000001,4"}) {
    const LogData data =
        read(rmc("000001") + line(std::string("GPGST,000001,9,,,,") + errors + ",5"), request);
    CHECK(data.fixes.at(0).covariance_en(0, 0) == 100);  // the default
  }
  const std::string unknown = line("GPGGA,000001,4810.8509,N,01133.9095,E,1,04,9999999999,500.5,M,46.5,M,,");
  CHECK(read(rmc("000001") + unknown, request).fixes.at(0).covariance_en(0, 0) == 100);
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

TEST_CASE("nmea: which accuracy a fix gets") {
  const std::string with_gst = rmc("000001") + line("GPGST,000001,9,,,,3,4,5");
  const std::string with_hdop = rmc("000001") + gga("000001");
  LogRequest request = utc();
  request.range_error_m = 4;
  CHECK(read(with_gst, request).fixes[0].covariance_en(1, 1) == 9);
  CHECK(read(with_hdop, request).fixes[0].covariance_en == Eigen::Matrix2d::Identity() * 100);  // 2.5 x 4 m
  CHECK(noted(read(with_hdop, request),
              "1 fixes give HDOP only, which is multiplied with the stated range error of 4 m"));
  CHECK(read(rmc("000001"), request).fixes[0].covariance_en(0, 0) == 100);
  CHECK(noted(read(rmc("000001"), request),
              "1 fixes give no accuracy, the stated default sigma of 10 m is used"));
  request.accuracy = AccuracyMeaning::percent95;
  CHECK(read(with_gst, request).fixes[0].covariance_en(0, 0) == 4);
  CHECK(read(with_gst, request).notes.front() ==
        "log.nmea: 1 fixes with GST read as 95; 0 of them with the correlation of its error ellipse");
  request.default_sigma_m = 0;
  CHECK_THROWS_MATCHES(
      read(rmc("000001"), request), InputError,
      Message("log.nmea: none of 1 records could be used; first: log.nmea:1:1: no accuracy is "
              "given: state 'default_sigma'"));
}

TEST_CASE("nmea: the error ellipse of GST gives the correlation, whatever its scale") {
  const auto covariance = [](const std::string& ellipse, const std::string& errors) {
    return read(rmc("000001") + line("GPGST,000001,9," + ellipse + "," + errors + ",5"))
        .fixes[0]
        .covariance_en;
  };
  // A Septentrio's: axis 1.791 degrees east of north. The ellipse's own matrix reproduces the errors.
  const Eigen::Matrix2d narrow = covariance("317.719,3.872,1.791", "317.563,10.659");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(narrow);
  CHECK(std::sqrt(axes.eigenvalues()[1]) == Approx(317.719).epsilon(1e-4));
  CHECK(std::sqrt(axes.eigenvalues()[0]) == Approx(3.872).epsilon(1e-3));
  const Eigen::Vector2d major = axes.eigenvectors().col(1);
  CHECK(std::atan(major.x() / major.y()) * 180 / std::numbers::pi == Approx(1.791).epsilon(1e-3));
  // The same ellipse 2.4477 times as large, as u-blox M9 states it (95 %).
  const Eigen::Matrix2d scaled = covariance("777.68,9.4775,1.791", "317.563,10.659");
  CHECK(scaled(0, 1) == Approx(narrow(0, 1)).epsilon(1e-3));
  // Turned the other way, the errors contradict it.
  const Eigen::Matrix2d contradicted = covariance("317.719,3.872,88.209", "317.563,10.659");
  CHECK(contradicted(0, 1) == 0);
  CHECK(noted(read(rmc("000001") + line("GPGST,000001,9,317.719,3.872,88.209,317.563,10.659,5")),
              "1 error ellipses of another shape than the errors beside them were left aside"));
}

TEST_CASE("nmea: what is no fix") {
  for (const std::string& none :
       {line("GPRMC,000001,V,4810.8509,N,01133.9095,E,10,90,010409,,,A"),
        line("GPRMC,000001,A,4810.8509,N,01133.9095,E,10,90,010409,,,N"),
        line("GPGGA,000001,4810.8509,N,01133.9095,E,0,00,,,M,,M,,"), line("GPGGA,000001,,,,,0,00,,,M,,M,,"),
        line("GNGNS,000001,4810.8509,N,01133.9095,E,NN,00,99.0,,,,"), line("GPGLL,,,,,000001,V,N"),
        line("GPRMC,,V,,,,,,,,,,N"), rmc("000001") + line("GPGGA,000001,,,,,0,00,,,M,,M,,")}) {
    INFO(none);
    const LogData data = read(rmc("000000") + none);
    CHECK(data.fixes.size() == 1);
    CHECK(data.without_fix == 1);
    CHECK(data.records == 2);
    CHECK(data.corrupt == 0);
    CHECK(noted(data, "1 of 2 records are marked as without a fix"));
  }
  const std::string untimed =
      line("GPGGA,,,,,,0,,,,M,,M,,") + line("GPGLL,,,,,,V,N") + line("GPRMC,,V,,,,,,,,,,N");
  CHECK(read(untimed + untimed + rmc("000001")).without_fix == 2);
  CHECK(noted(read(line("GPGGA,,4810.8509,N,01133.9095,E,1,04,,,M,,M,,") + rmc("000001")),
              "1 fixes without a time of day were skipped"));
}

TEST_CASE("nmea: a fix from no satellite is none, where the receiver counts them") {
  const auto without_satellites = [](const std::string& time, const char* quality) {
    return line("GPGGA," + time + ",4810.8509,N,01133.9095,E," + quality + ",00,2.5,500.5,M,46.5,M,,");
  };
  const LogData data = read(rmc("000001") + gga("000001") + without_satellites("000002", "1"));
  CHECK(data.fixes.size() == 1);
  CHECK(noted(data, "1 fixes rest on no satellite and count as records without a fix"));
  CHECK(read(rmc("000001") + without_satellites("000001", "1")).fixes.size() == 1);
  const LogData reckoned = read(rmc("000001") + gga("000001") + without_satellites("000002", "6"));
  CHECK(reckoned.fixes.size() == 2);
  CHECK(noted(reckoned, "1 fixes are dead reckoning of the receiver, not measured"));
  CHECK(noted(read(rmc("000001") + without_satellites("000001", "8")),
              "1 fixes are marked as simulated or typed in"));
}

TEST_CASE("nmea: heights without a geoid separation and coarse positions are noted") {
  const LogData data = read(line("GPRMC,000001,A,4810.85,N,01133.91,E,10,90,010409,,,A") +
                            line("GPGGA,000001,4810.85,N,01133.91,E,1,04,2.5,500.5,M,,M,,"));
  CHECK(data.fixes[0].height_m == 500.5);
  CHECK(noted(data, "1 heights are above mean sea level (no geoid separation)"));
  CHECK(noted(data, "positions are given in steps of 19 m (2 decimals of a minute)"));
  CHECK(read(rmc("000001")).notes.size() == 1);  // four decimals are 0.19 m
}

TEST_CASE("nmea: damaged sentences are named") {
  std::string flipped = gga("000001");
  flipped[10] = '7';
  CHECK(complaint(flipped) ==
        "log.nmea:2:2: GPGGA: wrong checksum: the sentence states 4B, its characters give 4C");
  CHECK(read(rmc("000000") + "noise $GPGGA,0000" + gga("000001")).corrupt == 0);  // taken for a comment
  CHECK(complaint("$GPGGA,000001,4810.8509,N\r\n") ==
        "log.nmea:2:2: GPGGA: the sentence breaks off before its checksum");
  const auto field = [](const std::string& body) { return complaint(line(body)); };
  CHECK(field("GPGGA,000001,4810.8509,N,01133.9095,E,1,04,0NaN,500,M,46,M,,") ==
        "log.nmea:2:45: GPGGA: expected a number for the HDOP, got '0NaN'");
  CHECK(field("GPRMC,0000,A,4810.8509,N,01133.9095,E,10,90,010409,,,A") ==
        "log.nmea:2:8: GPRMC: expected a time hhmmss, got '0000'");
  CHECK(field("GPRMC,240000,A,4810.8509,N,01133.9095,E,10,90,010409,,,A") ==
        "log.nmea:2:8: GPRMC: expected a time of day hhmmss, got '240000'");
  CHECK(field("GPRMC,000001.x,A,4810.8509,N,01133.9095,E,10,90,010409,,,A") ==
        "log.nmea:2:8: GPRMC: expected a time hhmmss.sss, got '000001.x'");
  CHECK(field("GPRMC,000001,A,4860.0,N,01133.9095,E,10,90,010409,,,A") ==
        "log.nmea:2:17: GPRMC: expected a latitude from 0 to 90 degrees as ddmm.mmm, got '4860.0'");
  CHECK(field("GPRMC,000001,A,4810.0,N,18100.1,E,10,90,010409,,,A") ==
        "log.nmea:2:26: GPRMC: expected a longitude from 0 to 180 degrees as dddmm.mmm, got '18100.1'");
  CHECK(field("GPRMC,000001,A,4810.0,X,01133.9095,E,10,90,010409,,,A") ==
        "log.nmea:2:24: GPRMC: expected N or S after the latitude, got 'X'");
  CHECK(field("GPRMC,000001,A,4810.0,N,01133.9095,,10,90,010409,,,A") ==
        "log.nmea:2:37: GPRMC: expected E or W after the longitude, got ''");
  CHECK(field("GPRMC,000001,A,,,,,10,90,010409,,,A") == "log.nmea:2:17: GPRMC: a fix without latitude");
  CHECK(field("GPRMC,000001,A,4810.0,N,,,10,90,010409,,,A") ==
        "log.nmea:2:26: GPRMC: a fix without longitude");
  CHECK(field("GPRMC,000001,A,4810.0,N,01133.9095,E,-1,90,010409,,,A") ==
        "log.nmea:2:39: GPRMC: expected a speed of 0 to 1000 m/s, got '-1'");
  CHECK(field("GPRMC,000001,A,4810.0,N,01133.9095,E,1,361,010409,,,A") ==
        "log.nmea:2:41: GPRMC: expected a course of 0 to 360 degrees, got '361'");
  CHECK(field("GPRMC,000001,A,4810.0,N,01133.9095,E,1,36,01042009,,,A") ==
        "log.nmea:2:44: GPRMC: expected a date ddmmyy, got '01042009'");
  CHECK(field("GPRMC,000001,A,4810.0,N,01133.9095,E,1,36,310409,,,A") ==
        "log.nmea:2:44: GPRMC: expected a date ddmmyy that exists, got '310409'");
  CHECK(field("GPZDA,000001,01,04,09,,") ==
        "log.nmea:2:21: GPZDA: expected a year from 1980 to 2200, got '09'");
  CHECK(field("GPZDA,000001,31,04,2009,,") ==
        "log.nmea:2:15: GPZDA: expected a day and a month that exist, got '31'");
}

TEST_CASE("nmea: checksums that are nowhere are not missed") {
  const auto bare = [](std::string text) { return text.substr(0, text.find('*')) + "\n"; };
  const LogData data = read(bare(rmc("000001")) + bare(rmc("000002")));
  CHECK(data.fixes.size() == 2);
  CHECK(noted(data, "2 sentences have no checksum and are believed"));
}

TEST_CASE("nmea: what is no sentence is passed over") {
  const std::string text =
      "# $GPRMC, from a receiver\n{\"class\":\"TPV\"}\n\n$\n$,\n$gprmc,x\n\xB5\x62\x01\x07" + rmc("000001") +
      "half a line " + rmc("000002") + rmc("000003").substr(0, 20) + rmc("000004") + line("PMTK001,1,3") +
      "$GPGSV,1,1*00\n" + std::string(100, '\xFF');
  const LogData data = read(text);
  CHECK(data.fixes.size() == 3);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.nmea:9:2: GPRMC: the sentence breaks off before its checksum"});
  CHECK(noted(data, "6 lines that hold no NMEA sentence were skipped"));
  CHECK(noted(data, "1 sentences of kinds that are not read are damaged (wrong checksum or none)"));
  CHECK(data.kinds.at("PMTK001") == 1);
}

TEST_CASE("nmea: requests that no NMEA log can meet") {
  LogRequest request = utc();
  request.stream = StreamKind::odometry;
  CHECK_THROWS_MATCHES(
      read("", request), InputError,
      Message("log.nmea: an NMEA log holds no odometry; it gives the streams gnss and truth"));
  request.stream = StreamKind::sensor;
  CHECK_THROWS_MATCHES(
      read("", request), InputError,
      Message("log.nmea: an NMEA log holds no sensor readings; it gives the streams gnss and truth"));
  request = utc();
  request.columns["time"] = {"t", "", ""};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.nmea: an NMEA log has no columns to map; leave out 'columns'"));
  request = utc();
  request.companions["dbc"] = {"car.dbc", ""};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.nmea: an NMEA log takes no 'dbc' file; leave it out"));
}

TEST_CASE("nmea: a log may serve as truth, without an accuracy") {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.stream = StreamKind::truth;
  const LogData data = read(rmc("000001") + gga("000001"), request);
  REQUIRE(data.truth.size() == 1);
  CHECK(data.truth[0].height_m == 547);
  CHECK(data.fixes.empty());
}

TEST_CASE("nmea: how surely a log is known") {
  const Recognition sure = NmeaReader().recognise(rmc("000001") + gga("000001") + "# comment\n" + "$GPRM");
  CHECK(sure.certainty == Approx(2.0 / 3));
  CHECK(sure.evidence == "2 of 3 lines are NMEA sentences with a right checksum");
  CHECK(NmeaReader().recognise("time,speed\n1,2\n").certainty == 0);
  CHECK(NmeaReader().recognise("").certainty == 0);
}

TEST_CASE("nmea: the pieces that a log comes in make no difference, real and damaged logs") {
  const auto folder = waymark_test::shared_data_dir() / "logs" / "nmea";
  if (!std::filesystem::exists(folder)) {
    std::cout << "SKIPPED: " << folder.string() << " is absent\n";
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::string text = read_text_file(entry.path().string()).substr(0, 60'000);
    for (std::size_t k = 500; k < text.size(); k += 977) text[k] = static_cast<char>(k * 31);  // damage
    INFO(entry.path());
    waymark_test::check_pieces(NmeaReader(), text, "log.nmea", utc());
  }
}

TEST_CASE("nmea: the Petuelring tunnel") {
  const auto path = waymark_test::shared_data_dir() / "logs" / "nmea" / "genivi_munich_Petuelring_2009.nmea";
  if (!std::filesystem::exists(path)) {
    std::cout << "SKIPPED: " << path.string() << " is absent\n";
    return;
  }
  const LogData data = read(read_text_file(path.string()));
  // awk counts: 1867 epochs, 20 with status V, 19 with quality 1 and no satellite; one HDOP is "0NaN".
  CHECK(data.fixes.size() == 1867 - 20 - 19);
  CHECK(data.without_fix == 39);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.nmea:10264:48: GPGGA: expected a number for the HDOP, got '0NaN'"});
  CHECK(data.fixes.front().stamp.nanoseconds == at("2009-04-01T12:40:22Z"));
  CHECK(data.kinds.at("GPGSV") == 5601);
}

#include <catch2/catch.hpp>

#include "logs/nmea/nmea_sentences.hpp"

#include "support/skip.hpp"

namespace nmea_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test::nmea_samples;

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

TEST_CASE("nmea: a byte order mark hides no sentence, and no log") {
  const std::string text = gga("124022.25") + rmc("124022.25") + gga("124023.25");
  const LogData data = read("\xEF\xBB\xBF" + text);
  CHECK(data.fixes.size() == read(text).fixes.size());
  CHECK(data.kinds == read(text).kinds);
  CHECK(data.corrupt == 0);
  CHECK(NmeaReader().recognise("\xEF\xBB\xBF" + text).certainty == NmeaReader().recognise(text).certainty);
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

TEST_CASE("nmea: which accuracy a fix gets") {
  const std::string with_gst = rmc("000001") + line("GPGST,000001,9,,,,3,4,5");
  const std::string with_hdop = rmc("000001") + gga("000001");
  LogRequest request = utc();
  request.range_error_m = 4;
  CHECK(read(with_gst, request).fixes[0].covariance_en(1, 1) == 9);
  CHECK(read(with_hdop, request).fixes[0].covariance_en == Eigen::Matrix2d::Identity() * 100);  // 2.5 x 4 m
  CHECK(noted(read(with_hdop, request),
              "1 fixes have only HDOP, which is multiplied by the stated range error of 4 m"));
  CHECK(read(rmc("000001"), request).fixes[0].covariance_en(0, 0) == 100);
  CHECK(noted(read(rmc("000001"), request),
              "1 fixes have no accuracy; the stated default sigma of 10 m is used"));
  request.accuracy = AccuracyMeaning::percent95;
  CHECK(read(with_gst, request).fixes[0].covariance_en(0, 0) == 4);
  CHECK(read(with_gst, request).notes.front() ==
        "log.nmea: 1 fixes with GST read as 95; 0 of them with the correlation of its error ellipse");
  request.default_sigma_m = 0;
  CHECK(read(rmc("000001"), request).fixes[0].covariance_en(0, 0) == 9);  // mode A: single
  CHECK_THROWS_MATCHES(
      read(line("GPRMC,000001,A,4810.8509,N,01133.9095,E,10,90,010409,,"), request), InputError,
      Message("log.nmea: none of 1 records could be used; first: log.nmea:1:1: the log has no "
              "accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'"));
}

TEST_CASE("nmea: quality, satellites, HDOP and age of corrections are told") {
  const auto told = [](const std::string& text) { return read(text).fixes.at(0).told; };
  const auto with = [](const std::string& quality, const std::string& mode) {
    return line("GPRMC,000001,A,4810.8509,N,01133.9095,E,10,90,010409,,," + mode) +
           line("GPGGA,000001,4810.8509,N,01133.9095,E," + quality + ",12,0.8,500.5,M,46.5,M,1.5,0001");
  };
  using enum FixQuality;
  CHECK(told(with("1", "A")).quality == single);
  CHECK(told(with("2", "D")).quality == differential);
  CHECK(told(with("4", "R")).quality == fixed);
  CHECK(told(with("5", "F")).quality == floating);
  CHECK(told(with("5", "D")).quality == floating);  // old receivers know no letter for it: GGA knows best
  CHECK(told(with("6", "E")).quality == dead_reckoned);
  CHECK(told(with("1", "E")).quality == dead_reckoned);
  CHECK(told(with("7", "M")).quality == manual);
  CHECK(told(with("8", "S")).quality == simulated);
  CHECK(told(with("4", "R")).satellites == 12);
  CHECK(told(with("4", "R")).hdop == 0.8);
  CHECK(told(with("4", "R")).correction_age_s == 1.5);
  const FixDetails rmc_alone = told(rmc("000001") + line("GPGSA,A,3,01,02,,,,,,,,,,,2.1,1.2,1.7"));
  CHECK(rmc_alone.quality == single);
  CHECK(rmc_alone.hdop == 1.2);
  CHECK(rmc_alone.satellites == -1);
  const FixDetails gns =
      told(rmc("000001") + line("GNGNS,000001,4810.8509,N,01133.9095,E,RRN,17,0.6,500.5,46.5,1.0,0001"));
  CHECK(gns.quality == fixed);
  CHECK(gns.satellites == 17);
  CHECK(gns.correction_age_s == 1);
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
              "1 error ellipses contradict the errors beside them and were ignored"));
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
  CHECK(noted(data, "1 fixes use no satellite and count as records without a fix"));
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

TEST_CASE("nmea: a log may serve as truth, without an accuracy") {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.stream = StreamKind::truth;
  const LogData data = read(rmc("000001") + gga("000001"), request);
  REQUIRE(data.truth.size() == 1);
  CHECK(data.truth[0].height_m == 547);
  CHECK(data.fixes.empty());
}

TEST_CASE("nmea: the Petuelring tunnel") {
  const auto path = waymark_test::shared_data("logs/nmea/genivi_munich_Petuelring_2009.nmea");
  if (!path) return;
  const LogData data = read(read_text_file(*path));
  // awk counts: 1867 epochs, 20 with status V, 19 with quality 1 and no satellite; one HDOP is "0NaN".
  CHECK(data.fixes.size() == 1867 - 20 - 19);
  CHECK(data.without_fix == 39);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.nmea:10264:48: GPGGA: expected a number for the HDOP, got '0NaN'"});
  CHECK(data.fixes.front().stamp.nanoseconds == at("2009-04-01T12:40:22Z"));
  CHECK(data.kinds.at("GPGSV") == 5601);
}

}  // namespace nmea_test

#include <catch2/catch.hpp>

#include "logs/nmea/nmea_sentences.hpp"

#include "support/skip.hpp"

namespace nmea_damage_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test::nmea_samples;

TEST_CASE("nmea: damaged sentences are named") {
  std::string flipped = gga("000001");
  flipped[10] = '7';
  CHECK(complaint(flipped) ==
        "log.nmea:2:2: GPGGA: wrong checksum: the sentence states 4B, its characters give 4C");
  CHECK(read(rmc("000000") + "noise $GPGGA,0000" + gga("000001")).corrupt == 0);  // taken for a comment
  CHECK(complaint("$GPGGA,000001,4810.8509,N\r\n") ==
        "log.nmea:2:2: GPGGA: the sentence ends before its checksum");
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
  CHECK(noted(data, "2 sentences have no checksum and are used"));
}

TEST_CASE("nmea: what is no sentence is passed over") {
  const std::string text =
      "# $GPRMC, from a receiver\n{\"class\":\"TPV\"}\n\n$\n$,\n$gprmc,x\n\xB5\x62\x01\x07" + rmc("000001") +
      "half a line " + rmc("000002") + rmc("000003").substr(0, 20) + rmc("000004") + line("PMTK001,1,3") +
      "$GPGSV,1,1*00\n" + std::string(100, '\xFF');
  const LogData data = read(text);
  CHECK(data.fixes.size() == 3);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.nmea:9:2: GPRMC: the sentence ends before its checksum"});
  CHECK(noted(data, "6 lines that hold no NMEA sentence were skipped"));
  CHECK(noted(data, "1 sentences of unused kinds are damaged (wrong checksum or none)"));
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
  request.companions["dbc"] = {{"car.dbc", ""}};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.nmea: an NMEA log takes no 'dbc' file; leave it out"));
}

TEST_CASE("nmea: how surely a log is known") {
  const Recognition sure = NmeaReader().recognise(rmc("000001") + gga("000001") + "# comment\n" + "$GPRM");
  CHECK(sure.certainty == Approx(2.0 / 3));
  CHECK(sure.evidence == "2 of 3 lines are NMEA sentences with a right checksum");
  const Recognition bare =
      NmeaReader().recognise("$GPRMC,000001,A,4810.8,N,01133.9,E,10,90,010409\n$GPXYZ,1,2\n");
  CHECK(bare.certainty == 0.5);
  CHECK(bare.evidence == "1 of 2 lines are NMEA sentences of known kinds without a checksum");
  CHECK(NmeaReader().recognise("time,speed\n1,2\n").certainty == 0);
  CHECK(NmeaReader().recognise("").certainty == 0);
}

TEST_CASE("nmea: the pieces that a log comes in make no difference, real and damaged logs") {
  const auto folder = waymark_test::shared_data("logs/nmea");
  if (!folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    std::string text = read_text_file(entry.path().string()).substr(0, 60'000);
    for (std::size_t k = 500; k < text.size(); k += 977) text[k] = static_cast<char>(k * 31);  // damage
    INFO(entry.path());
    waymark_test::check_pieces(NmeaReader(), text, "log.nmea", utc());
  }
}

}  // namespace nmea_damage_test

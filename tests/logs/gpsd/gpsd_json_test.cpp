#include <catch2/catch.hpp>

#include "logs/gpsd/gpsd_reports.hpp"

namespace gpsd_json_test {

using namespace waymark;
using namespace waymark_test::gpsd_samples;

TEST_CASE("gpsd: one report") {
  const LogData data = read(kFix);
  REQUIRE(data.fixes.size() == 1);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.stamp.nanoseconds == 1'118'327'685'280'000'000);  // date -u -d 2005-06-09T14:34:45 +%s
  CHECK(fix.latitude_deg == 46.5);
  CHECK(fix.longitude_deg == 7.5);
  CHECK(fix.height_m == 1391.3);
  CHECK(fix.covariance_en(0, 0) == Approx(4));  // (epx / 2)^2, the paper's rule
  CHECK(fix.covariance_en(1, 1) == Approx(9));
  CHECK(*fix.course_rad == Approx(std::numbers::pi / 2));
  CHECK(*fix.course_sigma_rad == Approx(std::numbers::pi / 18));
  CHECK(*fix.speed_mps == 5);
  CHECK(*fix.speed_sigma_mps == 1.5);
  CHECK(fix.line == 1);
  CHECK(data.notes ==
        std::vector<std::string>{
            "log.json: gpsd of unknown version: 1 fixes with epx and epy read as 95 (not stated)",
            "log.json: epx and epy come from the dilution of precision (gpsd since 3.19); eph is "
            "the receiver's own accuracy, if it states one; read it with 'drms': sigma would be "
            "7.07 m on average instead of 2.5 m"});
}

TEST_CASE("gpsd: stamps come out on the scale asked for") {
  LogRequest request = utc_fixes();
  request.time_scale = TimeScale::gps;
  request.time_offset_s = -0.25;
  // 13 leap seconds in 2005; GPS began at POSIX 315964800.
  CHECK(read(kFix, request).fixes.at(0).stamp.nanoseconds ==
        (1'118'327'685LL - 315'964'800 + 13) * 1'000'000'000 + 30'000'000);
}

TEST_CASE("gpsd: neighbouring reports of one epoch are merged, the later field wins") {
  const std::string text =
      std::string(kFix) + "\n" +
      R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:45.280Z","lat":46.6,"lon":7.5,"epx":8})" + "\n";
  const LogData data = read(text);
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].latitude_deg == 46.6);
  CHECK(data.fixes[0].covariance_en(0, 0) == Approx(16));
  CHECK(data.fixes[0].covariance_en(1, 1) == Approx(9));  // epy kept from the first
  CHECK(data.fixes[0].line == 2);
  CHECK(data.records == 1);
}

TEST_CASE("gpsd: only the first device is read") {
  const std::string one = R"({"class":"TPV","device":"/dev/a","mode":3,"time":"2005-06-09T14:34:45Z",)"
                          R"("lat":1,"lon":2,"eph":3})";
  const std::string two = R"({"class":"TPV","device":"/dev/b","mode":3,"time":"2005-06-09T14:34:45Z",)"
                          R"("lat":3,"lon":4,"eph":3})";
  const LogData data = read(one + "\n" + two + "\n");
  REQUIRE(data.fixes.size() == 1);
  CHECK(data.fixes[0].latitude_deg == 1);
  CHECK(data.notes.back() == "log.json: 1 reports of other devices than '/dev/a' were skipped");
}

TEST_CASE("gpsd: what is no fix, what is no JSON and what is corrupt are told apart") {
  const std::string text =
      std::string("# a comment\n$GPGGA,1*00\n{\"class\":\"VERSION\",\"release\":\"3.22\"}\n") + kFix + "\n" +
      R"({"class":"TPV","mode":1,"time":"2005-06-09T14:34:46Z"}
{"class":"TPV","mode":3,"lat":1,"lon":2}
{"class":"TPV","mode":3,"time":"2005-06-09T14:34:47Z","lat":1,
{"class":"TPV","mode":3,"time":"2005-06-09T14:34:48Z","lat":"1","lon":2,"eph":3}
{"class":"TPV","mode":3,"time":"2005-06-09T14:34:49Z","lat":1,"eph":3}
{"class":"TPV","mode":1e999}
{"class":"TPV","mode":3,"time":"2005-06-09T14:34:50Z","lat":91,"lon":2,"eph":3}
{"class":"TPV","mode":3,"time":"2005-13-09T14:34:50Z","lat":9,"lon":2,"eph":3}
)";
  const LogData data = read(text);
  CHECK(data.fixes.size() == 1);
  CHECK(data.corrupt == 6);
  REQUIRE(data.corrupt_examples.size() == 5);
  CHECK(data.corrupt_examples[0] == "log.json:7:63: malformed JSON");
  CHECK(data.corrupt_examples[1] == "log.json:8:1: TPV: expected a number for 'lat', got \"1\"");
  CHECK(data.corrupt_examples[2] ==
        "log.json:10:1: a number is out of range");  // found before the epoch above ends
  CHECK(data.corrupt_examples[3] == "log.json:9:1: TPV: a fix without 'lon'");
  CHECK(data.corrupt_examples[4] == "log.json:11:1: TPV: 'lat' 91 is outside -90 .. 90");
  CHECK(data.notes ==
        std::vector<std::string>{"log.json: gpsd 3.22: 1 fixes with epx and epy read as 95 (not stated)",
                                 "log.json: epx and epy come from the dilution of precision (gpsd "
                                 "since 3.19); eph is the receiver's own accuracy, if it states "
                                 "one; read it with 'drms': sigma would be 7.07 m "
                                 "on average instead of 2.5 m",
                                 "log.json: 2 lines that are no JSON objects were skipped",
                                 "log.json: 1 fixes without a time were skipped",
                                 "log.json: 1 of 9 records are marked as without a fix"});
}

TEST_CASE("gpsd: a log may serve as truth") {
  LogRequest request = utc_fixes();
  request.stream = StreamKind::truth;
  const LogData data = read(kFix, request);
  REQUIRE(data.truth.size() == 1);
  CHECK(data.truth[0].longitude_deg == 7.5);
  CHECK(!data.truth[0].heading_rad);
}

TEST_CASE("gpsd: what cannot be read at all is an error that says why") {
  LogRequest request = utc_fixes();
  CHECK_THROWS_MATCHES(read(" \n"), InputError, Message("log.json: the log is empty"));
  CHECK_THROWS_MATCHES(read("$GPGGA\n"), InputError, Message("log.json: the log holds no records"));
  CHECK_THROWS_MATCHES(read("{\"class\":\"TPV\",\"mode\":1}\n"), InputError,
                       Message("log.json: not one fix in 1 records (1 are marked as without a fix)"));
  request.columns["time"] = {"t", "", ""};
  CHECK_THROWS_MATCHES(read(kFix, request), InputError,
                       Message("log.json: a gpsd log has no columns to map; leave out 'columns'"));
  request.stream = StreamKind::odometry;
  CHECK_THROWS_MATCHES(
      read(kFix, request), InputError,
      Message("log.json: a gpsd log holds no odometry; it gives the streams gnss and truth"));
  request.stream = StreamKind::sensor;
  CHECK_THROWS_MATCHES(
      read(kFix, request), InputError,
      Message("log.json: a gpsd log holds no sensor readings; it gives the streams gnss and truth"));
  request = utc_fixes();
  request.companions["dbc"] = {{"car.dbc", ""}};
  CHECK_THROWS_MATCHES(read(kFix, request), InputError,
                       Message("log.json: a gpsd log takes no 'dbc' file; leave it out"));
}

TEST_CASE("gpsd: dead reckoning and simulation are noted, messages are counted by class") {
  const auto tpv = [](int second, int status) {
    std::string text = R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:0)";
    text += std::to_string(second);
    text += R"(Z","status":)";
    text += std::to_string(status);
    text += R"(,"lat":1,"lon":2,"eph":3,"leapseconds":18,"ecefx":1})";
    return text + "\n";
  };
  const LogData data =
      read(tpv(1, 5) + tpv(2, 8) + tpv(3, 3) + "{\"class\":\"PPS\",\"x\":[1,{\"lat\":9}]}\n" +
           "{ \"class\" : \"SKY\" }\n{\"class\":\"SKY\",\"unfinished\":\n");
  CHECK(data.fixes.size() == 3);
  CHECK(data.corrupt == 0);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"PPS", 1}, {"SKY", 2}, {"TPV", 3}});
  CHECK(data.notes[1] == "log.json: 1 fixes are dead reckoning of the receiver, not measured");
  CHECK(data.notes[2] == "log.json: 1 fixes are marked as simulated");
}

TEST_CASE("gpsd: nested and gigantic members break nothing") {
  const std::string start = R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:45Z","lon":2,"lat":)";
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  const LogData data =
      read(std::string(kFix) + "\n" + start + deep + "}\n" + start + '"' + std::string(100'000, 'x') +
           "\"}\n" + start + "{\"lat\":1}}\n" + start + "true}\n");
  CHECK(data.fixes.size() == 1);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{"log.json:5:1: TPV: expected a number for 'lat', got true"});
}

TEST_CASE("gpsd: how surely a log is known") {
  const std::string sky = "{\"class\":\"SKY\"}\n";
  const Recognition mixed = GpsdJsonReader().recognise("# comment\n" + sky + kFix + "\n$GPGSV,1,1,00*79\n");
  CHECK(mixed.certainty == Approx(3.0 / 4));
  CHECK(mixed.evidence == "3 of 4 lines are gpsd's JSON objects, or NMEA sentences between them (1)");
  CHECK(GpsdJsonReader().recognise(sky + "time,speed\n").certainty == Approx(0.5));
  CHECK(GpsdJsonReader().recognise("{\"a\":1}\n").certainty == 0);
}

TEST_CASE("gpsd: real logs, whole and in pieces") {
  struct Log {
    const char* name;
    std::size_t fixes;  ///< counted with ten lines of Python over the .chk files
    std::size_t without_fix;
    std::size_t corrupt;
  };
  // The TPV objects of a time are one record.
  constexpr Log kLogs[] = {
      {"gpsd_bu303-moving.log.chk", 12, 0, 0}, {"gpsd_garmin18x-bin.log.chk", 29, 0, 0},
      {"gpsd_neo-m8n.log.chk", 22, 0, 0},      {"gpsd_telit-he910.log.chk", 187, 111, 0},
      {"gpsd_ublox-glo.log.chk", 291, 8, 0},   {"gpsd_ublox-neo-m8l.log.chk", 207, 0, 0},
  };
  LogRequest request = utc_fixes();
  request.default_sigma_m = 10;
  for (const Log& log : kLogs) {
    const std::string text = shared_log(log.name);
    if (text.empty()) return;
    INFO(log.name);
    const LogData whole = waymark_test::check_pieces(GpsdJsonReader(), text, "log.json", request);
    CHECK(whole.fixes.size() == log.fixes);
    CHECK(whole.without_fix == log.without_fix);
    CHECK(whole.corrupt == log.corrupt);
    CHECK(GpsdJsonReader().recognise(std::string_view(text).substr(0, 65536)).certainty > 0.99);
  }
  const LogData glonass = read(shared_log("gpsd_ublox-glo.log.chk"));
  CHECK(glonass.fixes.front().latitude_deg == Approx(55.6024871));
  CHECK(glonass.fixes.front().covariance_en(0, 0) == Approx(11.143 * 11.143 / 4));
  if (const std::string text = shared_log("gpsd_bu303-nofix.log.chk"); !text.empty())
    CHECK_THROWS_MATCHES(read(text), InputError,
                         Message("log.json: not one fix in 7 records (7 are marked as without a fix)"));
}

}  // namespace gpsd_json_test

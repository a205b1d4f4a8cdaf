// Logs that hold a table among other lines: Android's GnssLogger and Racelogic's VBO.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/tables/gnss_logger.hpp>
#include <waymark/formats/logs/detail/tables/vbo.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/stamp_text.hpp>

#include "logs/log_pieces.hpp"

namespace tables_inside_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

LogRequest fixes(TimeScale scale = TimeScale::utc) {
  LogRequest request;
  request.stream = StreamKind::gnss;
  request.time_scale = scale;
  return request;
}

// Lines as the app writes them: raw measurements and sensors lie between the fixes.
const std::string kPhone =
    "# \n# Header Description:\n# \n"
    "# Version: v3.0.6.4 Platform: 13 Manufacturer: Google Model: Pixel 7\n# \n"
    "# Raw,utcTimeMillis,TimeNanos,LeapSecond\n# \n"
    "# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AltitudeMeters,SpeedMps,AccuracyMeters,BearingDegrees,"
    "UnixTimeMillis,SpeedAccuracyMps,BearingAccuracyDegrees,elapsedRealtimeNanos,VerticalAccuracyMeters\n# \n"
    "Raw,1700000000000,39214000000,18\n"
    "Fix,GPS,52.27,10.53,120.5,10.0,2.0,90.0,1700000000440,0.5,2.0,5000,3.0\n"
    "Fix,FLP,52.28,10.54,120.5,10.0,5.0,90.0,1700000000440,0.5,2.0,5000,3.0\n"
    "UncalGyro,1700000000500,5100,0.01,0.02,0.03,0,0,0\n"
    "Fix,GPS,52.2701,10.5301,,,,,1700000001440,,,6000,\n"
    "Fix,GPS,98.0,10.5301,,,3.0,,1700000002440,,,6000,\n";

const std::string kRace =
    "File created on 26/07/2021 at 10:14:15\n\n[header]\nsatellites\ntime\nlatitude\nlongitude\n"
    "velocity kmh\nheading\nheight\n\n[comments]\nVBOX 3i\n\n"
    "[column names]\nsats time lat long velocity heading height\n\n[data]\n"
    "136 101416.00 +03119.09973 -00631.80000 036.000 090.00 +00120.50\n"
    "000 101417.00 +00000.00000 +00000.00000 000.000 000.00 +00000.00\n"
    "008 101418.25 +03119.10973 +00058.49277 072.000 270.00 +00120.50\n";

}  // namespace

TEST_CASE("gnss_logger: fixes of GPS by the names of the log's comment") {
  const GnssLoggerReader reader;
  CHECK(reader.recognise(kPhone).certainty > 0.9);
  LogRequest request = fixes();
  request.default_sigma_m = 4;
  const LogData data = waymark_test::check_pieces(reader, kPhone, "phone.txt", request);
  REQUIRE(data.fixes.size() == 2);
  const GeodeticFix& first = data.fixes.front();
  CHECK(decimal_seconds(first.stamp) == "1700000000.440000000");
  CHECK(first.latitude_deg == 52.27);
  CHECK(first.longitude_deg == 10.53);
  CHECK(*first.speed_mps == 10);
  CHECK(*first.speed_sigma_mps == 0.5);
  CHECK(*first.course_rad == Approx(90 * kDegree));
  // A radius of 68 %, read as drms: 2 m / sqrt(2) on each axis.
  CHECK(first.covariance_en(0, 0) == Approx(2));
  CHECK(data.fixes.back().covariance_en(0, 0) == 16);
  CHECK(data.kinds.at("GPS") == 3);
  CHECK(data.kinds.at("FLP") == 1);
  REQUIRE(data.corrupt == 1);
  CHECK_THAT(data.corrupt_examples.front(), Contains("phone.txt:15:9: "));

  request.where = RowFilter{"Provider", "FLP", true};
  const LogData fused = reader.read(kPhone, "phone.txt", request);
  REQUIRE(fused.fixes.size() == 1);
  CHECK(fused.fixes.front().latitude_deg == 52.28);
  // GPS time began at Unix second 315964800 and is 18 s ahead of UTC.
  request.time_scale = TimeScale::gps;
  CHECK(decimal_seconds(reader.read(kPhone, "phone.txt", request).fixes.front().stamp) == "1384035218.440000000");
}

TEST_CASE("gnss_logger: the names of the first versions of the app") {
  const std::string log =
      "# Fix,Provider,Latitude,Longitude,Altitude,Speed,Accuracy,(UTC)TimeInMs\n"
      "Fix,gps,52.27,10.53,120.5,10.0,2.0,1500000000000\n";
  const LogData data = GnssLoggerReader().read(log, "phone.txt", fixes());
  REQUIRE(data.fixes.size() == 1);
  CHECK(*data.fixes.front().speed_mps == 10);
}

TEST_CASE("gnss_logger: a log without the fixes that are asked for names what it has") {
  const std::string names = "# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AccuracyMeters,UnixTimeMillis\n";
  const auto complaint = [](const std::string& log) -> std::string {
    try {
      (void)GnssLoggerReader().read(log, "phone.txt", fixes());
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  };
  CHECK(complaint(names + "Fix,FLP,52,10,3,1700000000440\n") ==
        "phone.txt: no fix of the provider that is read; the log has FLP (1): state for example "
        "'where: Provider == FLP'");
  CHECK(complaint(names + "Raw,1,2\n") ==
        "phone.txt: the log has no line 'Fix,...'; its raw measurements are not read");
  CHECK_THAT(complaint("Fix,GPS,52,10,3,1700000000440\n"), Contains("phone.txt:1: a fix before the comment"));
}

TEST_CASE("vbo: minutes of arc, positive to the west, UTC times of day with the date of the file") {
  const VboReader reader;
  CHECK(reader.recognise(kRace).certainty > 0.9);
  LogRequest request = fixes();
  request.default_sigma_m = 3;
  const LogData data = waymark_test::check_pieces(reader, kRace, "race.vbo", request);
  REQUIRE(data.fixes.size() == 2);
  const GeodeticFix& first = data.fixes.front();
  CHECK(decimal_seconds(first.stamp) == "1627294456.000000000");  // date -u -d "2021-07-26 10:14:16" +%s
  CHECK(first.latitude_deg == Approx(3119.09973 / 60).epsilon(1e-14));
  CHECK(first.longitude_deg == Approx(10.53).epsilon(1e-14));
  CHECK(*first.speed_mps == Approx(10));
  CHECK(data.fixes.back().longitude_deg == Approx(-58.49277 / 60).epsilon(1e-14));
  CHECK(data.without_fix == 1);
  CHECK(data.records == 3);
  CHECK_THAT(data.notes.front(), Contains("the date is that of the file's first line"));
  request.date = Stamp{0};
  CHECK(decimal_seconds(reader.read(kRace, "race.vbo", request).fixes.front().stamp) == "36856.000000000");
}

TEST_CASE("vbo: a file without names, and a row that is damaged") {
  const auto read = [](const std::string& log) {
    LogRequest request = fixes();
    request.default_sigma_m = 3;
    return VboReader().read(log, "race.vbo", request);
  };
  CHECK_THROWS_MATCHES(read("[header]\n[data]\n008 101416.00\n"), InputError,
                       Message("race.vbo:3: data before the section '[column names]'"));
  CHECK_THROWS_MATCHES(read("[header]\n"), InputError,
                       Message("race.vbo: the file has no section '[column names]'"));
  const LogData data = read(kRace + "008 1014xx.25 +03119.10973 +00058.49277 072.000 270.00 +00120.50\n");
  REQUIRE(data.corrupt == 1);
  CHECK_THAT(data.corrupt_examples.front(), Contains("race.vbo:22:5: "));
}

}  // namespace tables_inside_test

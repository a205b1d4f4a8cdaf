#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/gpx/gpx.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "support/skip.hpp"

namespace gpx_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

const std::string kOpen =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<gpx version=\"1.1\" creator=\"test\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n<trk><trkseg>\n";
const std::string kClose = "</trkseg></trk></gpx>\n";
const std::string kPoint =
    "<trkpt lat=\"50.5\" "
    "lon=\"17.25\"><ele>468.5</ele><time>2008-06-21T19:15:56.250Z</time><course>90</course>"
    "<speed>12.5</speed><hdop>0.8</hdop></trkpt>\n";

LogRequest hdop_request() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.range_error_m = 5;
  return request;
}

LogData decode(const std::string& text, const LogRequest& request = hdop_request()) {
  const auto decoder = GpxReader().open("run.gpx", request);
  decoder->take(text);
  decoder->finish();
  return decoder->data();
}

std::string first_complaint(const std::string& text, const LogRequest& request = hdop_request()) {
  return decode(text, request).corrupt_examples.at(0);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

}  // namespace

TEST_CASE("gpx: a track point of 1.0") {
  const LogData data = decode(kOpen + kPoint + kClose);
  REQUIRE(data.fixes.size() == 1);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.stamp.nanoseconds == 1'214'075'756'250'000'000);  // date -u -d 2008-06-21T19:15:56 +%s
  CHECK(fix.latitude_deg == 50.5);
  CHECK(fix.longitude_deg == 17.25);
  CHECK(fix.height_m == 468.5);
  CHECK(*fix.speed_mps == 12.5);
  CHECK(*fix.course_rad == Approx(std::numbers::pi / 2));
  CHECK(!fix.course_sigma_rad);
  CHECK(fix.covariance_en(0, 0) == Approx(16));  // (0.8 * 5 m)^2
  CHECK(fix.covariance_en(0, 1) == 0);
  CHECK(fix.line == 4);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"trkpt", 1}});
  CHECK(data.notes ==
        std::vector<std::string>{
            "run.gpx: heights are elevations as GPX has them, as a rule above the geoid",
            "run.gpx: 1 fixes have only HDOP, which is multiplied by the stated range error of 5 m"});
}

TEST_CASE("gpx: speed and course of 1.1 stand in extensions, under any prefix") {
  const std::string point =
      "<trkpt lat=\"50.5\" "
      "lon=\"17.25\"><ele>400</ele><time>2008-06-21T19:15:56Z</time><geoidheight>42</geoidheight>"
      "<hdop>1</hdop><extensions><ns3:TrackPointExtension><ns3:speed> "
      "2.6\n</ns3:speed><ns3:course>180</ns3:course>"
      "<ns3:time>soon</ns3:time></ns3:TrackPointExtension></extensions></trkpt>\n";
  const LogData data = decode(kOpen + point + kClose);
  REQUIRE(data.fixes.size() == 1);
  CHECK(*data.fixes[0].speed_mps == 2.6);
  CHECK(*data.fixes[0].course_rad == Approx(std::numbers::pi));
  CHECK(data.fixes[0].height_m == 442);
}

TEST_CASE("gpx: what a telephone does not know is negative, what a receiver has not fixed is none") {
  const LogData unknown = decode(kOpen + replaced(replaced(kPoint, "12.5", "-1"), ">90<", ">-1<") + kClose);
  CHECK(!unknown.fixes.at(0).speed_mps);
  CHECK(!unknown.fixes.at(0).course_rad);
  const LogData without = decode(kOpen + kPoint + replaced(kPoint, "<ele>", "<fix>none</fix><ele>") + kClose);
  CHECK(without.fixes.size() == 1);
  CHECK(without.without_fix == 1);
}

TEST_CASE("gpx: points of routes and waypoints are counted, not read") {
  const LogData data = decode(kOpen + kPoint +
                              "</trkseg></trk><wpt lat=\"1\" lon=\"2\"><time>x</time></wpt><rte><rtept "
                              "lat=\"1\" lon=\"2\"/><rtept lat=\"1\" lon=\"2\"/></rte></gpx>");
  CHECK(data.records == 1);
  CHECK(data.corrupt == 0);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"rtept", 2}, {"trkpt", 1}, {"wpt", 1}});
  CHECK(data.notes.at(0) == "run.gpx: 2 route points and 1 waypoints were skipped: they record no drive");
}

TEST_CASE("gpx: accuracy is HDOP times a stated error, else the stated default, else missing") {
  LogRequest request;
  CHECK(first_complaint(kOpen + kPoint + kClose, request) ==
        "run.gpx:4:1: trkpt: the log has no accuracy but HDOP: state 'range_error', which is "
        "multiplied by HDOP, or 'accuracy: {default_sigma: ...}'");
  CHECK(first_complaint(kOpen + replaced(kPoint, "<hdop>0.8</hdop>", "") + kClose, request) ==
        "run.gpx:4:1: trkpt: the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'");
  request.default_sigma_m = 3;
  CHECK(decode(kOpen + kPoint + kClose, request).fixes.at(0).covariance_en(1, 1) == 9);
  request.default_sigma_m = 0;
  request.stream = StreamKind::truth;
  CHECK(decode(kOpen + kPoint + kClose, request).truth.at(0).longitude_deg == 17.25);
}

TEST_CASE("gpx: what is wrong with a point is said with its place") {
  const auto complaint = [](const std::string& what, const std::string& with) {
    return first_complaint(kOpen + replaced(kPoint, what, with) + kClose);
  };
  CHECK(complaint("lat=\"50.5\"", "lat=\"95\"") == "run.gpx:4:1: trkpt: lat: 95 is outside -90 .. 90");
  CHECK(complaint("lat=\"50.5\"", "") == "run.gpx:4:1: trkpt: without lat and lon");
  CHECK(complaint("<time>2008-06-21T19:15:56.250Z</time>", "") == "run.gpx:4:1: trkpt: without a time");
  CHECK(complaint("2008-06-21", "2008-06-31") ==
        "run.gpx:4:1: trkpt: time: expected an ISO 8601 date, got '2008-06-31T19:15:56.250Z'");
  CHECK(complaint("12.5", "fast") == "run.gpx:4:1: trkpt: speed: expected a number, got 'fast'");
  CHECK(complaint(">90<", ">1e300<") == "run.gpx:4:1: trkpt: course: 1e+300 is outside 0 .. 360");
}

TEST_CASE("gpx: of malformed XML the points before the place are used") {
  const auto data =
      decode(kOpen + kPoint + kPoint + "<trkpt lat=\"50.5\" lon=\"17.25\"><ele>1</trkpt>" + kPoint);
  CHECK(data.fixes.size() == 2);
  CHECK(data.records == 3);
  CHECK(data.corrupt_examples ==
        std::vector<std::string>{
            "run.gpx:6:39: the XML is not well-formed: mismatched tag; the part before is used"});
  CHECK(decode(kOpen + kPoint).corrupt_examples ==
        std::vector<std::string>{
            "run.gpx:5:1: the XML is not well-formed: no element found; the part before is used"});
  CHECK_THROWS_MATCHES(GpxReader().read("", "run.gpx", {}), InputError,
                       Message("run.gpx: none of 1 records could be used; first: run.gpx:1:1: the "
                               "XML is not well-formed: no element found; the part before is used"));
  CHECK_THROWS_MATCHES(decode("<kml><trkpt/></kml>"), InputError,
                       Message("run.gpx: the root element is 'kml', expected 'gpx'"));
}

TEST_CASE("gpx: a document that is built to exhaust memory ends the reading") {
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE lolz [<!ENTITY lol \"lol\"><!ENTITY lol2 "
      "\"&lol;&lol;\">]><gpx>&lol2;</gpx>";
  CHECK(
      first_complaint(bomb) ==
      "run.gpx:1:37: a document type declaration, which could define endless text; the part before is used");
  std::string deep = kOpen + kPoint;
  for (int i = 0; i < 100; ++i) deep += "<a>";
  CHECK(decode(deep).fixes.size() == 1);
  CHECK(first_complaint(deep) ==
        "run.gpx:5:184: elements are nested more than 64 deep; the part before is used");
  CHECK(first_complaint(kOpen + kPoint + "<name x=\"" + std::string(3'000'000, 'x')) ==
        "run.gpx:5:1: a tag of more than 1 MiB; the part before is used");
  std::string names = kOpen + kPoint;
  for (int i = 0; i < 1100; ++i) names += "<n" + std::to_string(i) + "/>\n";
  CHECK(decode(names).fixes.size() == 1);
  // trk, trkseg, version, creator and xmlns are names of theirs too.
  CHECK(first_complaint(names).ends_with(
      ":1: more than 1000 different names that GPX does not have; the part before is used"));
  // A long text is no number, and is not kept.
  const std::string text = kOpen + replaced(kPoint, "12.5", std::string(5'000'000, '1')) + kPoint + kClose;
  CHECK(decode(text).fixes.size() == 1);
  CHECK(first_complaint(text) ==
        "run.gpx:4:1: trkpt: speed: expected a number, got '1111111111111111111111111111111111111111...'");
}

TEST_CASE("gpx: a request that it cannot meet is refused") {
  LogRequest request;
  request.stream = StreamKind::odometry;
  CHECK_THROWS_MATCHES(
      decode(kOpen, request), InputError,
      Message("run.gpx: a GPX track holds no odometry; it gives the streams gnss and truth"));
}

TEST_CASE("gpx: pieces of any length give the same") {
  const std::string text =
      kOpen + kPoint + replaced(kPoint, "12.5", "x") + "<wpt/>" + kPoint + "<trkpt></trk>";
  waymark_test::check_pieces(GpxReader(), text, "run.gpx", hdop_request());
}

TEST_CASE("gpx: it is known by its root element") {
  CHECK(GpxReader().recognise(kOpen).certainty == 1);
  CHECK(GpxReader().recognise("\xEF\xBB\xBF<gpx>").evidence == "an XML document with the element <gpx>");
  CHECK(GpxReader().recognise("<kml>").certainty == 0);
  CHECK(GpxReader().recognise("<gpxish>").certainty == 0);
  CHECK(GpxReader().recognise("text <gpx>").certainty == 0);
  CHECK(GpxReader().recognise("").certainty == 0);
}

TEST_CASE("gpx: a real track, its points in order and within its bounds") {
  const auto path = waymark_test::shared_data("logs/gpx/gpsbabel_datalog.gpx");
  if (!path) return;
  const std::string text = read_text_file(*path);
  std::size_t points = 0;
  for (std::size_t at = text.find("<trkpt"); at != std::string::npos; at = text.find("<trkpt", at + 1))
    ++points;
  const LogData data = decode(text);
  CHECK(data.corrupt == 0);
  REQUIRE(data.fixes.size() == points);
  CHECK(data.fixes.front().stamp == *stamp_from_iso8601("2008-06-21T19:15:56Z"));
  CHECK(data.fixes.front().speed_mps == 0.29);
  CHECK(data.fixes.back().stamp == *stamp_from_iso8601("2008-06-23T09:00:18Z"));
  CHECK(data.fixes.back().height_m == 566.74);
  for (const GeodeticFix& fix : data.fixes) {  // <bounds> of the file
    CHECK(fix.latitude_deg >= 50.2159686);
    CHECK(fix.latitude_deg <= 50.2290632);
    CHECK(fix.longitude_deg >= 17.1044033);
    CHECK(fix.longitude_deg <= 17.1751133);
  }
  CHECK(GpxReader().recognise(text.substr(0, 65536)).certainty == 1);
}

TEST_CASE("gpx: fix, sat, hdop and ageofdgpsdata are told") {
  const auto told = [](const std::string& members) {
    const std::string point = replaced(kPoint, "<hdop>", members + "<hdop>");
    return decode(kOpen + point + kClose).fixes.at(0).told;
  };
  CHECK(told("<fix>3d</fix>").quality == FixQuality::single);
  CHECK(told("<fix>dgps</fix>").quality == FixQuality::differential);
  CHECK(told("").quality == FixQuality::unknown);
  CHECK(told("<sat>11</sat>").satellites == 11);
  CHECK(told("").satellites == -1);
  CHECK(told("").hdop == 0.8);
  CHECK(told("<ageofdgpsdata>4</ageofdgpsdata>").correction_age_s == 4);
}

}  // namespace gpx_test

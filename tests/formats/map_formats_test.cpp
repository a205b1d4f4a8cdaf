#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/gpx/gpx.hpp>
#include <waymark/formats/text/detail/xml_stream.hpp>
#include <waymark/formats/text/detail/xml_text.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/trajectory/map_formats.hpp>

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Contains;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
/// GPS time of 2023-06-28T14:52:12Z: `date -u -d 2023-06-28T14:52:12 +%s` - 315964800 + 18 leap seconds.
constexpr std::int64_t kGpsInstant = (1'687'963'932 - 315'964'800 + 18) * kSecond;

TrajectoryPoint on_map(std::int64_t nanoseconds, double latitude, double longitude) {
  TrajectoryPoint p;
  p.stamp = Stamp{nanoseconds};
  p.latitude_deg = latitude;
  p.longitude_deg = longitude;
  return p;
}

FixPoint fix_at(std::int64_t nanoseconds, FixStatus status, std::string reason, int source = 0) {
  return {.stamp = Stamp{nanoseconds},
          .latitude_deg = 52.5001,
          .longitude_deg = 13.2501,
          .status = std::string(to_string(status)),
          .reason = std::move(reason),
          .source = source};
}

/// A drive northwards at 10 Hz, some 10 m a second, with a fix of every kind.
struct Drive {
  std::vector<TrajectoryPoint> points;
  std::vector<FixPoint> fixes;
};
Drive drive(std::int64_t first) {
  Drive made;
  for (int i = 0; i <= 40; ++i)
    made.points.push_back(on_map(first + i * kSecond / 10, 52.5 + 1e-5 * i, -13.25 - 1e-7 * i));
  made.fixes = {fix_at(first, FixStatus::accepted, "ok"),
                fix_at(first + kSecond, FixStatus::rejected, "displacement"),
                fix_at(first + 2 * kSecond, FixStatus::withheld, "withheld")};
  return made;
}

/// The content of an XML text, by expat: the count of each element, and its texts.
class Content final : public XmlStream {
 public:
  explicit Content(const std::string& text) {
    take(text);
    finish();
  }
  std::map<std::string, std::vector<std::string>, std::less<>> texts;
  [[nodiscard]] std::size_t count(const std::string& name) const {
    const auto found = texts.find(name);
    return found == texts.end() ? 0 : found->second.size();
  }

 private:
  void begin(std::string_view name, const char**) override {
    open_.emplace_back(name);
    texts[open_.back()].emplace_back();
  }
  void end(std::string_view) override { open_.pop_back(); }
  void text(std::string_view part) override {
    if (!open_.empty()) texts[open_.back()].back() += part;
  }
  std::vector<std::string> open_;
};

/// The rules and symbols of a style for QGIS.
class QgisStyle final : public XmlStream {
 public:
  explicit QgisStyle(const std::string& text) {
    take(text);
    finish();
  }
  std::vector<std::pair<std::string, std::string>> filters;  ///< attribute, its value
  std::vector<std::string> used_symbols;
  std::vector<std::string> symbols;

 private:
  void begin(std::string_view name, const char** attributes) override {
    std::map<std::string, std::string> given;
    for (; *attributes != nullptr; attributes += 2) given[attributes[0]] = attributes[1];
    if (name == "symbol") symbols.push_back(given["name"]);
    if (name != "rule") return;
    used_symbols.push_back(given["symbol"]);
    std::smatch parts;
    REQUIRE(std::regex_match(given["filter"], parts, std::regex("\"(.*)\" = '(.*)'")));
    filters.emplace_back(parts[1], parts[2]);
  }
  void end(std::string_view) override {}
  void text(std::string_view) override {}
};

LogData read_back(const std::string& gpx) {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 1;
  const auto decoder = GpxReader().open("written.gpx", request);
  decoder->take(gpx);
  decoder->finish();
  return decoder->data();
}

}  // namespace

TEST_CASE("GeoJSON: a line of longitude, latitude and marked fixes") {
  const std::vector<TrajectoryPoint> points{on_map(1, 52.5, 13.25), on_map(2, 52.6, 13.35)};
  const std::vector<FixPoint> fixes{
      {.stamp = Stamp{1}, .latitude_deg = 52.5, .longitude_deg = 13.3, .status = "accepted", .reason = "ok"},
      {.stamp = Stamp{1149206567040000001},
       .latitude_deg = 52.7,
       .longitude_deg = 13.4,
       .status = "rejected",
       .reason = "say \"far\""}};
  const auto json = nlohmann::json::parse(trajectory_geojson(points, fixes, "drive \"1\""));
  CHECK(json["type"] == "FeatureCollection");
  REQUIRE(json["features"].size() == 3);
  const auto& line = json["features"][0];
  CHECK(line["geometry"]["type"] == "LineString");
  CHECK(line["geometry"]["coordinates"] == nlohmann::json::parse("[[13.25,52.5],[13.35,52.6]]"));
  CHECK(line["properties"]["name"] == "drive \"1\"");
  CHECK_FALSE(json["features"][1]["properties"].contains("marker-color"));
  const auto& rejected = json["features"][2];
  CHECK(rejected["geometry"]["coordinates"] == nlohmann::json::parse("[13.4,52.7]"));
  CHECK(rejected["properties"]["status"] == "rejected");
  CHECK(rejected["properties"]["reason"] == "say \"far\"");
  CHECK(rejected["properties"]["stamp_ns"] == 1149206567040000001);
  CHECK(rejected["properties"].contains("marker-color"));
}

TEST_CASE("maps: the style for QGIS names only attributes of the GeoJSON, and symbols that are there") {
  const Drive made = drive(kGpsInstant);
  const auto json = nlohmann::json::parse(trajectory_geojson(made.points, made.fixes, "drive"));
  const QgisStyle style(trajectory_qml());
  CHECK(style.trouble().empty());  // expat's
  // Each feature of a drive meets one rule.
  std::size_t met = 0;
  for (const auto& feature : json["features"])
    for (const auto& [attribute, value] : style.filters) {
      REQUIRE(json.dump().find("\"" + attribute + "\":") != std::string::npos);
      if (feature["properties"].value(attribute, "") == value) ++met;
    }
  CHECK(style.filters.size() == 4);
  CHECK(met == json["features"].size());
  CHECK(style.used_symbols == style.symbols);
  // 'Cannot apply style to symbol layer with a different geometry type': lines and points share this style.
  CHECK(trajectory_qml().find("layerGeometryType") == std::string::npos);
}

TEST_CASE("maps: GeoJSON of nothing and of one pose is valid") {
  CHECK(nlohmann::json::parse(trajectory_geojson({}, {}, ""))["features"].empty());
  const std::vector<TrajectoryPoint> one{on_map(1, 1, 2)};
  CHECK(nlohmann::json::parse(trajectory_geojson(one, {}, ""))["features"].empty());
}

TEST_CASE("GPX: our own reader finds every pose where and when it was") {
  const Drive d = drive(kGpsInstant + 250'000'001);
  const LogData read = read_back(trajectory_gpx(d.points, d.fixes, "g1", TimeScale::gps));
  CHECK(read.corrupt == 0);
  REQUIRE(read.fixes.size() == d.points.size());
  for (std::size_t i = 0; i < read.fixes.size(); ++i) {
    CHECK(read.fixes[i].stamp == convert(d.points[i].stamp, TimeScale::gps, TimeScale::utc));
    CHECK(std::abs(read.fixes[i].latitude_deg - *d.points[i].latitude_deg) <= 0.51e-9);
    CHECK(std::abs(read.fixes[i].longitude_deg - *d.points[i].longitude_deg) <= 0.51e-9);
  }
  CHECK(read.fixes[0].stamp == stamp_from_iso8601("2023-06-28T14:52:12.250000001Z"));
}

TEST_CASE("GPX: fixes are waypoints that say what became of them") {
  const Drive d = drive(kGpsInstant);
  const Content content(trajectory_gpx(d.points, d.fixes, "g1", TimeScale::gps));
  CHECK(content.trouble().empty());
  CHECK(content.count("wpt") == 3);
  CHECK(content.count("trkpt") == d.points.size());
  CHECK(content.count("time") == d.points.size() + 3);
  CHECK(content.texts.at("type") == std::vector<std::string>{"accepted", "rejected", "withheld"});
  CHECK(content.texts.at("desc") ==
        std::vector<std::string>{"accepted: ok", "rejected: displacement", "withheld"});
}

TEST_CASE("KML: a line, a track in time, folders by status") {
  Drive d = drive(kGpsInstant);
  d.fixes.push_back(fix_at(kGpsInstant + 3 * kSecond, FixStatus::rejected, "angle"));
  const Content content(trajectory_kml(d.points, d.fixes, "g1", TimeScale::gps));
  CHECK(content.trouble().empty());
  CHECK(content.count("LineString") == 2);  // fused, raw
  CHECK(content.count("Folder") == 3);
  CHECK(content.count("Point") == 4);
  CHECK(content.count("Track") == 1);
  CHECK(content.count("coord") == 5);  // 4 s, a pose a second
  CHECK(content.count("when") == 5 + 4);
  CHECK(content.texts.at("when")[0] == "2023-06-28T14:52:12Z");
  CHECK(content.texts.at("coord")[1] == "-13.250001000 52.500100000 0");
  CHECK(content.texts.at("coordinates")[0].starts_with("\n-13.250000000,52.500000000\n"));
  const auto& said = content.texts.at("description");
  CHECK(std::count(said.begin(), said.end(), "rejected: displacement, 2023-06-28T14:52:13Z") == 1);
  const std::vector<std::string> folders = {"fixes accepted", "fixes rejected", "fixes withheld"};
  for (const std::string& folder : folders) {
    const auto& names = content.texts.at("name");
    CHECK(std::count(names.begin(), names.end(), folder) == 1);
  }
}

TEST_CASE("KML: each receiver has a line of its own") {
  Drive d = drive(kGpsInstant);
  for (int i = 3; i < 6; ++i)
    d.fixes.push_back(fix_at(kGpsInstant + i * kSecond, FixStatus::accepted, "ok", 1));
  const Content content(trajectory_kml(d.points, d.fixes, "g1", TimeScale::gps));
  CHECK(content.count("LineString") == 3);
  const auto& names = content.texts.at("name");
  CHECK(std::count(names.begin(), names.end(), "raw GNSS, receiver 2") == 1);
}

TEST_CASE("maps: seconds of a week are no dates, and one of them leaves the file without times") {
  Drive d = drive(GENERATE(100'000 * kSecond, kGpsInstant));
  d.fixes.front().stamp = Stamp{100'000 * kSecond};
  const Content gpx(trajectory_gpx(d.points, d.fixes, "g1", TimeScale::gps));
  CHECK(gpx.trouble().empty());
  CHECK(gpx.count("time") == 0);
  CHECK(gpx.count("trkpt") == d.points.size());
  const Content kml(trajectory_kml(d.points, d.fixes, "g1", TimeScale::gps));
  CHECK(kml.trouble().empty());
  CHECK(kml.count("when") == 0);
  CHECK(kml.count("Track") == 0);
  CHECK(kml.texts.at("description")[0] == "accepted: ok, 100000.000000000 s");
}

TEST_CASE("maps: stamps at the ends of 64 bits are no dates") {
  const std::vector<TrajectoryPoint> points{on_map(std::numeric_limits<std::int64_t>::min(), 1, 2),
                                            on_map(std::numeric_limits<std::int64_t>::max(), 1, 2)};
  for (const TimeScale scale : {TimeScale::gps, TimeScale::utc, TimeScale::unix_time})
    CHECK(Content(trajectory_gpx(points, {}, "", scale)).count("time") == 0);
}

TEST_CASE("maps: any text leaves the XML well-formed") {
  Drive d = drive(kGpsInstant);
  const std::string rude = "a<b>&\"c\" ]]> \x01\xFF\xED\xA0\x80 \xC3\xA9";
  d.fixes[1].reason = rude;
  for (const std::string& text : {trajectory_kml(d.points, d.fixes, rude, TimeScale::gps),
                                  trajectory_gpx(d.points, d.fixes, rude, TimeScale::gps)}) {
    const Content content(text);
    CHECK(content.trouble().empty());
    CHECK(content.texts.at("name")[0] ==
          "a<b>&\"c\" ]]> \xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD \xC3\xA9");
  }
}

TEST_CASE("maps: maps of nothing and of one pose are well-formed") {
  const std::vector<TrajectoryPoint> one{on_map(kGpsInstant, 1, 2)};
  for (const auto& points : {std::vector<TrajectoryPoint>(), one}) {
    CHECK(Content(trajectory_kml(points, {}, "", TimeScale::gps)).trouble().empty());
    CHECK(Content(trajectory_gpx(points, {}, "", TimeScale::gps)).trouble().empty());
  }
}

TEST_CASE("maps: a place that is none is an error that names the point") {
  const std::vector<TrajectoryPoint> no_place{on_map(1, 1, 2), TrajectoryPoint()};
  const std::vector<FixPoint> bad_fix{
      {.stamp = {}, .latitude_deg = std::nan(""), .longitude_deg = 0, .status = "", .reason = ""}};
  CHECK_THROWS_WITH(trajectory_geojson(no_place, {}, ""), Contains("no latitude and longitude"));
  CHECK_THROWS_AS(trajectory_geojson({}, bad_fix, ""), OutputError);
  CHECK_THROWS_WITH(trajectory_kml(no_place, {}, "", TimeScale::gps),
                    "KML: pose 2 at 0.000000000 s: no latitude and longitude");
  CHECK_THROWS_WITH(trajectory_gpx({}, bad_fix, "", TimeScale::gps),
                    "GPX: fix 1 at 0.000000000 s: latitude or longitude not finite");
}

TEST_CASE("maps: dates are written as they are read") {
  CHECK(iso8601_from_stamp(Stamp{0}) == "1970-01-01T00:00:00Z");
  CHECK(iso8601_from_stamp(Stamp{-1}) == "1969-12-31T23:59:59.999999999Z");
  CHECK(iso8601_from_stamp(Stamp{1'214'075'756'250'000'000}) == "2008-06-21T19:15:56.25Z");
  for (const std::int64_t ns : {1'687'963'932'000'000'007LL, 951'782'400'120'000'000LL, -7LL})  // a leap day
    CHECK(stamp_from_iso8601(iso8601_from_stamp(Stamp{ns})) == Stamp{ns});
}

TEST_CASE("XML text: what the format takes stays as it is") {
  CHECK(xml_text("tab\t line\n caf\xC3\xA9 \xF0\x9F\x98\x80") == "tab\t line\n caf\xC3\xA9 \xF0\x9F\x98\x80");
  CHECK(xml_text("<a href='x'>&amp;") == "&lt;a href=&#39;x&#39;&gt;&amp;amp;");
  CHECK(xml_text(std::string_view("\0", 1)) == "\xEF\xBF\xBD");
  CHECK(xml_text("\xC0\xAF") == "\xEF\xBF\xBD\xEF\xBF\xBD");  // a slash that is too long
  CHECK(xml_text("\xE2\x82") == "\xEF\xBF\xBD\xEF\xBF\xBD");  // cut off
}

// Roads and buildings of a GeoJSON file, and what is refused.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/map/geojson_map.hpp>

namespace geojson_map_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Contains;

namespace {

std::vector<MapWay> ways_of(const std::string& text) {
  std::vector<MapWay> ways;
  const std::size_t count =
      read_geojson_map(text, "m.geojson", [&](MapWay&& way) { ways.push_back(std::move(way)); });
  CHECK(count == ways.size());
  return ways;
}

std::string feature(const std::string& properties, const std::string& type, const std::string& coordinates) {
  return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": {"type": ")" + type +
         R"(", "coordinates": )" + coordinates + "}}";
}

std::string collection(const std::vector<std::string>& features) {
  std::string text = R"({"type": "FeatureCollection", "features": [)";
  for (const std::string& one : features) text += (&one == features.data() ? "" : ", ") + one;
  return text + "]}";
}

const std::string kLine = "[[13.1, 52.1], [13.2, 52.2, 40]]";
const std::string kRing = "[[[13, 52], [13.1, 52], [13.1, 52.1], [13, 52]]]";

}  // namespace

TEST_CASE("geojson map: lines are roads and rings are buildings, with longitude first") {
  const auto ways = ways_of(collection({feature("{}", "LineString", kLine), feature("null", "Polygon", kRing),
                                        feature("{}", "Point", "[13, 52]")}));
  REQUIRE(ways.size() == 2);
  CHECK(ways[0].kind == WayKind::road);
  REQUIRE(ways[0].points.size() == 2);
  CHECK(ways[0].points[1] == Eigen::Vector2d(13.2, 52.2));
  CHECK(ways[1].kind == WayKind::building);
  CHECK(ways[1].points.size() == 4);
}

TEST_CASE("geojson map: several lines and holes are ways of their own, a collection is read in depth") {
  const std::string two = "[" + kLine + ", " + kLine + "]";
  CHECK(ways_of(feature("{}", "MultiLineString", two)).size() == 2);
  const std::string ring = kRing.substr(1, kRing.size() - 2);
  const auto holed = ways_of(feature("{}", "MultiPolygon", "[[" + ring + ", " + ring + "], [" + ring + "]]"));
  CHECK(holed.size() == 3);
  CHECK(holed[2].kind == WayKind::building);
  const auto within =
      ways_of(R"({"type": "GeometryCollection", "geometries": [
    {"coordinates": )" +
              kRing + R"(, "type": "Polygon"}, {"type": "LineString", "coordinates": )" + kLine + "}]}");
  REQUIRE(within.size() == 2);
  CHECK(within[0].kind == WayKind::building);  // its type comes after its coordinates
  CHECK(within[1].kind == WayKind::road);
}

TEST_CASE("geojson map: tags of OpenStreetMap decide, wherever they stand") {
  const auto kinds = [](const std::string& properties, const std::string& type, const std::string& where) {
    return ways_of(collection({feature("{}", "LineString", kLine), feature(properties, type, where)}))
               .size() -
           1;
  };
  CHECK(kinds(R"({"landuse": "forest"})", "Polygon", kRing) == 0);
  CHECK(kinds(R"({"landuse": "retail", "building": "yes"})", "Polygon", kRing) == 1);
  CHECK(kinds(R"({"landuse": null, "building": "no"})", "Polygon", kRing) == 1);  // says nothing else
  CHECK(kinds(R"({"waterway": "river"})", "LineString", kLine) == 0);
  CHECK(kinds(R"({"building": "yes"})", "LineString", kLine) == 0);  // its outline, as osmium exports it
  CHECK(kinds(R"({"railway": "tram", "highway": "residential"})", "LineString", kLine) == 1);
  const std::string later = R"({"type": "Feature", "geometry": {"type": "LineString", "coordinates": )" +
                            kLine + R"(}, "properties": {"waterway": "river", "coordinates": ["a"]}})";
  CHECK(ways_of(collection({feature("{}", "Polygon", kRing), later})).size() == 1);
  const auto area = ways_of(feature(R"({"highway": "pedestrian"})", "Polygon", kRing));
  CHECK(area[0].kind == WayKind::road);
}

TEST_CASE("geojson map: a refusal has a place and a remedy") {
  const auto refused = [](const std::string& text, const std::string& why) {
    INFO(text.substr(0, 80));
    CHECK_THROWS_AS(ways_of(text), InputError);
    CHECK_THROWS_WITH(ways_of(text), Contains(why));
  };
  refused("", "m.geojson:1:1: is no JSON");
  refused("{\"type\": \"Feature\",\n \"geometry\": }", "m.geojson:2:14: is no JSON");
  refused("{\"a\x7f\n", "?");  // nothing that steers a terminal
  refused("[1, 2]", "neither roads nor buildings (0 features)");
  refused(collection({feature("{}", "Point", "[13, 52]")}), "neither roads nor buildings (1 features)");
  refused("\n" + feature("{}", "LineString", "[[390000, 5800000], [390001, 5800000]]"),
          "[390000, 5800000] is no longitude and latitude in degrees; convert the file to WGS84");
  refused("\n" + feature("{}", "LineString", "[[390000, 5800000]]"), "m.geojson:2:");
  refused(feature("{}", "LineString", "[[52.1, 113.1], [52, 113]]"), "ogr2ogr");  // latitude first
  refused(feature("{}", "LineString", R"([["13", 52]])"), "something else than numbers");
  refused(feature("{}", "LineString", "[[{}]]"), "an object among coordinates");
  refused(feature("{}", "LineString", "[[13]]"), "fewer than two numbers");
  refused(feature("{}", "LineString", "[[1,2,3,4,5,6,7,8,9,10]]"), "more than 9 numbers");
  refused(feature("{}", "LineString", "[[13, 1e999]]"), "is no JSON");
}

TEST_CASE("geojson map: nesting without end and cut files are refused, whatever was read before") {
  CHECK_THROWS_WITH(ways_of(std::string(100'000, '[')), Contains("nested more than 100 deep"));
  CHECK_THROWS_WITH(ways_of("{\"coordinates\": " + std::string(100'000, '[')),
                    Contains("nested more than 100 deep"));
  const std::string whole = collection({feature(R"({"highway": "path"})", "LineString", kLine)});
  REQUIRE(ways_of(whole).size() == 1);
  for (std::size_t length = 0; length < whole.size(); ++length)
    CHECK_THROWS_AS(ways_of(whole.substr(0, length)), InputError);
}

}  // namespace geojson_map_test

// `--map`: an extract of a map beneath the trajectory of a report.
#include <catch2/catch.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace {

const std::string kBegin = R"({"type": "FeatureCollection", "features": [)";

/// A road as GeoJSON, from a place to 0.002 degrees east of it.
std::string road(double longitude, double latitude) {
  return kBegin +
         R"({"type": "Feature", "properties": {"highway": "primary"}, "geometry": {"type": "LineString",
    "coordinates": [[)" +
         std::to_string(longitude) + ", " + std::to_string(latitude) + "], [" +
         std::to_string(longitude + 0.002) + ", " + std::to_string(latitude) + "]]}}]}";
}

}  // namespace

TEST_CASE("map: roads near the drive are in the page, in run and in evaluate") {
  const std::string folder = fresh_folder();
  const std::string map = write_text(folder + "town.geojson", road(13.3735, 52.5055));  // crosses the drive
  const RunResult result = run({"run", bundled_drive(), "-o", folder + "out", "-m", "g2", "--map", map});
  REQUIRE(result.code == 0);
  CHECK(contains(read_text(folder + "out/report.html"), "\"name\":\"roads\""));
  CHECK(contains(read_text(folder + "out/figures/report-trajectory.csv"), "\nroads,"));
  const RunResult again =
      run({"evaluate", folder + "out/g2.fused.graph", "-o", folder + "again", "--map", map});
  REQUIRE(again.code == 0);
  CHECK(contains(read_text(folder + "again/report.html"), "\"name\":\"roads\""));
}

TEST_CASE("map: a wrong map is refused before anything is written") {
  const std::string folder = fresh_folder();
  const auto refused = [&](const std::string& map, const std::string& why) {
    check_refused(run({"run", bundled_drive(), "-o", folder + "out", "-m", "g2", "--map", map}), 3, why);
    CHECK_FALSE(exists(folder + "out"));
  };
  refused(folder + "gone.geojson", "gone.geojson: cannot read");
  refused(write_text(folder + "far.geojson", road(11.5, 48.1)),
          "none of its 1 roads and buildings is near the drive, which is at longitude 13.3");
  refused(write_text(folder + "cut.geojson", kBegin), "cut.geojson:1:");
  refused(write_text(folder + "grid.geojson", road(390'000, 5'800'000)), "convert the file to WGS84");
  refused(write_text(folder + "deep.geojson", std::string(100'000, '[')), "nested more than 100 deep");
  refused(write_text(folder + "empty.geojson", kBegin + "]}"), "has neither roads nor buildings");
}

TEST_CASE("map: a drive in a frame of its own has no place for a map") {
  const std::string folder = fresh_folder();
  const std::string map = write_text(folder + "town.geojson", road(13.3735, 52.5055));
  REQUIRE(run({"run", bundled_drive(), "-o", folder + "out", "-m", "g2"}).code == 0);
  std::string text = read_text(folder + "out/g2.fused.graph");
  const std::size_t frame = text.find("\nFRAME ");
  REQUIRE(frame != std::string::npos);
  text.erase(frame, text.find('\n', frame + 1) - frame);
  const std::string graph = write_text(folder + "local.graph", text);
  check_refused(run({"evaluate", graph, "-o", folder + "again", "--map", map}), 3, "has no place on Earth");
}

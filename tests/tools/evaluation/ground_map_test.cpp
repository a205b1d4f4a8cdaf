// The map beneath a trajectory: what is near, and how much of it.
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/report/drive/ground_map.hpp>

namespace ground_map_test {

using namespace waymark;
using report::GroundMap;
using Line = std::vector<Eigen::Vector2d>;

namespace {

/// A drive of 2 km to the east.
GroundMap map_of_drive() {
  Line track;
  for (int i = 0; i <= 2000; ++i) track.emplace_back(i, 0);
  return GroundMap(track);
}

}  // namespace

TEST_CASE("ground map: a road is cut where it leaves the drive") {
  GroundMap map = map_of_drive();
  map.add_road({{1000, -50'000}, {1000, 50'000}});  // crosses it with both ends far away
  REQUIRE_FALSE(map.empty());
  const auto series = map.series();
  REQUIRE(series.size() == 1);
  CHECK(series[0].name == "roads");
  CHECK_FALSE(series[0].in_view);
  for (std::size_t i = 0; i < series[0].x.size(); ++i) {
    if (!std::isfinite(series[0].x[i])) continue;
    CHECK(series[0].x[i] == 1000);
    CHECK(std::abs(series[0].y[i]) <= 3 * GroundMap::kNear_m);
  }
  CHECK(series[0].x.size() >= 3);
}

TEST_CASE("ground map: ways far away are left out") {
  GroundMap map = map_of_drive();
  map.add_road({{0, 5000}, {2000, 5000}});
  map.add_building({{0, 5000}, {10, 5000}, {10, 5010}, {0, 5000}});
  CHECK(map.empty());
  map.add_building({{0, 50}, {10, 50}, {10, 60}, {0, 50}});
  CHECK_FALSE(map.empty());
}

TEST_CASE("ground map: a town of a million corners fits on a page") {
  GroundMap map = map_of_drive();
  for (int i = 0; i < 100'000; ++i) {
    const double x = i % 2000;
    const double y = i / 2000 * 5;
    map.add_building({{x, y}, {x + 3, y}, {x + 3, y + 3}, {x, y + 3}, {x, y}});
    map.add_road({{x, y}, {x + 1, y + 2}, {x + 2, y}, {x + 3, y + 2}, {x + 4, y}});
  }
  std::size_t points = 0;
  for (const auto& series : map.series()) points += series.x.size();
  CHECK(points > 0);
  CHECK(points <= GroundMap::kMostPoints);
}

}  // namespace ground_map_test

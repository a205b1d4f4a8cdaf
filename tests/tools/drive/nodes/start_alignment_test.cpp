// The steps of the anchored start, one by one.
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/nodes/start_alignment.hpp>
#include <waymark/types_se2/se2.hpp>

namespace start_alignment_test {

using namespace waymark;
using namespace waymark::drive;

TEST_CASE("alignment: the fixes of one stop are one anchor") {
  Timeline timeline;
  for (int i = 0; i <= 10; ++i) {
    timeline.stamps.push_back(Stamp::from_seconds(i));
    if (i > 0) timeline.intervals.push_back({.speed_mps = i > 3 && i <= 8 ? 0.01 : 5.0, .dt_s = 1});
  }
  std::vector<Fix> fixes(11);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    timeline.fix_node.push_back(i);
    fixes[i].position[0] = static_cast<double>(i);
  }
  fixes[5].position[0] = 1000;
  fixes[10].status = FixStatus::withheld;
  const auto moving_s = start_detail::moving_time(timeline, 0.05);
  CHECK(moving_s == std::vector<double>{0, 1, 2, 3, 3, 3, 3, 3, 3, 4, 5});
  const auto anchors = start_detail::collect_anchors(timeline, fixes, moving_s);
  REQUIRE(anchors.size() == 5);
  CHECK(anchors[3].gnss[0] == 7);  // median of 3 4 1000 6 7 8
  CHECK(anchors[4].node == 9);
}

TEST_CASE("alignment: knots are joined by lines and constant outside") {
  const start_detail::Knots knots{.at = {1, 3, 4}, .value = {10, 20, 0}};
  CHECK(start_detail::evaluate(knots, std::vector<double>{0, 1, 2, 3, 3.5, 9}) ==
        std::vector<double>{10, 10, 15, 20, 10, 0});
  CHECK(start_detail::evaluate({}, std::vector<double>{1}) == std::vector<double>{0});
}

TEST_CASE("alignment: a window that is wrong by half a turn does not change the winding") {
  using start_detail::HeadingWindow;
  std::vector<HeadingWindow> windows;
  for (int k = 0; k < 30; ++k) {
    const double drift = 0.2 * k + (k == 17 ? 3.1 : 0);
    windows.push_back({.moving_s = 10.0 * k, .offset_rad = wrap_angle(drift), .weight = k == 17 ? 0.5 : 1.0});
  }
  start_detail::unwrap_offsets(windows);
  CHECK(windows[29].offset_rad - windows[0].offset_rad == Approx(0.2 * 29));
  CHECK(windows[18].offset_rad - windows[16].offset_rad == Approx(0.4));
  const start_detail::Knots knots = start_detail::smooth_offsets(windows);
  CHECK(std::abs(knots.value[17] - knots.value[16]) < 0.5);
}

TEST_CASE("alignment: the alignment ignores less than half of wild points") {
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (int i = 0; i < 40; ++i) {
    from.emplace_back(8 * i, 20 * std::sin(0.3 * i));
    to.push_back(rotate(1.2, from.back()) + Eigen::Vector2d(100, 200));
    if (i % 4 == 0) to.back() += Eigen::Vector2d(160, -90);
  }
  const auto fit = start_detail::align_robustly(from, to);
  REQUIRE(fit);
  CHECK(fit->rotation_rad == Approx(1.2).margin(0.02));
  CHECK(fit->residual_m < 2);
  CHECK_FALSE(start_detail::align_robustly(std::vector{from[0]}, std::vector{to[0]}));
  CHECK_FALSE(start_detail::align_robustly(std::vector{from[0], from[0]}, std::vector{to[0], to[1]}));
}

}  // namespace start_alignment_test

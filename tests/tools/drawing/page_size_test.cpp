// What a page carries of a long drive, and the drawings for screens of several widths.
#include <cmath>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/drawing/page/page_data.hpp>
#include <waymark/tools/drawing/page/page_size.hpp>
#include <waymark/tools/drawing/page/screens.hpp>

namespace page_size_test {

using namespace waymark;
using namespace waymark::drawing;

namespace {

Figure figure_of(std::size_t points, Motion motion) {
  Figure figure;
  figure.id = "f";
  figure.title = "Title";
  figure.description = "Words.";
  figure.motion = motion;
  Series series{.name = "a"};
  for (std::size_t i = 0; i < points; ++i) {
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(std::sin(0.01 * static_cast<double>(i)));
    series.time.push_back(0.04 * static_cast<double>(i));
  }
  figure.series = {std::move(series)};
  return figure;
}

}  // namespace

TEST_CASE("page size: a drive of 100,000 poses is carried whole") {
  const Figure figure = figure_of(100'000, Motion::map);
  const PageSize size = size_that_fits({&figure});
  CHECK(points_carried(figure.series[0], figure, size) == 100'000);
}

TEST_CASE("page size: a page of three million points is below 5 MB and says what it carries") {
  Page page{.title = "t", .subtitle = "", .summary = "", .sections = {{"s", "S", {}}}, .footer = ""};
  page.sections[0].blocks.emplace_back(figure_of(2'000'000, Motion::map));
  Figure timed = figure_of(1'000'000, Motion::x);
  timed.id = "g";
  page.sections[0].blocks.emplace_back(std::move(timed));
  const std::string html = page_html(page);
  CHECK(html.size() < 5'000'000);
  CHECK(html.find("of 2000000 points") != std::string::npos);
  CHECK(html.find("of 1000000 points") != std::string::npos);
}

TEST_CASE("page size: the kept points of a series have its extremes, of a track its corners") {
  Series line = figure_of(10'000, Motion::x).series[0];
  line.y[4321] = 7;
  line.y[1234] = -7;
  const Series kept = with_points(line, points_that_keep_shape(line, false, 400));
  CHECK(kept.x.size() <= 401);
  CHECK(kept.x.size() == kept.time.size());
  CHECK(*std::max_element(kept.y.begin(), kept.y.end()) == 7);
  CHECK(*std::min_element(kept.y.begin(), kept.y.end()) == -7);
  CHECK(kept.x.front() == 0);
  CHECK(kept.x.back() == 9999);
  // East for 555 m, then north: the corner is no point that a regular choice would find.
  Series track;
  for (int i = 0; i <= 1000; ++i) {
    track.x.push_back(std::min(i, 555));
    track.y.push_back(std::max(i - 555, 0));
  }
  const auto of_track = points_that_keep_shape(track, true, 20);
  CHECK(std::find(of_track.begin(), of_track.end(), std::size_t{555}) != of_track.end());
  CHECK(of_track.size() <= 21);
}

TEST_CASE("page size: points keep their own notes") {
  Series fixes{.name = "fixes", .mark = Mark::points};
  for (int i = 0; i < 100; ++i) {
    fixes.x.push_back(i);
    fixes.y.push_back(0);
    fixes.note.push_back(i % 2 == 0 ? i / 2 : -1);
    if (i % 2 == 0) fixes.notes.push_back("fix " + std::to_string(i));
  }
  const Series kept = with_points(fixes, points_that_keep_shape(fixes, true, 10));
  REQUIRE(kept.x.size() >= 10);
  for (std::size_t i = 0; i < kept.x.size(); ++i) {
    const int number = static_cast<int>(kept.x[i]);
    REQUIRE((kept.note[i] < 0) == (number % 2 == 1));
    if (kept.note[i] >= 0)
      CHECK(kept.notes[static_cast<std::size_t>(kept.note[i])] == "fix " + std::to_string(number));
  }
}

TEST_CASE("screens: every figure is drawn for a telephone, wide ones for a wide screen too") {
  Figure figure = figure_of(100, Motion::map);
  figure.height = 620;
  for (const char* name : {"a series with a long name", "another one", "and a third one that is long"})
    figure.series.push_back({.name = name, .x = {0, 1}, .y = {0, 1}});
  const auto drawings = drawings_for_screens(figure);
  REQUIRE(drawings.size() == 3);
  CHECK(drawings[0].screen == "narrow");
  CHECK(drawings[1].screen == "wide");
  CHECK(drawings[2].screen == "usual");
  CHECK(drawings[2].id == "f");
  Figure drawn = figure;
  for (const DrawingForScreen& drawing : drawings) {
    drawing.apply(drawn);
    const View view = drawn_view(drawn);
    CHECK(view.box.height > 200);
    // A metre is equally long in both directions on each of them.
    CHECK((view.x.high - view.x.low) / view.box.width ==
          Approx((view.y.high - view.y.low) / view.box.height));
  }
  figure.width = 430;
  CHECK(drawings_for_screens(figure).size() == 2);
}

TEST_CASE("figure: what the axes need not hold does not widen them") {
  Figure figure = figure_of(10, Motion::x);
  const Range before = drawn_view(figure).x;
  figure.series.push_back({.name = "far", .x = {-1e6, 1e6}, .y = {0, 1}});
  figure.series.back().in_view = false;
  CHECK(drawn_view(figure).x.low == before.low);
  CHECK(drawn_view(figure).x.high == before.high);
}

TEST_CASE("figure: of a map only the areas in the plot are drawn, each as a closed ring") {
  Figure figure = figure_of(101, Motion::map);
  const double kBreak = std::nan("");
  Series areas{.name = "buildings", .mark = Mark::areas, .look = Look::building};
  areas.x = {10, 20, 20, 10, 10, kBreak, 9010, 9020, 9020, 9010};
  areas.y = {10, 10, 20, 20, 10, kBreak, 10, 10, 20, 20};
  areas.in_view = false;
  figure.series.push_back(areas);
  const std::string svg = figure_svg(figure);
  const std::size_t path = svg.find("class=\"areas look-building\" data-series");
  REQUIRE(path != std::string::npos);
  const std::string drawn = svg.substr(path, svg.find("/>", path) - path);
  CHECK(std::count(drawn.begin(), drawn.end(), 'M') == 1);
  CHECK(std::count(drawn.begin(), drawn.end(), 'Z') == 1);
}

}  // namespace page_size_test

// A figure as SVG and CSV: well-formed whatever it is given, complete, and readable.
#include <cmath>
#include <limits>
#include <set>

#include <catch2/catch.hpp>

#include <waymark/tools/drawing/figure/figure_csv.hpp>
#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>

#include "tools/drawing/xml.hpp"

namespace figure_test {

using namespace waymark;
using namespace waymark::drawing;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Figure with(Series series) {
  Figure figure{.id = "f",
                .title = "A title",
                .description = "A description",
                .x = {.title = "time", .unit = "s"},
                .y = {.title = "error", .unit = "m"},
                .series = {}};
  figure.series.push_back(std::move(series));
  return figure;
}

Series of(Mark mark) {
  return {.name = "a",
          .mark = mark,
          .x = {0, 1, 2},
          .y = {1, 0, 2},
          .low = {0, 0.5, 1},
          .high = {1, 1.5, 2},
          .weight = {0.1, 0.5, 1}};
}

constexpr Mark kMarks[] = {Mark::line, Mark::points, Mark::band, Mark::spans, Mark::bars, Mark::cells};

}  // namespace

TEST_CASE("figure: every mark is drawn, and the document is well-formed") {
  for (const Mark mark : kMarks) {
    const std::string svg = figure_svg(with(of(mark)));
    CAPTURE(svg);
    CHECK(xml_error(svg).empty());
    CHECK(xml_attributes(svg, "path", "d").size() >= 2);  // the grid, and the marks
  }
}

TEST_CASE("figure: a drawing names itself: title and description that its role refers to") {
  const std::string svg = figure_svg(with(of(Mark::line)));
  CHECK(svg.find("<title id=\"f-title\">A title</title>") != std::string::npos);
  CHECK(svg.find("<desc id=\"f-desc\">A description</desc>") != std::string::npos);
  CHECK(svg.find("role=\"img\" aria-labelledby=\"f-title f-desc\"") != std::string::npos);
  CHECK(svg.find("time [s]") != std::string::npos);
  CHECK(svg.find("error [m]") != std::string::npos);
}

TEST_CASE("figure: hostile names and numbers leave a drawing well-formed and without NaN") {
  const std::vector<double> wild = {kNan, kInfinity, -kInfinity, 1e308, -1e308, 5e-324, 0};
  for (const Mark mark : kMarks) {
    for (const bool logarithmic : {false, true}) {
      Series series{.name = "<script>\"&'\x01\xff]]>", .mark = mark};
      series.x = series.y = series.low = series.high = wild;
      series.weight = std::vector<double>(wild.size(), 0.5);
      Figure figure = with(std::move(series));
      figure.title = "a < b & c > \"d\" \xc3\x28";
      figure.x.logarithmic = figure.y.logarithmic = logarithmic;
      const std::string svg = figure_svg(figure);
      CHECK(xml_error(svg).empty());
      CHECK(svg.find("<script>") == std::string::npos);
      for (const std::string& path : xml_attributes(svg, "path", "d")) {
        CHECK(path.find("nan") == std::string::npos);
        CHECK(path.find("inf") == std::string::npos);
      }
    }
  }
}

TEST_CASE("figure: a figure without points is drawn with its axes") {
  const std::string svg = figure_svg(with({.name = "nothing"}));
  CHECK(xml_error(svg).empty());
  CHECK(svg.find("class=\"tick-x\"") != std::string::npos);
}

TEST_CASE("figure: looks are told apart by each of colour, dash, marker and hatching alone") {
  std::set<std::string_view> colours, dashes, markers, hatches;
  for (const LookStyle& look : all_looks()) {
    CHECK(&style_of(look.look) == &look);
    colours.insert(look.colour);
    dashes.insert(look.dash);
    markers.insert(look.marker);
    hatches.insert(look.hatch);
  }
  CHECK(colours.size() == all_looks().size());
  CHECK(dashes.size() == all_looks().size());
  CHECK(markers.size() == all_looks().size());
  CHECK(hatches.size() == all_looks().size());
}

TEST_CASE(
    "figure: text becomes references where markup would begin, and the replacement character where nothing is "
    "meant") {
  CHECK(escaped("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&#39;");
  CHECK(escaped("\xc3\xa9\xe2\x82\xac\xf0\x9f\x9a\x97") == "\xc3\xa9\xe2\x82\xac\xf0\x9f\x9a\x97");
  CHECK(escaped("\xff") == "\xef\xbf\xbd");
  CHECK(escaped("\xe2\x82") == "\xef\xbf\xbd\xef\xbf\xbd");          // cut short
  CHECK(escaped("\xc0\xaf") == "\xef\xbf\xbd\xef\xbf\xbd");          // overlong
  CHECK(escaped("\xed\xa0\x80").find('\xed') == std::string::npos);  // a surrogate
  CHECK(escaped(std::string_view("\0\x1b", 2)) == "\xef\xbf\xbd\xef\xbf\xbd");
}

TEST_CASE("figure: the numbers of a figure read back exactly from its CSV") {
  Series series{.name = "a, \"b\"", .x = {0.1, 1.0 / 3, kNan}, .y = {1e-300, -0.0, 2}};
  series.note = {-1, 0, -1};
  series.notes = {"one\ntwo"};
  const std::string csv = figure_csv(with(series));
  CHECK(csv ==
        "series,time [s],error [m],note\n"
        "\"a, \"\"b\"\"\",0.1,1e-300,\n"
        "\"a, \"\"b\"\"\",0.3333333333333333,-0,\"one\ntwo\"\n"
        "\"a, \"\"b\"\"\",,2,\n");
}

TEST_CASE("figure: columns that only some series have are empty for the others") {
  Figure figure = with({.name = "line", .x = {1}, .y = {2}});
  figure.series.push_back({.name = "span", .mark = Mark::spans, .low = {3}, .high = {4}});
  CHECK(figure_csv(figure) ==
        "series,time [s],error [m],low,high\n"
        "line,1,2,,\n"
        "span,,,3,4\n");
}

}  // namespace figure_test

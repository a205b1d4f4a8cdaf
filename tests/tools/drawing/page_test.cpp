// A page: one file, safe whatever is put in, complete.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/drawing/page/page_data.hpp>

namespace page_test {

using namespace waymark;
using namespace waymark::drawing;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

Figure line_figure(const std::string& id) {
  Figure figure;
  figure.id = id;
  figure.title = "Title";
  figure.description = "Description";
  figure.x = {.title = "time", .unit = "s"};
  figure.y = {.title = "error", .unit = "m"};
  figure.motion = Motion::x;
  Series series{.name = "a"};
  for (int i = 0; i < 200; ++i) {
    series.x.push_back(i);
    series.y.push_back(0.5 * i);
  }
  series.time = series.x;
  figure.series = {std::move(series)};
  return figure;
}

const std::string kHostile = "</script><!-- <img src=x onerror=alert(1)> \"'&";

}  // namespace

TEST_CASE("page: what is put into a page cannot leave its place") {
  Page page{.title = kHostile, .subtitle = kHostile, .summary = kHostile, .sections = {}, .footer = kHostile};
  Figure figure = line_figure("figure");
  figure.title = figure.description = kHostile;
  figure.series[0].name = kHostile;
  figure.series[0].note.assign(200, 0);
  figure.series[0].notes = {kHostile};
  page.sections.push_back(
      {"s",
       kHostile,
       {Paragraph{kHostile},
        text::Table{.title = kHostile, .columns = {kHostile}, .rows = {{kHostile}}, .notes = {kHostile}},
        figure, PageLink{kHostile, kHostile}}});
  const std::string html = page_html(page);
  CHECK(count(html, "</script>") == 2);  // the data's and the script's own
  CHECK(count(html, "<img") == 0);
  CHECK(count(html, "<!--") == 0);
}

TEST_CASE("page: a page refers to nothing outside itself but the files it links") {
  Page page{.title = "t",
            .subtitle = "",
            .summary = "",
            .sections = {{"s", "S", {line_figure("a")}}},
            .footer = ""};
  const std::string html = page_html(page);
  const std::size_t opened_by_click = count(html, "https://www.openstreetmap.org/");
  CHECK(opened_by_click == 1);
  CHECK(count(html, "http") == count(html, "http://www.w3.org/2000/svg") + opened_by_click);
  CHECK(count(html, "<link rel=\"icon\" href=\"data:,\">") == 1);
  CHECK(count(html, "<link") == 1);
  CHECK(count(html, " src=") == 0);
}

TEST_CASE("page: a word of the glossary is explained once, where it is a whole word") {
  Page page{.title = "t", .subtitle = "", .summary = "", .sections = {}, .footer = ""};
  page.glossary = {{"GNSS", "satellites"}, {"raw GNSS", "as logged"}, {"fix", "a \"reading\""}};
  page.sections.push_back(
      {"s", "S", {Paragraph{"The prefix of raw GNSS, and GNSS & a fix."}, Paragraph{"GNSS, a fix."}}});
  const std::string html = page_html(page);
  CHECK(count(html, "<abbr tabindex=\"0\" title=\"as logged\">raw GNSS</abbr>, and <abbr") == 1);
  CHECK(count(html, "title=\"satellites\">GNSS</abbr> &amp; a <abbr") == 1);
  CHECK(count(html, "title=\"a &quot;reading&quot;\">fix</abbr>.") == 1);
  CHECK(count(html, "The prefix of") == 1);
  CHECK(count(html, "<p>GNSS, a fix.</p>") == 1);
}

TEST_CASE("page: a folded table keeps its heading in sight") {
  const Page page{.title = "t",
                  .subtitle = "",
                  .summary = "",
                  .sections = {{"s", "S", {FoldedTable{"3 hashes", {.columns = {""}, .rows = {{"af5c"}}}}}}},
                  .footer = ""};
  const std::string html = page_html(page);
  CHECK(count(html, "<details><summary>3 hashes</summary>") == 1);
  CHECK(count(html, "<td>af5c</td>") == 1);
  CHECK(count(html, "<thead>") == 0);  // a table without headings has no empty row
}

TEST_CASE("page: equal columns of numbers are in a page once") {
  const Figure a = line_figure("a");
  const Figure b = line_figure("b");
  const auto data = nlohmann::json::parse(page_data({&a, &b}, {}));
  CHECK(data["columns"].size() == 2);  // x is time; y
  CHECK(data["figures"]["a"]["series"][0]["x"] == data["figures"]["b"]["series"][0]["time"]);
}

TEST_CASE("page: columns of numbers stand to the right in tables, words to the left") {
  const text::Table table{.columns = {"name", "value [m]", "iterations"},
                          .rows = {{"a", "1.5", "4"}, {"b", "-", "50!"}, {"c", "+3.2", "7"}}};
  const std::string html = page_html(
      {.title = "t", .subtitle = "", .summary = "", .sections = {{"s", "S", {table}}}, .footer = ""});
  CHECK(count(html, "<td class=\"number\">1.5</td>") == 1);
  CHECK(count(html, "<td class=\"number\">50!</td>") == 1);
  CHECK(count(html, "<td>a</td>") == 1);
  CHECK(count(html, "<th scope=\"col\" class=\"number\">value [m]</th>") == 1);
}

TEST_CASE("page: wide figures stand below each other, narrow ones in pairs") {
  std::vector<Figure> figures(4, line_figure("a"));
  for (const std::size_t narrow : {0U, 1U, 3U}) figures[narrow].width = 430;
  Section section;
  add_figures(figures, section);
  REQUIRE(section.blocks.size() == 3);
  CHECK(std::get<FigureRow>(section.blocks[0]).figures.size() == 2);
  CHECK(std::get<Figure>(section.blocks[1]).width == Figure().width);
  CHECK(std::get<FigureRow>(section.blocks[2]).figures.size() == 1);
}

}  // namespace page_test

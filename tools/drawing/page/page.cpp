#include <utility>

#include <fmt/format.h>

#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drawing/figure/figure_csv.hpp>
#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/drawing/page/page_assets.hpp>
#include <waymark/tools/drawing/page/page_data.hpp>

namespace waymark::drawing {
namespace {

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

std::string html(const text::Table& table) {
  std::vector<bool> numbers;
  for (std::size_t c = 0; c < table.columns.size(); ++c) numbers.push_back(text::has_numbers(table, c));
  const auto kind = [&](std::size_t c) {
    return c < numbers.size() && numbers[c] ? " class=\"number\"" : "";
  };
  std::string out = "<div class=\"scroll\"><table>";
  if (!table.title.empty()) out += "<caption>" + escaped(table.title) + "</caption>";
  out += "<thead><tr>";
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    out += fmt::format("<th scope=\"col\"{}>{}</th>", kind(c), escaped(table.columns[c]));
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      out += fmt::format("<td{}>{}</td>", kind(c), escaped(row[c]));
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  for (const std::string& note : table.notes) out += "<p class=\"note\">" + escaped(note) + "</p>\n";
  return out;
}

std::string html(const Figure& figure) {
  return fmt::format(
      "<figure class=\"figure\" id=\"{}\">\n{}<figcaption><span><b>{}.</b> {}</span></figcaption></figure>\n",
      figure.id, inline_svg(figure), escaped(figure.title), escaped(figure.description));
}

std::string html(const PageBlock& block) {
  return std::visit(Overloaded{[](const Paragraph& p) { return "<p>" + escaped(p.text) + "</p>\n"; },
                               [](const PageLink& link) {
                                 return fmt::format("<p><a href=\"{}\">{}</a></p>\n", escaped(link.file),
                                                    escaped(link.text));
                               },
                               [](const FigureRow& row) {
                                 std::string out = "<div class=\"row\">\n";
                                 for (const Figure& figure : row.figures) out += html(figure);
                                 return out + "</div>\n";
                               },
                               [](const auto& other) { return html(other); }},
                    block);
}

std::string head(const Page& page) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}{}</style>\n</head>\n",
      escaped(page.title), kPageStyle, figure_style());
}

std::string body(const Page& page) {
  static constexpr const char* kKinds[] = {"", " better", " worse"};
  std::string out = "<body>\n<main>\n<h1>" + escaped(page.title) + "</h1>\n";
  if (!page.subtitle.empty()) out += "<p class=\"subtitle\">" + escaped(page.subtitle) + "</p>\n";
  if (!page.summary.empty()) {
    out += fmt::format("<p class=\"verdict{}\">{}</p>\n", kKinds[static_cast<int>(page.verdict)],
                       escaped(page.summary));
  }
  out += "<nav aria-label=\"Contents\">";
  for (const Section& section : page.sections)
    out += fmt::format("<a href=\"#{}\">{}</a> ", section.id, escaped(section.title));
  out += "</nav>\n";
  for (const Section& section : page.sections) {
    out += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", section.id, escaped(section.title));
    for (const PageBlock& block : section.blocks) out += html(block);
    out += "</section>\n";
  }
  return out + "</main>\n<footer>" + escaped(page.footer) + "</footer>\n";
}

}  // namespace

void add_figures(std::vector<Figure> figures, Section& section) {
  FigureRow row;
  for (Figure& figure : figures) {
    const bool narrow = figure.width < Figure().width;
    if (!narrow) section.blocks.emplace_back(std::move(figure));
    if (narrow) row.figures.push_back(std::move(figure));
    if (row.figures.size() == 2) section.blocks.emplace_back(std::exchange(row, {}));
  }
  if (!row.figures.empty()) section.blocks.emplace_back(std::move(row));
}

std::vector<const Figure*> figures_of(const Page& page) {
  std::vector<const Figure*> figures;
  for (const Section& section : page.sections) {
    for (const PageBlock& block : section.blocks) {
      if (const auto* figure = std::get_if<Figure>(&block)) figures.push_back(figure);
      if (const auto* row = std::get_if<FigureRow>(&block)) {
        for (const Figure& figure : row->figures) figures.push_back(&figure);
      }
    }
  }
  return figures;
}

std::string page_html(const Page& page) {
  std::string text = head(page) + body(page);
  text += "<script type=\"application/json\" id=\"page-data\">" + page_data(figures_of(page)) + "</script>\n";
  text.append("<script>\n").append(kPageScript).append("</script>\n</body>\n</html>\n");
  return text;
}

std::vector<std::string> write_page(const Page& page, const std::string& folder, const std::string& name) {
  std::vector<std::string> files = {folder + "/" + name + ".html"};
  formats::write_file_atomically(files.front(), page_html(page));
  const std::string figures = folder + "/figures";
  formats::make_folder(figures);
  for (const Figure* figure : figures_of(page)) {
    const std::string stem = fmt::format("{}/{}-{}", figures, name, figure->id);
    formats::write_file_atomically(stem + ".svg", figure_svg(*figure));
    formats::write_file_atomically(stem + ".csv", figure_csv(*figure));
    files.push_back(stem + ".svg");
    files.push_back(stem + ".csv");
  }
  return files;
}

}  // namespace waymark::drawing

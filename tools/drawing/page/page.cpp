#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drawing/figure/figure_csv.hpp>
#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/drawing/page/page_assets.hpp>
#include <waymark/tools/drawing/page/page_data.hpp>
#include <waymark/tools/drawing/page/screens.hpp>

namespace waymark::drawing {
namespace {

/// Writes the blocks of a page in reading order, and explains each word of the glossary once.
class Writer {
 public:
  Writer(const std::vector<std::pair<std::string, std::string>>& glossary, const PageSize& size)
      : words_(glossary), size_(size) {
    // "raw GNSS" is a word of its own, and must be found before "GNSS".
    std::stable_sort(words_.begin(), words_.end(),
                     [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
  }

  /// Returns escaped text with the words that are new in it explained.
  std::string text(const std::string& plain);
  std::string html(const text::Table& table);
  std::string html(const FoldedTable& folded) {
    return "<details><summary>" + text(folded.heading) + "</summary>\n" + html(folded.table) + "</details>\n";
  }
  std::string html(const Figure& figure) {
    std::string svg;
    Figure drawn = figure;
    for (const DrawingForScreen& drawing : drawings_for_screens(figure)) {
      drawing.apply(drawn);
      svg += inline_svg(drawn, drawing.screen);
    }
    return fmt::format(
        "<figure class=\"figure\" id=\"{}\">\n{}<figcaption><span><b>{}.</b> {}</span></figcaption></figure>\n",
        figure.id, svg, text(figure.title), text(figure.description + describe_size(figure)));
  }
  std::string html(const Paragraph& paragraph) { return "<p>" + text(paragraph.text) + "</p>\n"; }
  std::string html(const PageLink& link) {
    return fmt::format("<p><a href=\"{}\">{}</a></p>\n", escaped(link.file), escaped(link.text));
  }
  std::string html(const FigureRow& row) {
    std::string out = "<div class=\"row\">\n";
    for (const Figure& figure : row.figures) out += html(figure);
    return out + "</div>\n";
  }

 private:
  [[nodiscard]] std::string describe_size(const Figure& figure) const;

  std::vector<std::pair<std::string, std::string>> words_;  ///< not explained yet
  PageSize size_;
};

/// Returns the place of a whole word in a text; npos: it is not there.
std::size_t find_word(const std::string& text, const std::string& word) {
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (!(at > 0 && is_letter(at - 1)) && !is_letter(at + word.size())) return at;
  }
  return std::string::npos;
}

std::string Writer::text(const std::string& plain) {
  for (std::size_t i = 0; i < words_.size(); ++i) {
    const std::size_t at = find_word(plain, words_[i].first);
    if (at == std::string::npos) continue;
    const auto [word, meaning] = words_[i];
    words_.erase(words_.begin() + static_cast<std::ptrdiff_t>(i));
    const std::string before = text(plain.substr(0, at));
    return before +
           fmt::format("<abbr tabindex=\"0\" title=\"{}\">{}</abbr>", escaped(meaning), escaped(word)) +
           text(plain.substr(at + word.size()));
  }
  return escaped(plain);
}

/// Says how many points of the longest series are here, if not all are.
std::string Writer::describe_size(const Figure& figure) const {
  std::size_t longest = 0;
  std::size_t carried = 0;
  for (const Series& series : figure.series) {
    const std::size_t length = std::max(series.x.size(), series.low.size());
    if (points_carried(series, figure, size_) == length || length <= longest) continue;
    longest = length;
    carried = points_carried(series, figure, size_);
  }
  if (longest == 0) return {};
  return fmt::format(" The page carries {} of {} points; the CSV in the folder figures has all.", carried,
                     longest);
}

std::string Writer::html(const text::Table& table) {
  std::vector<bool> numbers;
  for (std::size_t c = 0; c < table.columns.size(); ++c) numbers.push_back(text::has_numbers(table, c));
  const auto kind = [&](std::size_t c) {
    return c < numbers.size() && numbers[c] ? " class=\"number\"" : "";
  };
  std::string out = "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"" +
                    escaped(table.title.empty() ? "table" : table.title) + "\"><table>";
  if (!table.title.empty()) out += "<caption>" + text(table.title) + "</caption>";
  const bool named = std::any_of(table.columns.begin(), table.columns.end(),
                                 [](const std::string& column) { return !column.empty(); });
  if (named) {
    out += "<thead><tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      out += table.columns[c].empty()
                 ? "<td class=\"corner\"></td>"  // a heading without words would be read aloud as one
                 : fmt::format("<th scope=\"col\"{}>{}</th>", kind(c), text(table.columns[c]));
    out += "</tr></thead>";
  }
  out += "<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      out += fmt::format("<td{}>{}</td>", kind(c), escaped(row[c]));
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  for (const std::string& note : table.notes) out += "<p class=\"note\">" + text(note) + "</p>\n";
  return out;
}

std::string head(const Page& page) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}{}</style>\n</head>\n",
      escaped(page.title), kPageStyle, figure_style());
}

std::string body(const Page& page, const PageSize& size) {
  static constexpr const char* kKinds[] = {"", " better", " worse"};
  Writer writer(page.glossary, size);
  std::string out = "<body>\n<main>\n<h1>" + escaped(page.title) + "</h1>\n";
  if (!page.subtitle.empty()) out += "<p class=\"subtitle\">" + escaped(page.subtitle) + "</p>\n";
  if (!page.summary.empty()) {
    out += fmt::format("<p class=\"verdict{}\">{}</p>\n", kKinds[static_cast<int>(page.verdict)],
                       writer.text(page.summary));
  }
  out += "<nav aria-label=\"Contents\">";
  for (const Section& section : page.sections)
    out += fmt::format("<a href=\"#{}\">{}</a> ", section.id, escaped(section.title));
  out += "</nav>\n";
  for (const Section& section : page.sections) {
    out += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", section.id, escaped(section.title));
    for (const PageBlock& block : section.blocks)
      out += std::visit([&](const auto& any) { return writer.html(any); }, block);
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
  const std::vector<const Figure*> figures = figures_of(page);
  const PageSize size = size_that_fits(figures);
  std::string text = head(page) + body(page, size);
  text += "<script type=\"application/json\" id=\"page-data\">" + page_data(figures, size) + "</script>\n";
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

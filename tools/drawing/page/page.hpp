/// A page of a report: text, tables and figures in one self-contained HTML file.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::drawing {

struct Paragraph {
  std::string text;
};

/// Figures that are side by side if there is room.
struct FigureRow {
  std::vector<Figure> figures;
};

/// A file beside the page.
struct PageLink {
  std::string file;  ///< relative to the page
  std::string text;
};

/// A table that is folded away until the reader opens it. Paper shows it.
struct FoldedTable {
  std::string heading;  ///< remains visible
  text::Table table;
};

using PageBlock = std::variant<Paragraph, text::Table, FoldedTable, Figure, FigureRow, PageLink>;

struct Section {
  std::string id;  ///< [a-z0-9-]
  std::string title;
  std::vector<PageBlock> blocks;
};

enum class Verdict { none, better, worse };

struct Page {
  std::string title;
  std::string subtitle;
  std::string summary;  ///< a sentence or two with the main result
  Verdict verdict = Verdict::none;
  std::vector<Section> sections;
  std::string footer;  ///< the program that made the page
  /// Words with their meanings. The first use of each is explained where the pointer or the focus
  /// is.
  std::vector<std::pair<std::string, std::string>> glossary{};
};

/// Returns HTML 5 in UTF-8. It includes style, script, drawings and their data, and loads nothing.
/// The drawings are complete without the script; the script moves them and shows values.
[[nodiscard]] std::string page_html(const Page& page);

/// Adds figures: wide ones below each other, narrow ones in pairs.
void add_figures(std::vector<Figure> figures, Section& section);

/// Returns every figure of a page, in order.
[[nodiscard]] std::vector<const Figure*> figures_of(const Page& page);

/// Writes FOLDER/NAME.html, and every figure as FOLDER/figures/NAME-ID.svg and .csv. Returns the
/// names of the files.
/// @throws OutputError
std::vector<std::string> write_page(const Page& page, const std::string& folder, const std::string& name);

}  // namespace waymark::drawing

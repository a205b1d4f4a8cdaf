#include <algorithm>
#include <cmath>
#include <limits>

#include <waymark/formats/text/detail/csv_text.hpp>

#include <waymark/tools/drawing/figure/figure_csv.hpp>

namespace waymark::drawing {
namespace {

/// A column that some series have.
struct Column {
  std::string heading;
  const std::vector<double> Series::*values;
};

std::vector<Column> columns_of(const Figure& figure) {
  const std::vector<Column> all = {{heading(figure.x), &Series::x}, {heading(figure.y), &Series::y},
                                   {"low", &Series::low},           {"high", &Series::high},
                                   {"weight", &Series::weight},     {"time [s]", &Series::time}};
  std::vector<Column> used;
  for (const Column& column : all) {
    const bool has = std::any_of(figure.series.begin(), figure.series.end(),
                                 [&](const Series& s) { return !(s.*column.values).empty(); });
    if (has) used.push_back(column);
  }
  return used;
}

std::size_t length(const Series& series) {
  return std::max({series.x.size(), series.y.size(), series.low.size()});
}

/// Appends the category if the axis has categories, or else the number. The field is empty if the
/// number is undefined.
void append_field(const Figure& figure, const Column& column, double value, std::string& csv) {
  const std::vector<std::string>& rows = figure.y.categories;
  const bool is_row = column.values == &Series::y && value >= 0 && value == std::floor(value) &&
                      value < static_cast<double>(rows.size());
  if (!is_row) return formats::append_csv_number(csv, value);
  csv += ',';
  formats::append_csv_text(csv, rows[static_cast<std::size_t>(value)]);
}

void append_note(const Series& series, std::size_t i, std::string& csv) {
  csv += ',';
  if (i < series.note.size() && series.note[i] >= 0)
    formats::append_csv_text(csv, series.notes[static_cast<std::size_t>(series.note[i])]);
}

}  // namespace

std::string figure_csv(const Figure& figure) {
  const std::vector<Column> columns = columns_of(figure);
  const bool has_notes = std::any_of(figure.series.begin(), figure.series.end(),
                                     [](const Series& s) { return !s.note.empty(); });
  std::string csv = "series";
  for (const Column& column : columns) {
    csv += ',';
    formats::append_csv_text(csv, column.heading);
  }
  csv += has_notes ? ",note\n" : "\n";
  for (const Series& series : figure.series) {
    for (std::size_t i = 0; i < length(series); ++i) {
      formats::append_csv_text(csv, series.name.empty() ? figure.title : series.name);
      for (const Column& column : columns) {
        const std::vector<double>& values = series.*column.values;
        append_field(figure, column, i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN(),
                     csv);
      }
      if (has_notes) append_note(series, i, csv);
      csv += '\n';
    }
  }
  return csv;
}

}  // namespace waymark::drawing

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/report/figure_csv.hpp>

namespace waymark {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

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

/// The category where the column is of the rows of bars, else the number; empty where it is none.
std::string field(const Figure& figure, const Column& column, double value) {
  if (!std::isfinite(value)) return "";
  const std::vector<std::string>& rows = figure.y.categories;
  const bool is_row = column.values == &Series::y && value >= 0 && value == std::floor(value) &&
                      value < static_cast<double>(rows.size());
  return is_row ? quoted(rows[static_cast<std::size_t>(value)]) : fmt::format("{}", value);
}

std::string note_of(const Series& series, std::size_t i) {
  if (i >= series.note.size() || series.note[i] < 0) return "";
  return quoted(series.notes[static_cast<std::size_t>(series.note[i])]);
}

}  // namespace

std::string figure_csv(const Figure& figure) {
  const std::vector<Column> columns = columns_of(figure);
  const bool has_notes = std::any_of(figure.series.begin(), figure.series.end(),
                                     [](const Series& s) { return !s.note.empty(); });
  std::string csv = "series";
  for (const Column& column : columns) csv += "," + quoted(column.heading);
  csv += has_notes ? ",note\n" : "\n";
  for (const Series& series : figure.series) {
    const std::string name = quoted(series.name.empty() ? figure.title : series.name);
    for (std::size_t i = 0; i < length(series); ++i) {
      csv += name;
      for (const Column& column : columns) {
        const std::vector<double>& values = series.*column.values;
        csv += ',';
        if (i < values.size()) csv += field(figure, column, values[i]);
      }
      if (has_notes) csv += "," + note_of(series, i);
      csv += '\n';
    }
  }
  return csv;
}

}  // namespace waymark

#include <waymark/tools/benchmark/known_optima.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::benchmark {
namespace {

struct Place {
  const std::string& file;
  const formats::CsvLines& lines;

  [[noreturn]] void fail(std::string_view at, const std::string& message) const {
    throw InputError(file + ":" + std::to_string(lines.number()) + ":" +
                     std::to_string(formats::column_of(lines.line(), at)) + ": " + message);
  }
};

double parse_chi2(std::string_view word, const Place& place) {
  double chi2 = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), chi2);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  if (!whole || !std::isfinite(chi2) || chi2 < 0) {
    place.fail(word, "expected a chi2 (a number, at least 0), got " + formats::quote_word(word));
  }
  return chi2;
}

}  // namespace

KnownOptima read_known_optima(std::string_view text, const std::string& name) {
  KnownOptima optima;
  formats::CsvLines lines(text);
  const Place place{name, lines};
  std::vector<std::string_view> fields;
  for (bool heading = true; lines.next(); heading = false) {
    if (!formats::split_fields(lines.line(), ',', fields) || fields.size() != 2) {
      place.fail(lines.line(), "expected two fields, file and chi2");
    }
    if (heading) {
      if (fields[0] != "file" || fields[1] != "chi2") {
        place.fail(lines.line(),
                   "expected the heading 'file,chi2', got " + formats::quote_word(lines.line()));
      }
      continue;
    }
    const double chi2 = parse_chi2(fields[1], place);
    if (!optima.emplace(std::string(fields[0]), chi2).second) {
      place.fail(fields[0], formats::quote_word(fields[0]) + " is listed a second time");
    }
  }
  if (optima.empty())
    throw InputError(name + ": no optima in it (heading 'file,chi2', then a line per file)");
  return optima;
}

Optimality compare_with_optimum(double chi2, double optimum) {
  const double tolerance = std::max(1e-6 * optimum, 1e-9);
  if (chi2 < optimum - tolerance) return Optimality::lower;
  return chi2 <= optimum + tolerance ? Optimality::reached : Optimality::above;
}

std::string_view to_string(Optimality optimality) {
  switch (optimality) {
    case Optimality::reached:
      return "reached";
    case Optimality::lower:
      return "lower";
    case Optimality::above:
      break;
  }
  return "above";
}

}  // namespace waymark::benchmark

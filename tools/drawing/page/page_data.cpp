#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/marks_svg.hpp>
#include <waymark/tools/drawing/page/page_data.hpp>
#include <waymark/tools/drawing/page/rounded_column.hpp>

namespace waymark::drawing {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongColumn = 64;

Json rounded_json(const std::vector<double>& values) {
  const RoundedColumn column = rounded(values);
  Json differences = Json::array();
  for (const auto& difference : column.differences)
    differences.push_back(difference ? Json(*difference) : Json(nullptr));
  return {{"step", column.step}, {"differences", std::move(differences)}};
}

/// The columns of all figures, each once.
class ColumnStore {
 public:
  /// @param may_round whether the column may be rounded to a step; not on a logarithmic axis
  std::size_t add(const std::vector<double>& values, bool may_round) {
    Json column;
    if (may_round && values.size() >= kLongColumn) {
      column = rounded_json(values);
    } else {
      column = Json::array();
      for (const double value : values) column.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    }
    const auto [place, is_new] = place_of_.try_emplace(column.dump(), place_of_.size());
    if (is_new) columns_.push_back(std::move(column));
    return place->second;
  }
  [[nodiscard]] Json take() { return std::move(columns_); }

 private:
  Json columns_ = Json::array();
  std::map<std::string, std::size_t> place_of_;
};

Json series_json(const Series& series, const Figure& figure, ColumnStore& store) {
  Json json = {{"name", series.name},
               {"mark", name_of(series.mark)},
               {"look", style_of(series.look).name},
               {"marker", style_of(series.look).marker}};
  const auto put = [&](const char* key, const std::vector<double>& values, bool may_round) {
    if (!values.empty()) json[key] = store.add(values, may_round);
  };
  const bool linear = !figure.x.logarithmic && !figure.y.logarithmic;
  put("x", series.x, !figure.x.logarithmic);
  put("y", series.y, !figure.y.logarithmic);
  put("low", series.low, linear);
  put("high", series.high, linear);
  put("time", series.time, true);
  if (!series.note.empty()) {
    put("note", std::vector<double>(series.note.begin(), series.note.end()), true);
    json["notes"] = series.notes;
  }
  return json;
}

Json axis_json(const Axis& axis, Range range) {
  return {{"title", axis.title},
          {"unit", axis.unit},
          {"heading", heading(axis)},
          {"log", axis.logarithmic},
          {"low", range.low},
          {"high", range.high},
          {"held", axis.low.has_value()},
          {"rows", !axis.categories.empty()}};
}

Json places_json(const Places& places, ColumnStore& store) {
  Json json = {{"start", places.start_utc_s ? Json(*places.start_utc_s) : Json(nullptr)}};
  for (const auto& [key, column] :
       {std::pair{"time", &places.time}, std::pair{"x", &places.x}, std::pair{"y", &places.y},
        std::pair{"latitude", &places.latitude_deg}, std::pair{"longitude", &places.longitude_deg},
        std::pair{"xx", &places.xx}, std::pair{"xy", &places.xy}, std::pair{"yy", &places.yy}}) {
    if (!column->empty()) json[key] = store.add(*column, true);
  }
  return json;
}

Json figure_json(const Figure& figure, ColumnStore& store) {
  static constexpr const char* kMotions[] = {"still", "x", "map"};
  const View view = drawn_view(figure);
  Json json = {{"motion", kMotions[static_cast<int>(figure.motion)]},
               {"link", figure.link},
               {"geographic", figure.geographic},
               {"downwards", view.downwards},
               {"box", {view.box.left, view.box.top, view.box.width, view.box.height}},
               {"x", axis_json(figure.x, view.x)},
               {"y", axis_json(figure.y, view.y)}};
  if (figure.places) json["places"] = places_json(*figure.places, store);
  json["series"] = Json::array();
  for (const Series& series : figure.series) json["series"].push_back(series_json(series, figure, store));
  return json;
}

bool has_cells(const Figure& figure) {
  return std::any_of(figure.series.begin(), figure.series.end(),
                     [](const Series& series) { return series.mark == Mark::cells; });
}

}  // namespace

std::string page_data(const std::vector<const Figure*>& figures) {
  ColumnStore store;
  Json of_figures = Json::object();
  for (const Figure* figure : figures) {
    if (!has_cells(*figure)) of_figures[figure->id] = figure_json(*figure, store);
  }
  const Json json = {{"columns", store.take()}, {"figures", std::move(of_figures)}};
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;  // "</script>" and "<!--" are not allowed in a script element
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace waymark::drawing

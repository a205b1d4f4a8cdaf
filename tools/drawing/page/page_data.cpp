#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include <waymark/tools/drawing/figure/figure_svg.hpp>
#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/drawing/figure/marks_svg.hpp>
#include <waymark/tools/drawing/page/page_data.hpp>
#include <waymark/tools/drawing/page/rounded_column.hpp>
#include <waymark/tools/drawing/page/screens.hpp>

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

Json axis_json(const Axis& axis) {
  return {{"title", axis.title},          {"unit", axis.unit},
          {"heading", heading(axis)},     {"log", axis.logarithmic},
          {"held", axis.low.has_value()}, {"rows", !axis.categories.empty()}};
}

/// Returns every so many of the values, if they are more than fit.
std::vector<double> every(const std::vector<double>& values, const PageSize& size) {
  if (values.size() <= size.of_series) return values;
  const std::size_t step = 1 + (values.size() - 1) / std::max<std::size_t>(size.of_series, 1);
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); i += step) kept.push_back(values[i]);
  return kept;
}

Json places_json(const Places& places, const PageSize& size, ColumnStore& store) {
  Json json = {{"start", places.start_utc_s ? Json(*places.start_utc_s) : Json(nullptr)}};
  for (const auto& [key, column] :
       {std::pair{"time", &places.time}, std::pair{"x", &places.x}, std::pair{"y", &places.y},
        std::pair{"latitude", &places.latitude_deg}, std::pair{"longitude", &places.longitude_deg},
        std::pair{"xx", &places.xx}, std::pair{"xy", &places.xy}, std::pair{"yy", &places.yy}}) {
    if (!column->empty()) json[key] = store.add(every(*column, size), true);
  }
  if (!places.quality.empty()) {
    json["quality"] = store.add(every({places.quality.begin(), places.quality.end()}, size), true);
    json["qualities"] = places.qualities;
  }
  return json;
}

/// Returns place and view of each drawing, by its screen.
Json drawings_json(const Figure& figure) {
  Json json = Json::object();
  Figure drawn = figure;
  for (const DrawingForScreen& drawing : drawings_for_screens(figure)) {
    drawing.apply(drawn);
    const View view = drawn_view(drawn);
    json[drawing.screen] = {{"box", {view.box.left, view.box.top, view.box.width, view.box.height}},
                            {"x", {view.x.low, view.x.high}},
                            {"y", {view.y.low, view.y.high}}};
  }
  return json;
}

Json figure_json(const Figure& figure, const PageSize& size, ColumnStore& store) {
  static constexpr const char* kMotions[] = {"still", "x", "map"};
  Json json = {{"motion", kMotions[static_cast<int>(figure.motion)]},
               {"link", figure.link},
               {"geographic", figure.geographic},
               {"downwards", drawn_view(figure).downwards},
               {"drawings", drawings_json(figure)},
               {"x", axis_json(figure.x)},
               {"y", axis_json(figure.y)}};
  if (figure.places) json["places"] = places_json(*figure.places, size, store);
  json["series"] = Json::array();
  for (const Series& series : figure.series) {
    const std::size_t carried = points_carried(series, figure, size);
    if (carried == std::max({series.x.size(), series.y.size(), series.low.size()})) {
      json["series"].push_back(series_json(series, figure, store));
    } else {
      const bool on_map = figure.motion == Motion::map;
      json["series"].push_back(
          series_json(with_points(series, points_that_keep_shape(series, on_map, carried)), figure, store));
    }
  }
  return json;
}

bool has_cells(const Figure& figure) {
  return std::any_of(figure.series.begin(), figure.series.end(),
                     [](const Series& series) { return series.mark == Mark::cells; });
}

}  // namespace

std::string page_data(const std::vector<const Figure*>& figures, const PageSize& size) {
  ColumnStore store;
  Json of_figures = Json::object();
  for (const Figure* figure : figures) {
    if (!has_cells(*figure)) of_figures[figure->id] = figure_json(*figure, size, store);
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

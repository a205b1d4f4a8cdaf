#include <algorithm>
#include <cmath>

#include <waymark/tools/drawing/page/page_size.hpp>

namespace waymark::drawing {
namespace {

/// Of a page of 5 MB: a number takes 4 to 5 bytes, and drawings, words and tables take up to 1 MB.
constexpr double kMostNumbers = 800'000;
/// A note of a point is as long as this many numbers.
constexpr double kNote = 15;
/// A track is looked at more closely than anything else.
constexpr std::size_t kTrackShare = 6;

std::size_t length_of(const Series& series) {
  return std::max({series.x.size(), series.y.size(), series.low.size()});
}

bool can_be_thinned(const Series& series) {
  return series.in_view &&
         (series.mark == Mark::line || series.mark == Mark::points || series.mark == Mark::band);
}

/// Returns how many numbers a point of the series takes.
double numbers_per_point(const Series& series) {
  double numbers = 0;
  for (const auto* column : {&series.x, &series.y, &series.low, &series.high})
    if (!column->empty()) ++numbers;
  if (!series.time.empty() && series.time != series.x) ++numbers;
  return numbers + (series.note.empty() ? 0 : kNote);
}

/// The series of all figures, as far as their size matters.
struct Weighed {
  double points = 0;
  double numbers_per_point = 0;
  bool is_track = false;
  bool can_be_thinned = false;
};

double numbers_at(const std::vector<Weighed>& all, double points) {
  double sum = 0;
  for (const Weighed& series : all) {
    const double most = series.is_track ? points * kTrackShare : points;
    sum += series.numbers_per_point * (series.can_be_thinned ? std::min(series.points, most) : series.points);
  }
  return sum;
}

/// Returns the point of [begin, end) that is farthest from the line through its ends.
std::size_t farthest(const Series& series, std::size_t begin, std::size_t end) {
  const double dx = series.x[end - 1] - series.x[begin];
  const double dy = series.y[end - 1] - series.y[begin];
  const double length = std::hypot(dx, dy);
  std::size_t best = begin;
  double most = -1;
  for (std::size_t i = begin; i < end; ++i) {
    const double x = series.x[i] - series.x[begin];
    const double y = series.y[i] - series.y[begin];
    const double apart = length > 0 ? std::abs(x * dy - y * dx) / length : std::hypot(x, y);
    if (apart > most) {
      most = apart;
      best = i;
    }
  }
  return best;
}

}  // namespace

PageSize size_that_fits(const std::vector<const Figure*>& figures) {
  std::vector<Weighed> all;
  double longest = 0;
  for (const Figure* figure : figures) {
    for (const Series& series : figure->series) {
      all.push_back({static_cast<double>(length_of(series)), numbers_per_point(series),
                     figure->motion == Motion::map && series.mark == Mark::line, can_be_thinned(series)});
      longest = std::max(longest, all.back().points);
    }
    if (figure->places) all.push_back({static_cast<double>(figure->places->time.size()), 8, false, true});
  }
  if (numbers_at(all, longest) <= kMostNumbers) return {};
  double points = longest;
  while (points > 100 && numbers_at(all, points) > kMostNumbers) points *= 0.9;
  const auto most = static_cast<std::size_t>(points);
  return {most, kTrackShare * most};
}

std::size_t points_carried(const Series& series, const Figure& figure, const PageSize& size) {
  if (!can_be_thinned(series)) return length_of(series);
  const bool is_track = figure.motion == Motion::map && series.mark == Mark::line;
  return std::min(length_of(series), is_track ? size.of_track : size.of_series);
}

std::vector<std::size_t> points_that_keep_shape(const Series& series, bool on_map, std::size_t most) {
  const std::size_t count = length_of(series);
  const bool single = on_map && series.mark == Mark::points;
  const std::size_t kept_of_stretch = single ? 1 : on_map ? 2 : 4;
  const std::size_t stretches = std::max<std::size_t>(most / kept_of_stretch, 1);
  const std::vector<double>& lows = series.mark == Mark::band ? series.low : series.y;
  const std::vector<double>& highs = series.mark == Mark::band ? series.high : series.y;
  std::vector<std::size_t> kept;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = count * s / stretches;
    const std::size_t end = count * (s + 1) / stretches;
    if (begin == end) continue;
    std::vector<std::size_t> of_stretch = {begin};
    if (on_map && !single) of_stretch.push_back(farthest(series, begin, end));
    if (!on_map) {
      const auto at = [&](const std::vector<double>& values, std::size_t i) {
        return values.begin() + static_cast<std::ptrdiff_t>(i);
      };
      of_stretch.push_back(
          static_cast<std::size_t>(std::min_element(at(lows, begin), at(lows, end)) - lows.begin()));
      of_stretch.push_back(
          static_cast<std::size_t>(std::max_element(at(highs, begin), at(highs, end)) - highs.begin()));
      of_stretch.push_back(end - 1);
    }
    if (s + 1 == stretches) of_stretch.push_back(count - 1);
    std::sort(of_stretch.begin(), of_stretch.end());
    for (const std::size_t i : of_stretch) {
      if (kept.empty() || kept.back() != i) kept.push_back(i);
    }
  }
  return kept;
}

Series with_points(const Series& series, const std::vector<std::size_t>& indices) {
  Series kept{.name = series.name, .mark = series.mark, .look = series.look};
  kept.in_view = series.in_view;
  for (const auto column :
       {&Series::x, &Series::y, &Series::low, &Series::high, &Series::weight, &Series::time}) {
    if ((series.*column).empty()) continue;
    for (const std::size_t i : indices) (kept.*column).push_back((series.*column)[i]);
  }
  for (const std::size_t i : indices) {
    if (series.note.empty()) break;
    const int note = series.note[i];
    kept.note.push_back(note < 0 ? -1 : static_cast<int>(kept.notes.size()));
    if (note >= 0) kept.notes.push_back(series.notes[static_cast<std::size_t>(note)]);
  }
  return kept;
}

}  // namespace waymark::drawing

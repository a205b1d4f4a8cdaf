#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {
namespace {

constexpr double kLargest = 1e150;    // differences of such numbers are finite too
constexpr double kSmallest = 1e-150;  // on a logarithmic axis
constexpr double kMarginTop = 10;
constexpr double kMarginRight = 18;
constexpr double kMarginBottom = 44;
constexpr double kLeastMarginLeft = 56;
constexpr double kMostMarginLeft = 300;
constexpr double kLegendRow = 20;

/// The extent of the added values.
class Extent {
 public:
  explicit Extent(bool logarithmic) : logarithmic_(logarithmic) {}

  void add(double value) {
    if (!(std::abs(value) <= kLargest) || (logarithmic_ && value < kSmallest)) return;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  void add(const std::vector<double>& values) {
    for (const double value : values) add(value);
  }
  [[nodiscard]] Range padded(const Axis& axis) const {
    Range range{low_, high_};
    if (!(low_ <= high_)) range = logarithmic_ ? Range{0.1, 10} : Range{0, 1};
    if (logarithmic_) {
      const double factor = range.high > range.low ? std::pow(range.high / range.low, 0.04) : 2;
      range = {range.low / factor, range.high * factor};
    } else {
      const double pad =
          range.high > range.low ? 0.04 * (range.high - range.low) : std::max(0.5, 0.1 * std::abs(range.low));
      range = {range.low - pad, range.high + pad};
    }
    range.low = axis.low.value_or(range.low);
    range.high = axis.high.value_or(range.high);
    if (!(range.high > range.low)) range.high = range.low + (logarithmic_ ? range.low : 1);
    return range;
  }

 private:
  bool logarithmic_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

Range range_x(const Figure& figure) {
  Extent extent(figure.x.logarithmic);
  for (const Series& series : figure.series) {
    if (!series.in_view) continue;
    extent.add(series.x);
    if (series.mark == Mark::cells)
      for (const double x : series.x) extent.add(x + 1);
    if (series.mark == Mark::bars) {
      if (!figure.x.logarithmic) extent.add(0.0);
      extent.add(series.low);
      extent.add(series.high);
    }
  }
  return extent.padded(figure.x);
}

Range range_y(const Figure& figure) {
  if (!figure.y.categories.empty()) return {-0.5, static_cast<double>(figure.y.categories.size()) - 0.5};
  Extent extent(figure.y.logarithmic);
  for (const Series& series : figure.series) {
    if (!series.in_view) continue;
    extent.add(series.y);
    if (series.mark == Mark::cells)
      for (const double y : series.y) extent.add(y + 1);
    if (series.mark == Mark::spans) continue;
    extent.add(series.low);
    extent.add(series.high);
  }
  return extent.padded(figure.y);
}

/// Widens the smaller range, so that both axes have the same scale.
void make_scales_equal(View& view) {
  const double scale_x = (view.x.high - view.x.low) / view.box.width;
  const double scale_y = (view.y.high - view.y.low) / view.box.height;
  const double scale = std::max(scale_x, scale_y);
  const auto widen = [scale](Range& range, double size) {
    const double middle = 0.5 * (range.low + range.high);
    range = {middle - 0.5 * scale * size, middle + 0.5 * scale * size};
  };
  widen(view.x, view.box.width);
  widen(view.y, view.box.height);
}

double position(Range range, bool logarithmic, double value) {
  if (!logarithmic) return (value - range.low) / (range.high - range.low);
  return std::log(value / range.low) / std::log(range.high / range.low);
}

/// Returns room for the names of rows, or for the axis title and the tick labels.
double left_margin(const Figure& figure, Range y, double height) {
  double longest = 0;
  for (const std::string& name : figure.y.categories) longest = std::max(longest, text_width(name));
  if (longest > 0) return std::min(24 + longest, std::max(kMostMarginLeft, 0.42 * figure.width));
  for (const Tick& tick : ticks(y, figure.y.logarithmic, ticks_in_height(height)))
    longest = std::max(longest, text_width(tick.label));
  return std::clamp(34 + longest, kLeastMarginLeft, kMostMarginLeft);
}

/// Returns "0.25" with as many digits as the step between ticks needs.
std::string tick_label(double value, double step) {
  const double size = std::max(std::abs(value), step);
  const double rounded = std::abs(value) < step * 1e-6 ? 0.0 : value;
  if (size >= 1e6 || step < 1e-5) {
    const int significant = static_cast<int>(std::ceil(std::log10(size / step) - 1e-9)) + 1;
    return fmt::format("{:.{}g}", rounded, std::clamp(significant, 1, 15));
  }
  const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", rounded, digits);
}

std::vector<Tick> logarithmic_ticks(Range range) {
  std::vector<Tick> result;
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  const int every = std::max(1, (last - first) / 8);
  const bool between = range.high < 100 * range.low;
  for (int power = first; power <= last; power += every) {
    for (const int factor : {1, 2, 5}) {
      if (factor > 1 && !between) continue;
      const double value = factor * std::pow(10.0, power);
      if (value >= range.low && value <= range.high) result.push_back({value, fmt::format("{:.6g}", value)});
    }
  }
  return result;
}

/// Returns round numbers with steps of 1, 2 or 5 times a power of ten, at most about `count`.
std::vector<Tick> even_ticks(Range range, int count) {
  const double least = (range.high - range.low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= least) step = factor * power;
  }
  std::vector<Tick> result;
  const double first = std::ceil(range.low / step - 1e-9);
  const double last = std::floor((range.high - first * step) / step + 1e-9);
  const int most = last >= 0 ? static_cast<int>(std::min(last, 100.0)) : -1;  // not a number: no ticks
  for (int k = 0; k <= most; ++k) {
    const double value = (first + k) * step;
    result.push_back({value, tick_label(value, step)});
  }
  return result;
}

}  // namespace

double text_width(std::string_view text) {
  double width = 0;
  for (const char c : text) {
    const bool wide = (c >= 'A' && c <= 'Z') || c == '_' || c == 'm' || c == 'w' || c == '%';
    width += wide ? 8.6 : 6.5;
  }
  return width;
}

int ticks_in_height(double height) {
  return static_cast<int>(height / 45) + 1;
}

int ticks_in_width(double width) {
  return static_cast<int>(width / 90) + 1;
}

double View::px_x(double value) const {
  return box.left + box.width * position(x, logarithmic_x, value);
}

double View::px_y(double value) const {
  const double up = position(y, logarithmic_y, value);
  return box.top + box.height * (downwards ? up : 1 - up);
}

bool View::shows(double x_value, double y_value) const {
  return std::abs(x_value) <= kLargest && std::abs(y_value) <= kLargest &&
         (!logarithmic_x || x_value >= kSmallest) && (!logarithmic_y || y_value >= kSmallest);
}

View full_view(const Figure& figure, int rows_of_legend) {
  View view;
  view.logarithmic_x = figure.x.logarithmic;
  view.logarithmic_y = figure.y.logarithmic;
  view.downwards = figure.downwards || !figure.y.categories.empty();
  view.grain = figure.grain;
  view.x = range_x(figure);
  view.y = range_y(figure);
  const double top = kMarginTop + kLegendRow * rows_of_legend;
  const double height = std::max(figure.height - top - kMarginBottom, 10.0);
  const double left = left_margin(figure, view.y, height);
  view.box = {left, top, std::max(figure.width - left - kMarginRight, 10.0), height};
  if (figure.motion == Motion::map) make_scales_equal(view);
  return view;
}

double round_down_125(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double factor = value / power;
  return power * (factor >= 5 ? 5 : factor >= 2 ? 2 : 1);
}

std::vector<Tick> ticks(Range range, bool logarithmic, int count) {
  constexpr std::size_t kFewest = 3;
  if (logarithmic) {
    std::vector<Tick> powers = logarithmic_ticks(range);
    // otherwise the range is so narrow that even steps suffice
    if (powers.size() >= kFewest) return powers;
  }
  std::vector<Tick> result;
  for (int wanted = std::max(count, 1); result.size() < kFewest && wanted <= std::max(count, 1) + 6; ++wanted)
    result = even_ticks(range, wanted);
  return result;
}

}  // namespace waymark::drawing

// Ticks, places and thinning.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/tools/drawing/figure/thinning.hpp>
#include <waymark/tools/drawing/figure/view.hpp>
#include <waymark/tools/drawing/page/rounded_column.hpp>

namespace view_test {

using namespace waymark;
using namespace waymark::drawing;

namespace {

std::vector<std::string> labels(Range range, bool logarithmic, int count) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks(range, logarithmic, count)) result.push_back(tick.label);
  return result;
}

using Labels = std::vector<std::string>;

View view_of(Range x, Range y) {
  View view;
  view.x = x;
  view.y = y;
  view.box = {10, 20, 100, 50};
  return view;
}

/// The numbers of a column, summed as a page's script does it.
std::vector<double> summed(const RoundedColumn& column) {
  std::vector<double> values;
  double sum = 0;
  for (const auto& difference : column.differences) {
    sum += static_cast<double>(difference.value_or(0));
    values.push_back(difference ? sum * column.step : std::nan(""));
  }
  return values;
}

}  // namespace

TEST_CASE("view: ticks are round numbers with as many digits as tell them apart") {
  CHECK(labels({0, 10}, false, 5) == Labels{"0", "2", "4", "6", "8", "10"});
  CHECK(labels({-0.06, 0.11}, false, 4) == Labels{"-0.05", "0.00", "0.05", "0.10"});
  CHECK(labels({0, 1}, false, 2) == Labels{"0.0", "0.5", "1.0"});
  CHECK(labels({1234567, 1234569}, false, 2) == Labels{"1234567", "1234568", "1234569"});
  CHECK(labels({8.3234e-4, 8.3237e-4}, false, 4) ==
        Labels{"0.00083234", "0.00083235", "0.00083236", "0.00083237"});
}

TEST_CASE("view: logarithmic ticks are powers of ten, with 2 and 5 between where those are few") {
  CHECK(labels({0.5, 2000}, true, 5) == Labels{"1", "10", "100", "1000"});
  CHECK(labels({0.9, 11}, true, 5) == Labels{"1", "2", "5", "10"});
  CHECK(labels({110, 150}, true, 4) == Labels{"110", "120", "130", "140", "150"});
}

TEST_CASE("view: an axis has at least three ticks, however little room there is") {
  for (const double high : {1.0, 1.9, 2.1, 4.9, 7.3, 9.99, 19.0}) {
    for (int count = 1; count < 6; ++count) {
      CHECK(ticks({0, high}, false, count).size() >= 3);
      CHECK(ticks({-0.3 * high, high}, false, count).size() >= 3);
      CHECK(ticks({high, 2.3 * high}, true, count).size() >= 3);
    }
  }
}

TEST_CASE("view: ticks end, however odd the range") {
  for (const Range range : {Range{0, 1e308}, Range{1e15, 1e15 + 1}, Range{-5e-324, 5e-324}, Range{0, 5e-324}})
    CHECK(ticks(range, false, 8).size() <= 101);
}

TEST_CASE("view: round lengths of scale bars") {
  CHECK(round_down_125(9.99) == Approx(5));
  CHECK(round_down_125(5) == Approx(5));
  CHECK(round_down_125(0.02) == Approx(0.02));
  CHECK(round_down_125(1999) == Approx(1000));
}

TEST_CASE("view: a map has one scale for both axes and holds all its points") {
  Figure figure;
  figure.motion = Motion::map;
  figure.series = {{.name = "track", .x = {0, 1000}, .y = {0, 10}}};
  const View view = full_view(figure, 0);
  CHECK((view.x.high - view.x.low) / view.box.width == Approx((view.y.high - view.y.low) / view.box.height));
  CHECK(view.px_x(0) >= view.box.left);
  CHECK(view.px_x(1000) <= view.box.left + view.box.width);
}

TEST_CASE("view: a thinned series keeps the extremes of every column of pixels") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> x, y;
  for (int i = 0; i < 100000; ++i) {
    x.push_back(i);
    y.push_back(normal(random));
  }
  const View view = view_of({0, 100000}, {-5, 5});
  const auto parts = thin_line(x, y, view);
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].size() <= 4 * 101);
  for (double column = 10; column < 110; ++column) {
    const auto low_high = [&](auto begin, auto end, auto place) {
      std::pair<double, double> result{1e9, -1e9};
      for (auto i = begin; i != end; ++i) {
        const auto [px_x, px_y] = place(*i);
        if (std::floor(px_x) != column) continue;
        result.first = std::min(result.first, px_y);
        result.second = std::max(result.second, px_y);
      }
      return result;
    };
    std::vector<std::size_t> all(x.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const auto whole = low_high(all.begin(), all.end(),
                                [&](std::size_t i) { return std::pair(view.px_x(x[i]), view.px_y(y[i])); });
    const auto kept =
        low_high(parts[0].begin(), parts[0].end(), [](const DrawnPoint& p) { return std::pair(p.x, p.y); });
    REQUIRE(kept == whole);
  }
}

TEST_CASE("view: no point of a thinned track is farther than 0.4 px from a kept one") {
  std::vector<double> x, y;
  for (int i = 0; i <= 20000; ++i) {
    x.push_back(std::cos(i * 0.001) * 40);
    y.push_back(std::sin(i * 0.0007) * 20);
  }
  const View view = view_of({-50, 50}, {-25, 25});
  const auto parts = thin_line(x, y, view);
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].size() < 5000);
  CHECK(parts[0].back().index == 20000);
  std::size_t before = 0;  // the last kept one at or before i
  for (std::size_t i = 0; i < x.size(); ++i) {
    while (before + 1 < parts[0].size() && parts[0][before + 1].index <= i) ++before;
    REQUIRE(std::hypot(view.px_x(x[i]) - parts[0][before].x, view.px_y(y[i]) - parts[0][before].y) < 0.4001);
  }
}

TEST_CASE("view: a line breaks where a number is missing") {
  const auto parts = thin_line({0, 1, 2, 3}, {0, std::nan(""), 1, 1}, view_of({0, 3}, {0, 1}));
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].size() == 1);
  CHECK(parts[1].size() == 2);
}

TEST_CASE("view: a rounded column is within half a step of what went in, gaps included") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1e4, 1e4);
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(i % 97 == 0 ? std::nan("") : uniform(random));
  const double step = rounding_step(values);
  CHECK(step <= 1e-7 * 2e4);
  const std::vector<double> back = summed(rounded(values));
  REQUIRE(back.size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    REQUIRE(std::isnan(back[i]) == std::isnan(values[i]));
    if (!std::isnan(values[i])) REQUIRE(std::abs(back[i] - values[i]) <= 0.5001 * step);
  }
}

TEST_CASE("view: whole numbers are kept exactly, and a drive takes four digits a number at most") {
  const std::vector<double> whole = {-3, 0, 7, 4e12, -4e12, 5};
  CHECK(summed(rounded(whole)) == whole);
  std::vector<double> drive;  // 40 km in steps of a millimetre
  for (int i = 0; i < 100'000; ++i) drive.push_back(0.4 * i + std::sin(i * 0.01));
  CHECK(rounding_step(drive) == Approx(1e-3));
  for (const auto& difference : rounded(drive).differences) CHECK(std::abs(*difference) < 10'000);
}

TEST_CASE("view: columns of one value, none, and of nothing finite are rounded") {
  CHECK(summed(rounded({})).empty());
  CHECK(summed(rounded({1.5}))[0] == Approx(1.5));
  CHECK(std::isnan(summed(rounded({std::nan("")}))[0]));
  const std::vector<double> wild = summed(rounded({1e300, -1e300}));
  CHECK(wild[0] == Approx(1e300));
  CHECK(wild[1] == Approx(-1e300));
}

}  // namespace view_test

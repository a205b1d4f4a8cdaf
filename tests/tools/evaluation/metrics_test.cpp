#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/evaluation/numbers/space_metrics.hpp>

namespace metrics_test {

using namespace waymark;
using namespace waymark::evaluation;
using Offsets = std::vector<Eigen::Vector2d>;

TEST_CASE("metrics: a constant offset of (3, 4) is all accuracy and no precision") {
  const Offsets offsets(7, Eigen::Vector2d(3, 4));
  const PositionMetrics m = position_metrics(offsets);
  CHECK(m.count == 7);
  CHECK(m.max_m == Approx(5));
  CHECK(m.accuracy_m == Approx(5));
  CHECK(m.precision_m == Approx(0).margin(1e-12));
  CHECK(m.rmse_m == Approx(5));
  CHECK(m.median_m == Approx(5));
  CHECK(m.cep50_m == Approx(5));
  CHECK(m.cep95_m == Approx(5));
  CHECK(m.mean_m == Eigen::Vector2d(3, 4));
}

TEST_CASE("metrics: a cross of unit offsets has no bias and precision sqrt(4/3)") {
  const Offsets offsets{{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const PositionMetrics m = position_metrics(offsets);
  CHECK(m.accuracy_m == Approx(0).margin(1e-15));
  CHECK(m.precision_m == Approx(std::sqrt(4.0 / 3.0)));  // divisor n - 1 = 3
  CHECK(m.rmse_m == Approx(1));                          // divisor n = 4
}

TEST_CASE("metrics: D_i is the distance of an offset from the mean offset, not of a position") {
  // mean (2, 0); distances 1, 0, 1; the paper's printed D_i, without the truth, would depend on where the car
  // is
  const Offsets offsets{{1, 0}, {2, 0}, {3, 0}};
  const PositionMetrics m = position_metrics(offsets);
  CHECK(m.accuracy_m == Approx(2));
  CHECK(m.precision_m == Approx(1));
}

TEST_CASE("quantiles: nearest rank for CEP, the middle for the median") {
  Offsets offsets;
  for (int i = 20; i >= 1; --i) offsets.emplace_back(i, 0);
  const PositionMetrics m = position_metrics(offsets);
  CHECK(m.max_m == 20);
  CHECK(m.median_m == 10.5);
  CHECK(m.cep50_m == 10);  // 10 of 20 are within
  CHECK(m.cep95_m == 19);  // 19 of 20 are within
  offsets.emplace_back(21, 0);
  const PositionMetrics odd = position_metrics(offsets);
  CHECK(odd.median_m == 11);
  CHECK(odd.cep50_m == 11);
  CHECK(odd.cep95_m == 20);  // 19 of 21 would be 90.5 %, 20 are 95.2 %
}

TEST_CASE("metrics: nearest-rank quantile at its ends") {
  const std::vector<double> values{1, 2, 3, 4};
  CHECK(nearest_rank_quantile(values, 1.0) == 4);
  CHECK(nearest_rank_quantile(values, 0.25) == 1);
  CHECK(nearest_rank_quantile(values, 0.2500001) == 2);
  CHECK(nearest_rank_quantile(values, 1e-12) == 1);
  CHECK(std::isnan(nearest_rank_quantile({}, 0.5)));
}

TEST_CASE("metrics: none and one offset have their metrics") {
  const PositionMetrics none = position_metrics({});
  CHECK(none.count == 0);
  CHECK(std::isnan(none.max_m));
  CHECK(std::isnan(none.accuracy_m));
  CHECK(std::isnan(none.precision_m));
  CHECK(std::isnan(none.rmse_m));
  CHECK(std::isnan(none.median_m));
  CHECK(std::isnan(none.cep95_m));
  const Offsets single{{0.6, 0.8}};
  const PositionMetrics one = position_metrics(single);
  CHECK(one.max_m == Approx(1));
  CHECK(one.accuracy_m == Approx(1));
  CHECK(one.median_m == Approx(1));
  CHECK(one.cep50_m == Approx(1));
  CHECK(std::isnan(one.precision_m));
}

TEST_CASE("metrics: precision survives a bias a million times larger") {
  const Offsets offsets{{1e7 - 1, 0}, {1e7 + 1, 0}};
  CHECK(position_metrics(offsets).precision_m == Approx(std::sqrt(2.0)).epsilon(1e-9));
}

TEST_CASE("metrics: Gaussian offsets: theory of RMSE, CEP50 and CEP95") {
  std::mt19937_64 random(20240917);
  std::normal_distribution<double> normal(0, 2);
  Offsets offsets;
  for (int i = 0; i < 200000; ++i) {
    const double x = normal(random);
    offsets.emplace_back(x, normal(random));
  }
  const PositionMetrics m = position_metrics(offsets);
  CHECK(m.accuracy_m < 0.03);
  CHECK(m.precision_m == Approx(2 * std::sqrt(2.0)).epsilon(0.01));
  CHECK(m.cep50_m == Approx(2 * std::sqrt(2 * std::log(2.0))).epsilon(0.01));    // Rayleigh median
  CHECK(m.cep95_m == Approx(2 * std::sqrt(-2 * std::log(0.05))).epsilon(0.01));  // Rayleigh 95 %
  const double n = static_cast<double>(m.count);
  CHECK(m.rmse_m * m.rmse_m ==
        Approx(m.accuracy_m * m.accuracy_m + m.precision_m * m.precision_m * (n - 1) / n));
}

TEST_CASE("metrics: scalar statistics are those of a small sample") {
  const std::vector<double> values{-3, 1, 2};
  const ScalarStatistics s = scalar_statistics(values);
  CHECK(s.count == 3);
  CHECK(s.mean == Approx(0).margin(1e-15));
  CHECK(s.deviation == Approx(std::sqrt(7.0)));
  CHECK(s.rms == Approx(std::sqrt(14.0 / 3.0)));
  CHECK(s.max_abs == 3);
  CHECK(std::isnan(scalar_statistics({}).mean));
  CHECK(std::isnan(scalar_statistics(std::vector<double>{1.0}).deviation));
}

TEST_CASE("metrics: in space the height is the third component") {
  const std::vector<Eigen::Vector2d> offsets{{3, 0}, {0, 0}};
  const std::vector<double> heights{4, 0};
  const SpaceMetrics m = space_metrics(offsets, heights);
  CHECK(m.max_m == Approx(5));
  CHECK(m.rmse_m == Approx(std::sqrt(25 / 2.0)));
  CHECK(m.precision_m == Approx(std::sqrt(2 * (1.5 * 1.5 + 2 * 2))));  // about (1.5, 0, 2), divisor 1
  CHECK(m.height.mean == Approx(2));
  CHECK(m.height.rms == Approx(std::sqrt(8.0)));
  CHECK(std::isnan(space_metrics({}, {}).rmse_m));
  CHECK(std::isnan(space_metrics(std::vector<Eigen::Vector2d>{{1, 2}}, std::vector<double>{2}).precision_m));
  CHECK_THROWS_AS(space_metrics(offsets, {}), UsageError);
}

TEST_CASE("metrics: along is ahead, across is to the left") {
  const double north = std::numbers::pi / 2;
  const Offsets offsets{{0, 2}, {-1, 0}, {100, 100}};
  const std::vector<std::optional<double>> directions{north, north, std::nullopt};
  const TrackMetrics m = track_metrics(offsets, directions);
  CHECK(m.along.count == 2);  // the one without a direction is left out
  CHECK(m.along.mean == Approx(1));
  CHECK(m.cross.mean == Approx(0.5));
  CHECK(m.along.rms == Approx(std::sqrt(2.0)));
  CHECK(m.cross.max_abs == Approx(1));
  CHECK_THROWS_AS(track_metrics(offsets, std::span(directions).first(2)), UsageError);
}

TEST_CASE("metrics: an improvement is in percent of what was") {
  CHECK(improvement_percent(2, 1) == Approx(50));
  CHECK(improvement_percent(2, 3) == Approx(-50));
  CHECK(std::isnan(improvement_percent(0, 1)));
  CHECK(std::isnan(improvement_percent(kUndefined, 1)));
  CHECK(std::isnan(improvement_percent(1, kUndefined)));
}

TEST_CASE("metrics: the published averages give the published improvements") {
  PositionMetrics gnss;
  gnss.max_m = 23.531;
  gnss.accuracy_m = 0.721;
  gnss.precision_m = 1.625;
  struct Published {
    double max, accuracy, precision;        // average row, m
    double max_percent, precision_percent;  // improvement row
  };
  const std::array<Published, 4> tables{
      {{18.391, 0.724, 1.744, 21.843, -7.364},   // G1; its text says -10.11 %
       {7.170, 0.705, 1.336, 69.528, 17.794},    // G2
       {11.884, 0.707, 1.376, 49.495, 15.326},   // G3
       {10.769, 0.705, 1.481, 54.234, 8.873}}};  // G2 without rejection
  for (const Published& table : tables) {
    PositionMetrics fused;
    fused.max_m = table.max;
    fused.accuracy_m = table.accuracy;
    fused.precision_m = table.precision;
    const Improvement better = improvement(gnss, fused);
    CHECK(better.max_percent == Approx(table.max_percent).margin(0.005));
    CHECK(better.precision_percent == Approx(table.precision_percent).margin(0.06));  // 3 digits of 1.6 m
  }
}

TEST_CASE("metrics: the published drives average to the published rows") {
  const std::vector<double> gnss_max{66.291, 21.799, 49.068, 4.828, 16.776, 3.672, 7.775, 18.037};
  const std::vector<double> g2_max{6.282, 14.173, 14.015, 4.846, 4.266, 3.117, 5.297, 5.367};
  const std::vector<double> gnss_precision{2.653, 2.491, 2.293, 1.025, 1.141, 0.954, 1.177, 1.264};
  const std::vector<double> g2_precision{0.956, 2.339, 1.679, 1.133, 1.010, 0.928, 1.295, 1.346};
  const double raw = scalar_statistics(gnss_max).mean;
  const double fused = scalar_statistics(g2_max).mean;
  CHECK(raw == Approx(23.531).margin(6e-4));
  CHECK(fused == Approx(7.170).margin(6e-4));
  CHECK(improvement_percent(raw, fused) == Approx(69.53).margin(0.005));
  CHECK(improvement_percent(scalar_statistics(gnss_precision).mean, scalar_statistics(g2_precision).mean) ==
        Approx(17.794).margin(0.02));
}

}  // namespace metrics_test

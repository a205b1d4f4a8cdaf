// The worst stretches of a drive: where they begin and end, and the reasons that the fixes tell.
#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/evaluation/weak_stretches.hpp>

namespace weak_stretches_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

/// A minute of fixes, one a second, with a stated sigma of 1 m.
std::vector<EpochResult> minute() {
  std::vector<EpochResult> epochs(60);
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    epochs[i].stamp = Stamp::from_seconds(static_cast<double>(i));
    epochs[i].status = FixStatus::accepted;
    epochs[i].position_covariance = Eigen::Matrix2d::Identity();
  }
  return epochs;
}

void set_sigma(EpochResult& epoch, double sigma_m) {
  epoch.position_covariance = Eigen::Matrix2d::Identity() * sigma_m * sigma_m;
}

bool tells(const WeakStretch& weak, const std::string& reason) {
  return std::find(weak.reasons.begin(), weak.reasons.end(), reason) != weak.reasons.end();
}

}  // namespace

TEST_CASE("weak stretches: a peak reaches as far as the value stays above its half") {
  std::vector<EpochResult> epochs = minute();
  const double sigmas[] = {2.1, 3, 4, 2.5};  // at 20 s ... 23 s; half of the peak is 2
  for (std::size_t i = 0; i < 4; ++i) set_sigma(epochs[20 + i], sigmas[i]);
  const auto weak = weak_stretches(epochs, false);
  REQUIRE(weak.size() == 1);
  CHECK(weak[0].begin == Stamp::from_seconds(20));
  CHECK(weak[0].peak == Stamp::from_seconds(22));
  CHECK(weak[0].end == Stamp::from_seconds(23));
  CHECK(weak[0].peak_m == Approx(4));
  CHECK(weak[0].mean_m == Approx(2.9));
  CHECK(weak[0].epochs == 4);
  CHECK(weak[0].reasons.empty());
}

TEST_CASE("weak stretches: worst first, no more than asked for, and none of an even drive") {
  std::vector<EpochResult> epochs = minute();
  CHECK(weak_stretches(epochs, false).empty());
  for (const std::size_t i : {5U, 25U, 45U}) set_sigma(epochs[i], 2 + 0.1 * static_cast<double>(i));
  const auto weak = weak_stretches(epochs, false, 2);
  REQUIRE(weak.size() == 2);
  CHECK(weak[0].peak == Stamp::from_seconds(45));
  CHECK(weak[1].peak == Stamp::from_seconds(25));
}

TEST_CASE("weak stretches: the fixes tell why") {
  std::vector<EpochResult> epochs = minute();
  for (EpochResult& epoch : epochs)
    epoch.told = {.quality = FixQuality::fixed, .satellites = 12, .hdop = 0.8};
  for (std::size_t i = 30; i < 40; ++i) {
    set_sigma(epochs[i], 3);
    epochs[i].status = i < 35 ? FixStatus::rejected : FixStatus::accepted;
    epochs[i].told = {.quality = FixQuality::floating, .satellites = 5, .hdop = 2.4};
  }
  const auto weak = weak_stretches(epochs, false);
  REQUIRE(weak.size() == 1);
  CHECK(tells(weak[0], "no fix used for 6 s"));  // from 29 s to 35 s
  CHECK(tells(weak[0], "50 % of the fixes rejected"));
  CHECK(tells(weak[0], "100 % of the fixes float"));
  CHECK(tells(weak[0], "HDOP 2.4, usually 0.8"));
  CHECK(tells(weak[0], "5 satellites, usually 12"));
}

TEST_CASE("weak stretches: with truth the error counts, not the sigma") {
  std::vector<EpochResult> epochs = minute();
  for (EpochResult& epoch : epochs) epoch.fused_offset_m = Eigen::Vector2d(1, 0);
  for (EpochResult& epoch : epochs) epoch.gnss_offset_m = Eigen::Vector2d(2, 0);
  set_sigma(epochs[10], 9);
  epochs[50].fused_offset_m = Eigen::Vector2d(3, 4);
  epochs[50].gnss_offset_m = Eigen::Vector2d(0, 8);
  const auto weak = weak_stretches(epochs, true);
  REQUIRE(weak.size() == 1);
  CHECK(weak[0].peak == Stamp::from_seconds(50));
  CHECK(weak[0].peak_m == Approx(5));
  CHECK(tells(weak[0], "raw fixes off by 8.00 m, usually 2.00 m"));
}

}  // namespace weak_stretches_test

// Simulated drives with several sources: availability, errors and their correlation, lever arms.
// Bounds are four standard deviations of the estimate.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include <Eigen/Geometry>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/source_statistics.hpp>

#include "tools/experiments/simulated.hpp"

namespace simulation_sources_test {

using namespace waymark;
using namespace waymark::simulation;

namespace {

/// A receiver without errors, at the instants of the truth.
GnssRecipe perfect_receiver(const std::string& name, const Eigen::Vector2d& antenna_m) {
  GnssRecipe gnss{.name = name, .rate_hz = 5, .antenna_m = antenna_m};
  gnss.fast_sigma_m = gnss.jitter_m = gnss.bursts_per_minute = 0;
  return gnss;
}

/// A receiver whose errors last: bias and fast part of 1 m each, per axis.
GnssRecipe lasting_receiver(const std::string& name, double common_share) {
  GnssRecipe gnss{.name = name, .common_share = common_share};
  gnss.bias_sigma_m = gnss.fast_sigma_m = 1;
  gnss.jitter_m = gnss.bursts_per_minute = 0;
  return gnss;
}

SimulationRecipe short_drive(double duration_s) {
  SimulationRecipe recipe;
  recipe.duration_s = duration_s;
  recipe.roads = {waymark_test::straight_road()};
  return recipe;
}

struct Correlation {
  double products = 0, first_squares = 0, other_squares = 0;
  void add(const Eigen::Vector2d& first, const Eigen::Vector2d& other) {
    products += first.dot(other);
    first_squares += first.squaredNorm();
    other_squares += other.squaredNorm();
  }
  [[nodiscard]] double value() const { return products / std::sqrt(first_squares * other_squares); }
};

struct LastingCorrelation {
  Correlation bias, fast;
};

constexpr int kDrives = 2000;

/// Of the first receiver with a further one, over independent drives, two axes each.
LastingCorrelation correlation_of(const SimulationRecipe& recipe, std::size_t further) {
  LastingCorrelation correlation;
  for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
    const SimulatedDrive drive = simulate(recipe, seed);
    const SimulatedGnss& other = drive.further_gnss[further];
    correlation.bias.add(drive.gnss_bias_m, other.bias_m);
    correlation.fast.add(drive.fixes.back().parts.fast, other.fixes.back().parts.fast);
  }
  return correlation;
}

/// Deviation of an estimated correlation of normal numbers.
double correlation_deviation(double correlation) {
  return (1 - correlation * correlation) / std::sqrt(2.0 * kDrives);
}

/// Lengths of the gaps between samples that are longer than the interval, in seconds.
std::vector<double> gaps(const std::vector<OdometrySample>& samples, double rate_hz) {
  std::vector<double> lengths;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double length = seconds_between(samples[i - 1].stamp, samples[i].stamp);
    if (length > 1.5 / rate_hz) lengths.push_back(length);
  }
  return lengths;
}

}  // namespace

TEST_CASE("simulation sources: three receivers have the stated availability and errors") {
  const SimulationRecipe recipe = simulation_preset("three-absolute").recipe;
  struct Stated {
    std::string name;
    double availability_percent, rms_m;
  };
  const std::vector<Stated> stated = {{"front", 67, 1.06}, {"rear", 100, 1.23}, {"roof", 98, 0.28}};
  std::vector<double> squares(stated.size(), 0);
  constexpr int drives = 25;
  for (std::uint64_t seed = 1; seed <= drives; ++seed) {
    const std::vector<SourceStatistics> sources = source_statistics(simulate(recipe, seed));
    REQUIRE(sources.size() == 4);
    CHECK(sources[0].availability_percent == 100);
    for (std::size_t i = 0; i < stated.size(); ++i) {
      CHECK(sources[i + 1].name == stated[i].name);
      CHECK(sources[i + 1].availability_percent == Approx(stated[i].availability_percent).margin(0.1));
      squares[i] += std::pow(sources[i + 1].rms_m, 2) / drives;
    }
  }
  // Relative variance of a mean square over T seconds, two axes: with the shares b of the bias and f of
  // the fast part (tau 4 s), b^2 + f^2 tau / T. Jitter averages out.
  const double b = 0.09;
  const double f = 0.82;
  const double deviation = std::sqrt((b * b + f * f * 4 / (0.67 * 1200)) / drives);
  for (std::size_t i = 0; i < stated.size(); ++i) {
    INFO(stated[i].name);
    CHECK(squares[i] == Approx(std::pow(stated[i].rms_m, 2)).epsilon(4 * deviation));
  }
}

TEST_CASE("simulation sources: no two sources of a preset read at the same instant") {
  for (const char* name : {"three-absolute", "two-odometries", "correlated-receivers"}) {
    const SimulatedDrive drive = simulate(simulation_preset(name).recipe, 1);
    std::set<std::int64_t> instants;
    std::size_t readings = 0;
    const auto add = [&](Stamp stamp) {
      instants.insert(stamp.nanoseconds);
      ++readings;
    };
    for (const OdometrySample& sample : drive.odometry) add(sample.stamp);
    for (const SimulatedFix& fix : drive.fixes) add(fix.fix.stamp);
    for (const SimulatedOdometry& further : drive.further_odometry)
      for (const OdometrySample& sample : further.samples) add(sample.stamp);
    for (const SimulatedGnss& further : drive.further_gnss)
      for (const SimulatedFix& fix : further.fixes) add(fix.fix.stamp);
    INFO(name);
    CHECK(instants.size() == readings);
  }
}

TEST_CASE("simulation sources: a silent odometry has no samples in its outages") {
  SimulationRecipe recipe = short_drive(20'000);
  recipe.further_odometry = {
      {.name = "visual", .rate_hz = 10, .first_s = 0.06, .silent_share = 0.15, .outage_s = 20}};
  const SimulatedDrive drive = simulate(recipe, 1);
  const std::vector<OdometrySample>& samples = drive.further_odometry.front().samples;
  CHECK(drive.odometry.size() == 20'000 * 25);
  CHECK(samples.size() == 170'000);
  CHECK(source_statistics(drive)[1].availability_percent == Approx(85));
  // About 150 outages, exponential. A sixth of them touch another one and are longer.
  const std::vector<double> silent = gaps(samples, 10);
  CHECK(20'000 * 0.15 / static_cast<double>(silent.size()) > 20 * (1 - 4 / std::sqrt(150.0)));
  CHECK(20'000 * 0.15 / static_cast<double>(silent.size()) < 20 * (1 + 4 / std::sqrt(150.0)) * 7 / 6);
}

TEST_CASE("simulation sources: an odometry goes on during its outages") {
  SimulationRecipe recipe = short_drive(300);
  recipe.further_odometry = {{.name = "visual", .rate_hz = 10, .first_s = 0.06}};
  const std::vector<OdometrySample> always = simulate(recipe, 1).further_odometry.front().samples;
  recipe.further_odometry.front().silent_share = 0.3;
  const std::vector<OdometrySample> some = simulate(recipe, 1).further_odometry.front().samples;
  CHECK(always.size() == 3000);
  CHECK(some.size() == 2100);
  for (const OdometrySample& sample : some) {
    const auto at = static_cast<std::size_t>(std::llround(
        seconds_between(always.front().stamp, sample.stamp) * recipe.further_odometry[0].rate_hz));
    CHECK(sample.stamp == always[at].stamp);
    CHECK(sample.yaw_rate_radps == always[at].yaw_rate_radps);
  }
}

TEST_CASE("simulation sources: two odometries are silent for their shares, rarely both") {
  const SimulationRecipe recipe = simulation_preset("two-odometries").recipe;
  double both = 0;
  constexpr int drives = 20;
  for (std::uint64_t seed = 1; seed <= drives; ++seed) {
    const SimulatedDrive drive = simulate(recipe, seed);
    const std::vector<SourceStatistics> sources = source_statistics(drive);
    CHECK(sources[0].availability_percent == Approx(90).margin(0.01));
    CHECK(sources[1].availability_percent == Approx(85).margin(0.01));
    std::set<std::int64_t> spoken;  // seconds
    for (const OdometrySample& sample : drive.odometry)
      spoken.insert(sample.stamp.nanoseconds / 1'000'000'000);
    for (const OdometrySample& sample : drive.further_odometry.front().samples)
      spoken.insert(sample.stamp.nanoseconds / 1'000'000'000);
    both += (1200 - static_cast<double>(spoken.size())) / 1200 / drives;
  }
  CHECK(both > 0);
  // 1.5 % if independent: 360 s of 24,000 s, in about 36 pieces of 10 s.
  CHECK(both < 0.015 * (1 + 4 / std::sqrt(36.0)));
}

TEST_CASE("simulation sources: an antenna is the pose moved by its lever arm") {
  SimulationRecipe recipe = simulation_preset("urban").recipe;
  recipe.gnss = perfect_receiver("rear", {-0.8, 0});
  recipe.further_gnss = {perfect_receiver("roof", {1.5, 0.7})};
  const SimulatedDrive drive = simulate(recipe, 3);
  const drive::Projection projection(drive.frame);
  const auto check = [&](const std::vector<SimulatedFix>& fixes, const Eigen::Vector2d& antenna_m) {
    REQUIRE(fixes.size() == 599 * 5);
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      const StampedPose& body = drive.poses[i + 5];  // the first epoch is at second 1
      const Fix fix = projection.project(fixes[i].fix);
      REQUIRE(fix.stamp == body.stamp);
      const Eigen::Vector2d moved = body.pose.head<2>() + Eigen::Rotation2Dd(body.pose[2]) * antenna_m;
      // Lengths on the grid are shorter by up to 4e-4.
      REQUIRE((fix.position - moved).norm() < 4e-4 * antenna_m.norm());
    }
  };
  check(drive.fixes, {-0.8, 0});
  check(drive.further_gnss.front().fixes, {1.5, 0.7});
  for (const SourceStatistics& source : source_statistics(drive))
    if (source.kind == "gnss") CHECK(source.rms_m < 1e-6);
}

TEST_CASE("simulation sources: an antenna before the body point moves sideways in a turn") {
  SimulationRecipe recipe = simulation_preset("urban").recipe;
  recipe.gnss = perfect_receiver("front", {2.6, 0});
  const SimulatedDrive drive = simulate(recipe, 3);
  const drive::Projection projection(drive.frame);
  double products = 0;
  double squares = 0;
  for (std::size_t i = 1; i + 1 < drive.fixes.size(); ++i) {
    const Fix fix = projection.project(drive.fixes[i].fix);
    if (!fix.heading_rad) continue;
    const double yaw_rate = (drive.poses[i + 6].pose[2] - drive.poses[i + 4].pose[2]) / 0.4;
    const double sideways = *fix.speed_mps * std::sin(*fix.heading_rad - drive.poses[i + 5].pose[2]);
    products += sideways * yaw_rate;
    squares += yaw_rate * yaw_rate;
  }
  // Sideways speed = lever arm x yaw rate. Doppler noise is 0.05 m/s; means over 0.4 s cut 1 % or so.
  CHECK(products / squares == Approx(2.6).epsilon(0.02).margin(4 * 0.05 / std::sqrt(squares)));
}

TEST_CASE("simulation sources: errors of correlated receivers have their common share, others none") {
  SimulationRecipe recipe = short_drive(10);
  recipe.gnss = lasting_receiver("rear", 0.8);
  recipe.further_gnss = {lasting_receiver("front", 0.8), lasting_receiver("roof", 0.2),
                         lasting_receiver("other", 0)};
  const std::vector<double> expected = {0.8, std::sqrt(0.8 * 0.2), 0};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const LastingCorrelation correlation = correlation_of(recipe, i);
    const double margin = 4 * correlation_deviation(expected[i]);
    CHECK(correlation.bias.value() == Approx(expected[i]).margin(margin));
    CHECK(correlation.fast.value() == Approx(expected[i]).margin(margin));
    for (const double squares : {correlation.bias.other_squares, correlation.fast.other_squares,
                                 correlation.bias.first_squares, correlation.fast.first_squares})
      CHECK(squares / (2 * kDrives) == Approx(1).epsilon(4 / std::sqrt(kDrives)));
  }
}

TEST_CASE("simulation sources: the common part lasts as long as the own one") {
  SimulationRecipe recipe = short_drive(20'000);
  recipe.gnss = lasting_receiver("rear", 0.8);
  recipe.further_gnss = {lasting_receiver("front", 0.8)};
  const SimulatedDrive drive = simulate(recipe, 1);
  const std::vector<SimulatedFix>& first = drive.fixes;
  const std::vector<SimulatedFix>& other = drive.further_gnss.front().fixes;
  REQUIRE(first.size() == other.size());
  Correlation now, later;
  for (std::size_t i = 0; i + 15 < first.size(); ++i) {
    now.add(first[i].parts.fast, other[i].parts.fast);
    later.add(first[i].parts.fast, other[i + 15].parts.fast);
  }
  // tau is 30 s; there are 2 x 20,000 / 30 independent pairs or more.
  const double margin = 4 / std::sqrt(2 * 20'000 / 30.0);
  CHECK(now.value() == Approx(0.8).margin(margin * (1 - 0.8 * 0.8)));
  CHECK(later.value() == Approx(0.8 * std::exp(-0.5)).margin(margin));
}

TEST_CASE("simulation sources: further sources leave the first ones as they were") {
  SimulationRecipe recipe = simulation_preset("rural").recipe;
  const SimulatedDrive alone = simulate(recipe, 2);
  recipe.further_odometry = {{.name = "visual", .rate_hz = 10, .first_s = 0.06, .silent_share = 0.2}};
  recipe.further_gnss = {lasting_receiver("front", 0)};
  const SimulatedDrive both = simulate(recipe, 2);
  REQUIRE(both.fixes.size() == alone.fixes.size());
  REQUIRE(both.odometry.size() == alone.odometry.size());
  for (std::size_t i = 0; i < alone.fixes.size(); ++i)
    CHECK(both.fixes[i].fix.latitude_deg == alone.fixes[i].fix.latitude_deg);
  for (std::size_t i = 0; i < alone.odometry.size(); ++i)
    CHECK(both.odometry[i].yaw_rate_radps == alone.odometry[i].yaw_rate_radps);
  CHECK(both.further_gnss.front().bias_m != both.gnss_bias_m);
  CHECK(both.further_odometry.front().gyro_bias_radps != both.gyro_bias_radps);
}

TEST_CASE("simulation sources: with_duration keeps the availability of every receiver") {
  const SimulationRecipe recipe = with_duration(simulation_preset("three-absolute").recipe, 300);
  const std::vector<SourceStatistics> sources = source_statistics(simulate(recipe, 1));
  CHECK(sources[1].availability_percent == Approx(67).margin(0.3));
  CHECK(sources[2].availability_percent == 100);
  CHECK(sources[3].availability_percent == Approx(98).margin(0.1));
}

TEST_CASE("simulation sources: wrong recipes are refused by name") {
  using Catch::Matchers::Message;
  SimulationRecipe recipe = short_drive(20);
  recipe.further_gnss = {lasting_receiver("gnss", 0)};
  CHECK_THROWS_MATCHES(simulate(recipe, 1), UsageError,
                       Message("simulation recipe: the name of a source must be lower-case, of its own and "
                               "not 'drive' or 'truth', got 'gnss'"));
  recipe.further_gnss = {lasting_receiver("front", 1.2)};
  CHECK_THROWS_MATCHES(simulate(recipe, 1), UsageError,
                       Message("simulation recipe: gnss.common_share must be in [0, 1], got 1.2"));
  recipe.further_gnss.clear();
  recipe.further_odometry = {{.name = "visual", .first_s = 0.005}};
  CHECK_THROWS_MATCHES(
      simulate(recipe, 1), UsageError,
      Message("simulation recipe: odometry.first_s must be a multiple of 0.01 s, got 0.005"));
}

}  // namespace simulation_sources_test

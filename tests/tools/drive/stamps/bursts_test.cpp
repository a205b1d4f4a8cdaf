// Odometry that is stamped when packets of it arrive, or by whole seconds, and what only looks like it.
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/stamps/bursts.hpp>
#include <waymark/tools/drive/stamps/settle_stamps.hpp>

#include "settled.hpp"

namespace bursts_test {

using namespace waymark;
using namespace waymark::drive;
using waymark_test::settled;

namespace {

double speed_at(double t) {
  return 10 + 4 * std::sin(0.3 * t);
}

/// 10 Hz for 100 s, measured at 0.003 s, 0.103 s, ... with noise, stamped by a clock.
std::vector<OdometrySample> logged(const std::function<double(double)>& clock, int rate_hz = 10) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.02);
  std::vector<OdometrySample> samples;
  for (int i = 0; i < 100 * rate_hz; ++i) {
    const double t = 0.003 + static_cast<double>(i) / rate_hz;
    samples.push_back({Stamp::from_seconds(clock(t)), speed_at(t) + noise(random), 0.1 * std::sin(0.5 * t)});
  }
  return samples;
}

}  // namespace

TEST_CASE("stamps: readings that share the stamp of their second are spread over it") {
  std::vector<OdometrySample> samples = logged([](double t) { return std::floor(t); });
  const PrepareReport report = settled(samples);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0],
             Catch::StartsWith(
                 "odo.csv: the stamps are cut off: 10 readings of the odometry share each of them, 1 s"));
  REQUIRE(samples.size() == 1000);
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(samples[i].stamp.seconds() == Approx(0.1 * static_cast<double>(i)).margin(1e-6));
}

TEST_CASE("stamps: a packet of readings that arrives each second is spread over the second before") {
  std::vector<OdometrySample> samples =
      logged([](double t) { return std::ceil(t) + 0.02 + 0.02 * (t - std::floor(t)); });
  const PrepareReport report = settled(samples);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(
      report.warnings[0],
      Catch::StartsWith("odo.csv: bursts of 10 readings of the odometry come within 0.018 s, every 1 s"));
  // The last one of 0.903 s arrives at 1.03806 s: a delay that all have.
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(samples[i].stamp.seconds() - 0.1 * static_cast<double>(i) == Approx(0.13806).margin(1e-6));
}

TEST_CASE("stamps: packets that do not come leave a gap") {
  std::vector<OdometrySample> samples = logged([](double t) { return std::ceil(t); });
  std::erase_if(samples, [](const OdometrySample& sample) {
    return sample.stamp.seconds() > 40.5 && sample.stamp.seconds() < 45.5;
  });
  CHECK(settled(samples).warnings.size() == 1);
  double longest_s = 0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    longest_s = std::max(longest_s, seconds_between(samples[i - 1].stamp, samples[i].stamp));
  CHECK(longest_s == Approx(5.1));
}

TEST_CASE("stamps: readings that were measured at once stay where they are, and are told") {
  // a sensor that wakes each second for 20 ms
  std::vector<OdometrySample> samples;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.05);
  for (int burst = 0; burst < 100; ++burst)
    for (int i = 0; i < 10; ++i) {
      const double t = burst + 0.002 * i;
      samples.push_back({Stamp::from_seconds(t), speed_at(t) + noise(random), noise(random)});
    }
  const std::vector<OdometrySample> before = samples;
  const PrepareReport report = settled(samples);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Catch::Contains("so the stamps are kept"));
  for (std::size_t i = 0; i < samples.size(); ++i) CHECK(samples[i].stamp == before[i].stamp);
}

TEST_CASE("stamps: a regular clock, a trembling one and one of few digits are no bursts") {
  std::vector<OdometrySample> regular = logged([](double t) { return t; });
  CHECK(settled(regular).warnings.empty());
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> late(0, 0.08);
  std::vector<OdometrySample> trembling = logged([&](double t) { return t + late(random); });
  CHECK(settled(trembling).warnings.empty());
  // 20 Hz in stamps of a tenth
  std::vector<OdometrySample> tenths = logged([](double t) { return std::floor(10 * t) / 10; }, 20);
  CHECK(settled(tenths).warnings.empty());
  // half a second of readings, half a second of silence
  std::vector<OdometrySample> silent = logged([](double t) { return t; });
  std::erase_if(silent, [](const OdometrySample& sample) {
    return sample.stamp.seconds() - std::floor(sample.stamp.seconds()) > 0.55;
  });
  CHECK(settled(silent).warnings.empty());
}

namespace {

/// Counts the ticks of two wheels.
SensorTable ticks_of(const std::vector<OdometrySample>& samples) {
  SensorTable table;
  table.columns = 3;
  double left = 0, right = 0;
  for (const OdometrySample& sample : samples) {
    left = std::round(left + 50 * sample.speed_mps);
    right = std::round(right + 52 * sample.speed_mps);
    table.stamps.push_back(sample.stamp);
    table.values.insert(table.values.end(), {left, NAN, right});
  }
  return table;
}

}  // namespace

TEST_CASE("stamps: a table of ticks in packets is spread, too") {
  SensorTable table = ticks_of(logged([](double t) { return std::floor(t); }));
  PrepareReport report;
  settle_stamps(table, "odo.csv", report);
  CHECK(report.warnings.size() == 1);
  CHECK(table.stamps[437].seconds() == Approx(43.7));
}

TEST_CASE("stamps: a table in packets is spread where its clock stepped back, too") {
  SensorTable table =
      ticks_of(logged([](double t) { return std::floor(t) - (t > 59.99 && t < 69.99 ? 30 : 0); }));
  const std::size_t rows = table.size();
  PrepareReport report;
  settle_stamps(table, "odo.csv", report);
  CHECK(report.warnings.size() == 2);
  REQUIRE(table.size() == rows - 100);  // 10 s of 10 Hz
  CHECK(table.stamps[437].seconds() == Approx(43.7));
  CHECK(table.stamps[637].seconds() == Approx(73.7));
}

TEST_CASE("stamps: fixes that arrive five at once are spread over the time since those before") {
  std::vector<GeodeticFix> fixes;
  for (int i = 0; i < 200; ++i) {
    GeodeticFix fix;
    fix.stamp = Stamp::from_seconds(5.0 * (i / 5 + 1) + 0.05 * (i % 5));
    fix.latitude_deg = 50 + 1e-4 * i;
    fix.longitude_deg = 15 + 1e-5 * std::sin(0.1 * i);
    fixes.push_back(fix);
  }
  PrepareReport report;
  settle_bursts(fixes, "gnss.csv", report);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0],
             Catch::StartsWith("gnss.csv: bursts of 5 fixes come within 0.2 s, every 5 s"));
  // the last one of a burst is stamped when it arrives
  for (int i = 0; i < 200; ++i)
    CHECK(fixes[static_cast<std::size_t>(i)].stamp.seconds() == Approx(i + 1.2).margin(1e-6));
}

TEST_CASE("stamps: fixes at even times stay where they are") {
  std::vector<GeodeticFix> fixes(200);
  for (std::size_t i = 0; i < fixes.size(); ++i) fixes[i].stamp = Stamp::from_seconds(static_cast<double>(i));
  PrepareReport report;
  settle_bursts(fixes, "gnss.csv", report);
  CHECK(report.warnings.empty());
  CHECK(fixes[150].stamp.seconds() == 150);
}

}  // namespace bursts_test

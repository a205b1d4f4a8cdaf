// A clock of the odometry that steps back into a time that has readings, and what only looks like it.
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/stamps/settle_stamps.hpp>
#include <waymark/tools/drive/stamps/steps_back.hpp>

#include "settled.hpp"

namespace steps_back_test {

using namespace waymark;
using namespace waymark::drive;
using waymark_test::settled;

namespace {

double speed_at(double t) {
  return 10 + 3 * std::sin(0.2 * t);
}

/// 20 Hz from 0 s to 300 s, stamped by a clock.
std::vector<OdometrySample> logged(const std::function<double(double)>& clock) {
  std::vector<OdometrySample> samples;
  for (int i = 0; i <= 6000; ++i) {
    const double t = 0.05 * i;
    samples.push_back({Stamp::from_seconds(clock(t)), speed_at(t), 0.01 * std::sin(t)});
  }
  return samples;
}

double true_time(double t) {
  return t;
}

}  // namespace

TEST_CASE("stamps: a clock that steps back by 70 s for 20 s is told, and its rows are left out") {
  std::vector<OdometrySample> samples =
      logged([](double t) { return t > 199.99 && t < 220 ? t - 70.017 : t; });
  const PrepareReport report = settled(samples);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(
      report.warnings[0],
      Catch::StartsWith("odo.csv: the clock of the odometry steps back by 69.967 s at reading 4001 of 6001"));
  CHECK_THAT(report.warnings[0], Catch::Contains("the 400 readings of 20.0 s"));
  CHECK(samples.size() == 5601);
  for (const OdometrySample& sample : samples)
    CHECK(sample.speed_mps == Approx(speed_at(sample.stamp.seconds())));
}

TEST_CASE("stamps: behind a clock that was set back for good, what overlaps is left out") {
  std::vector<OdometrySample> samples = logged([](double t) { return t > 199.99 ? t - 40.02 : t; });
  CHECK(settled(samples).warnings.size() == 1);
  // from 160 s to the last stamp before the step
  CHECK(samples.size() == Approx(6001 - 800).margin(2));
}

TEST_CASE("stamps: parts of a log in another order, and repeated ones, are no steps of a clock") {
  const std::vector<OdometrySample> whole = logged(true_time);
  std::vector<OdometrySample> turned(whole.begin() + 4000, whole.end());
  turned.insert(turned.end(), whole.begin() + 2000, whole.begin() + 4000);
  turned.insert(turned.end(), whole.begin(), whole.begin() + 2000);
  CHECK(settled(turned).warnings.empty());
  CHECK(turned.size() == whole.size());
  std::vector<OdometrySample> twice = whole;
  twice.insert(twice.end(), whole.begin() + 3000, whole.end());
  const std::size_t rows = twice.size();
  CHECK(settled(twice).warnings.empty());
  CHECK(twice.size() == rows);
}

TEST_CASE("stamps: threads of a logger, late rows and a part that returns into a hole are kept") {
  // two threads, one of which is 2 s behind
  std::vector<OdometrySample> threads;
  for (int i = 0; i <= 3000; ++i) {
    threads.push_back({Stamp::from_seconds(0.1 * i), 10, 0});
    threads.push_back({Stamp::from_seconds(0.1 * i - 2.05), 10, 0});
  }
  CHECK(settled(threads).warnings.empty());
  CHECK(threads.size() == 6002);
  // ten rows that come 5 s late
  std::vector<OdometrySample> late = logged(true_time);
  std::rotate(late.begin() + 3000, late.begin() + 3010, late.begin() + 3110);
  CHECK(settled(late).warnings.empty());
  CHECK(late.size() == 6001);
  // a minute that was buffered until the end
  std::vector<OdometrySample> buffered = logged(true_time);
  std::rotate(buffered.begin() + 2000, buffered.begin() + 3200, buffered.end());
  CHECK(settled(buffered).warnings.empty());
  CHECK(buffered.size() == 6001);
}

TEST_CASE("stamps: each channel of a table has a past of its own") {
  SensorTable table;
  table.columns = 2;
  const auto add = [&](double t, double a, double b) {
    table.stamps.push_back(Stamp::from_seconds(t));
    table.values.insert(table.values.end(), {a, b});
  };
  for (int i = 0; i <= 1000; ++i) add(0.1 * i, speed_at(0.1 * i), NAN);
  for (int i = 0; i <= 1000; ++i) add(0.1 * i, NAN, 0.01);
  const std::vector<double> before = table.values;
  PrepareReport report;
  settle_stamps(table, "odo.csv", report);
  CHECK(report.warnings.empty());
  // the speed alone goes back, by 30 s
  for (int i = 0; i < 100; ++i) add(70 + 0.1 * i + 0.03, 3, NAN);
  settle_stamps(table, "odo.csv", report);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Catch::Contains("the 100 readings of 9.9 s"));
  CHECK(table.size() == 2002);
  for (std::size_t row = 0; row <= 1000; ++row) CHECK(table.at(row, 0) == before[2 * row]);
}

TEST_CASE("stamps: each step of the clock of a table is told, and each once for all channels") {
  SensorTable table;
  table.columns = 2;
  for (int i = 0; i <= 6000; ++i) {
    const double t = 0.05 * i;
    const double steps_s = t > 100.01 && t < 110 ? 20 : t > 199.99 && t < 220 ? 70.017 : 0;
    table.stamps.push_back(Stamp::from_seconds(t - steps_s));
    const bool is_speed = i % 2 == 0;  // the channels take turns
    table.values.insert(table.values.end(), {is_speed ? speed_at(t) : NAN, is_speed ? NAN : 0.01 * t});
  }
  PrepareReport report;
  settle_stamps(table, "odo.csv", report);
  REQUIRE(report.warnings.size() == 2);
  CHECK_THAT(report.warnings[0], Catch::Contains("steps back by 19.9"));
  CHECK_THAT(report.warnings[1], Catch::Contains("steps back by 69.9"));
  CHECK(table.size() == 6001 - 199 - 400);  // those of 10 s and 20 s
}

}  // namespace steps_back_test

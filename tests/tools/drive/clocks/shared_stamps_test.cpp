// Fixes that share their stamps: seconds without decimals are spread, two receivers are refused.
#include <cmath>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/logs/shared_stamps.hpp>

namespace shared_stamps_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Contains;

namespace {

constexpr double kMetresPerDegree = 111'194.93;

/// Where the vehicle is after t seconds, m east: its speed varies from 4 to 12 m/s.
double way_at(double t) {
  return 8 * t - 40 * std::cos(0.1 * t);
}

GeodeticFix fix_at(double stamp_s, double east_m, double north_m) {
  GeodeticFix fix;
  fix.stamp = Stamp::from_seconds(stamp_s);
  fix.latitude_deg = north_m / kMetresPerDegree;
  fix.longitude_deg = 8 + east_m / kMetresPerDegree;
  return fix;
}

}  // namespace

TEST_CASE("shared stamps: seconds without decimals at 5 Hz are spread over the second") {
  std::vector<GeodeticFix> fixes;
  for (int i = 0; i < 500; ++i) {
    const double t = 0.2 * i;
    fixes.push_back(fix_at(std::floor(t + 1e-9), way_at(t), 0.3 * std::sin(9 * t)));
  }
  PrepareReport report;
  settle_shared_stamps(fixes, "gnss.csv", report);
  REQUIRE(fixes.size() == 500);
  for (int i = 0; i < 500; ++i)
    CHECK(fixes[static_cast<std::size_t>(i)].stamp.seconds() == Approx(0.2 * i).margin(1e-6));
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("the stamps are cut off: 500 fixes have 100 stamps"));
}

TEST_CASE("shared stamps: two antennas are two receivers, ahead of each other or beside") {
  for (const double ahead_m : {0.0, 5.0}) {
    std::vector<GeodeticFix> fixes;
    for (int i = 0; i < 100; ++i) {
      fixes.push_back(fix_at(i, way_at(i), 0));
      fixes.push_back(fix_at(i, way_at(i) + ahead_m, 1));
    }
    PrepareReport report;
    CHECK_THROWS_WITH(
        settle_shared_stamps(fixes, "gnss.csv", report),
        Contains("gnss.csv: several receivers write into this log: 100 of 100 stamps have more than "
                 "one position") &&
            Contains("'where: COLUMN == VALUE'"));
  }
}

TEST_CASE("shared stamps: single contradictions, repetitions and standing fixes stay as they are") {
  std::vector<GeodeticFix> fixes;
  for (int i = 0; i < 100; ++i) {
    fixes.push_back(fix_at(i, way_at(i), 0));
    if (i % 10 == 0) fixes.push_back(fix_at(i, way_at(i), 2));  // contradicts
    if (i % 2 == 0) fixes.push_back(fixes.back());              // repeats
  }
  std::vector<GeodeticFix> standing;
  for (int i = 0; i < 300; ++i) standing.push_back(fix_at(i / 3, 0.01 * i, 0));
  for (std::vector<GeodeticFix>* each : {&fixes, &standing}) {
    const std::vector<GeodeticFix> before = *each;
    PrepareReport report;
    settle_shared_stamps(*each, "gnss.csv", report);
    REQUIRE(each->size() == before.size());
    for (std::size_t i = 0; i < before.size(); ++i) CHECK((*each)[i].stamp == before[i].stamp);
    CHECK(report.notes.empty());
  }
}

TEST_CASE("shared stamps: two receivers that write into one log in turn are told by stamps or by positions") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  constexpr double kDegreesPerMetre = 1 / 111'195.0;
  // Along a circle of 50 m radius at 10 m/s; every second fix is aside and later.
  const auto said = [&](double aside_m, double later_s, double noise_m) {
    std::vector<GeodeticFix> fixes;
    for (int k = 0; k < 100; ++k) {
      const double time_s = 0.5 * k + (k % 2 == 0 ? 0 : later_s);
      const double radius_m = 50 + (k % 2 == 0 ? 0 : aside_m);
      GeodeticFix fix;
      fix.stamp = Stamp::from_seconds(time_s);
      fix.latitude_deg = kDegreesPerMetre * (radius_m * std::sin(time_s / 5) + noise_m * normal(random));
      fix.longitude_deg = kDegreesPerMetre * (radius_m * std::cos(time_s / 5) + noise_m * normal(random));
      fixes.push_back(fix);
    }
    return warning_of_turns(fixes, "both.nmea");
  };
  CHECK(said(0, 0, 0).empty());
  CHECK(said(0, 0, 2).empty());
  CHECK(said(1, 0, 2).empty());  // the noise hides it
  CHECK_THAT(said(1.2, 0, 0.1),
             Catch::StartsWith("both.nmea: two receivers seem to write into this log in turn") &&
                 Catch::Contains("its positions go to and fro from fix to fix"));
  CHECK_THAT(said(1, 0.3, 2), Catch::Contains("the intervals of its stamps alternate"));
}

}  // namespace shared_stamps_test

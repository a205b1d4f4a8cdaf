// Two fleets compared: the statistics have the values of theory, and drives are judged by the rule.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/tools/fleet/comparison/regression.hpp>

namespace fleet_regression_test {

using namespace waymark::fleet;

namespace {

/// A drive whose only number is its error against truth.
DriveRecord drive(const std::string& name, double rmse_m, const std::string& environment = "urban") {
  DriveRecord record{.drive = name, .fingerprint = "", .label = "", .program = "", .state = DriveState::done};
  record.environment = environment;
  ModelingRow row{"g1", {}};
  for (const Column& column : columns())
    row.numbers.push_back(std::string(column.name) == "rmse_m" ? rmse_m : std::nan(""));
  record.rows = {row};
  return record;
}

DriveRecord failed(const std::string& name) {
  DriveRecord record{.drive = name, .fingerprint = "", .label = "", .program = ""};
  record.reason = "gnss.csv: cannot read";
  return record;
}

Fleet fleet_of(std::vector<DriveRecord> records) {
  Fleet fleet;
  for (const DriveRecord& record : records) fleet.plan.drives.push_back({record.drive, ""});
  fleet.records = std::move(records);
  return fleet;
}

Change change_of(double before, double now) {
  return compare_fleets(fleet_of({drive("a", before)}), fleet_of({drive("a", now)}), {}).pairs.at(0).change;
}

}  // namespace

TEST_CASE("fleet: the sign test has the probabilities of fair coins") {
  CHECK(sign_test(0, 0) == 1);
  CHECK(sign_test(0, 1) == 1);  // both ways are as uneven
  CHECK(sign_test(10, 10) == Approx(2.0 / 1024).epsilon(1e-12));
  CHECK(sign_test(1, 10) == Approx(2 * 11.0 / 1024).epsilon(1e-12));
  CHECK(sign_test(9, 10) == sign_test(1, 10));
  CHECK(sign_test(5, 10) == 1);
  // 15 of 20: the tail of Bin(20, 1/2) from 15 on is 21700 / 2^20
  CHECK(sign_test(15, 20) == Approx(2 * 21700.0 / 1048576).epsilon(1e-12));
  CHECK(sign_test(5200, 10000) == Approx(6.6e-5).epsilon(0.05));  // normal: z = 3.99
}

TEST_CASE("fleet: the interval of a median are the order statistics of the binomial table") {
  const auto interval = [](std::size_t n) {
    std::vector<double> values;
    for (std::size_t i = 1; i <= n; ++i) values.push_back(static_cast<double>(i));
    return median_interval(values);
  };
  CHECK(std::isnan(interval(5).first));                    // 1 - 2/32 = 94 %
  CHECK(interval(6) == std::pair<double, double>(1, 6));   // 1 - 2/64 = 97 %
  CHECK(interval(10) == std::pair<double, double>(2, 9));  // Conover, table A3
  CHECK(interval(20) == std::pair<double, double>(6, 15));
  CHECK(interval(100) == std::pair<double, double>(40, 61));
}

TEST_CASE("fleet: a drive got worse if its error grew by more than both limits") {
  CHECK(change_of(1, 1.06) == Change::worse);
  CHECK(change_of(1, 1.04) == Change::same);     // below 5 %
  CHECK(change_of(0.1, 0.119) == Change::same);  // 19 %, but below 2 cm
  CHECK(change_of(0.1, 0.121) == Change::worse);
  CHECK(change_of(1, 0.94) == Change::better);
  CHECK(change_of(0, 0.03) == Change::worse);
  CHECK(change_of(1, std::nan("")) == Change::unjudged);
}

TEST_CASE("fleet: a drive that fails now was lost, and a fleet that loses drives got worse") {
  const Fleet before = fleet_of({drive("a", 1), drive("b", 1), failed("c"), failed("d"), drive("old", 1)});
  const Fleet now = fleet_of({drive("a", 1), failed("b"), drive("c", 1), failed("d"), drive("new", 1)});
  const Regression regression = compare_fleets(before, now, {});
  REQUIRE(regression.pairs.size() == 4);
  CHECK(regression.pairs[0].change == Change::same);
  CHECK(regression.pairs[1].change == Change::lost);
  CHECK(regression.pairs[1].modeling == "g1");
  CHECK(regression.pairs[1].reason == "gnss.csv: cannot read");
  CHECK(regression.pairs[2].change == Change::gained);
  CHECK(regression.pairs[3].change == Change::unjudged);
  CHECK(regression.only_old == std::vector<std::string>{"old g1"});
  CHECK(regression.only_new == std::vector<std::string>{"new g1"});
  CHECK(regression.fleet() == FleetChange::none);  // one lost, one gained
  CHECK(compare_fleets(fleet_of({drive("b", 1)}), fleet_of({failed("b")}), {}).fleet() == FleetChange::worse);
}

TEST_CASE("fleet: many small changes one way are a change of the fleet, ties are none") {
  std::vector<DriveRecord> before;
  std::vector<DriveRecord> now;
  for (int i = 0; i < 12; ++i) {
    const std::string environment = i < 6 ? "rural" : "urban";
    before.push_back(drive("d" + std::to_string(10 + i), 1, environment));
    now.push_back(drive("d" + std::to_string(10 + i), i < 10 ? 1.01 : 1 + 0.5e-4, environment));
  }
  const Regression regression = compare_fleets(fleet_of(before), fleet_of(now), {});
  CHECK(regression.all.worse == 0);
  CHECK(regression.all.same == 12);
  CHECK(regression.all.grew == 10);
  CHECK(regression.all.chance == Approx(2.0 / 1024));
  CHECK(regression.all.median_ratio == Approx(1.01));
  CHECK(regression.fleet() == FleetChange::worse);
  REQUIRE(regression.environments.size() == 2);
  CHECK(regression.environments[0].first == "rural");
  CHECK(regression.environments[0].second.grew == 6);
  CHECK(regression.environments[1].second.grew == 4);
  CHECK(compare_fleets(fleet_of(now), fleet_of(before), {}).fleet() == FleetChange::better);
}

}  // namespace fleet_regression_test

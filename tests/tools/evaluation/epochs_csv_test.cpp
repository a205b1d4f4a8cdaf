#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/evaluation/output/epochs_csv.hpp>

namespace epochs_csv_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

constexpr auto kColumns = 31;

EpochResult epoch_at(std::int64_t nanoseconds) {
  EpochResult epoch;
  epoch.stamp = Stamp{nanoseconds};
  epoch.status = FixStatus::accepted;
  return epoch;
}

}  // namespace

TEST_CASE("epochs.csv: what is not defined is an empty field") {
  const auto lines = lines_of(epochs_csv(std::vector{epoch_at(1'149'206'567'040'000'001)}));
  REQUIRE(lines.size() == 2);
  CHECK(lines[1] == "1149206567040000001,0,accepted," + std::string(kColumns - 4, ','));
}

TEST_CASE("epochs.csv: numbers, and offsets turned into the direction of travel") {
  EpochResult epoch = epoch_at(2'900'000'000);
  epoch.status = FixStatus::rejected;
  epoch.reason = "far, \"very\"";
  epoch.fix_sigma_m = {2, 3};
  epoch.gnss_offset_m = {1, 4};
  epoch.fused_offset_m = {-0.5, 0.25};
  epoch.direction_rad = 0;  // eastwards: north is to the left
  epoch.heading_error_rad = -3.14159265358979323846;
  epoch.speed_mps = -1.5;
  epoch.position_covariance = Eigen::Matrix2d{{4, 1}, {1, 9}};
  epoch.nees = 0.125;
  epoch.nu = 6;
  epoch.fix_residual_m = {0.5, -2};
  epoch.heading_sigma_rad = 3.14159265358979323846 / 360;
  epoch.told = {.quality = FixQuality::floating, .satellites = 9, .hdop = 1.25};
  epoch.raw_place = GeodeticPoint{52.5, 13.25};
  epoch.fused_place = GeodeticPoint{52.75, 13.5};
  const auto lines = lines_of(epochs_csv(std::vector{epoch_at(1'000'000'000), epoch}));
  REQUIRE(lines.size() == 3);
  CHECK(lines[2] ==
        "2900000000,1.9,rejected,\"far, "
        "\"\"very\"\"\",2,3,1,4,-0.5,0.25,1,4,-0.5,0.25,-180,-1.5,4,1,9,0.125,6,"
        "0.5,-2,0.5,float,9,1.25,52.5,13.25,52.75,13.5");
}

TEST_CASE("epochs.csv: at a pose without a fix the status is empty") {
  EpochResult epoch = epoch_at(0);
  epoch.status = std::nullopt;
  CHECK(lines_of(epochs_csv(std::vector{epoch}))[1] == "0,0," + std::string(kColumns - 3, ','));
}

TEST_CASE("epochs.csv: without a direction of travel there is no along and across") {
  EpochResult epoch = epoch_at(0);
  epoch.gnss_offset_m = {1, 4};
  const auto lines = lines_of(epochs_csv(std::vector{epoch}));
  CHECK(lines[1] == "0,0,accepted,,,,1,4" + std::string(kColumns - 8, ','));
}

TEST_CASE("epochs.csv: every row has the header's columns, and no fixes leave the header alone") {
  const auto lines = lines_of(epochs_csv({}));
  REQUIRE(lines.size() == 1);
  CHECK(std::count(lines[0].begin(), lines[0].end(), ',') == kColumns - 1);
}

}  // namespace epochs_csv_test

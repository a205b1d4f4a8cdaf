// A speed that is late beside a gyro that is on time, as OBD delivers it: found, told with its key, and moved.
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"

namespace late_speed_test {

namespace {

/// Ten minutes of a simulated city, whose odometry has 25 rows per second.
class CityDrive {
 public:
  CityDrive() : folder_(fresh_folder()) {
    REQUIRE(run({"simulate", "--preset", "urban", "--duration", "600", "--seed", "7", "-o", folder_}).code ==
            0);
    description_ = read_text(folder_ + "drive.yaml");
    std::istringstream log(read_text(folder_ + "odometry.csv"));
    for (std::string row; std::getline(log, row);)
      if (row.front() >= '0' && row.front() <= '9') rows_.push_back(row);
  }

  struct Result {
    std::string messages;
    double rmse_m = 0;  ///< of the positions, against the truth
  };
  /// Runs it with readings from some rows before. @param keys of 'odometry', indented
  [[nodiscard]] Result run_with(std::size_t speed_rows_late, std::size_t yaw_rate_rows_late,
                                const std::string& keys = "") const;

 private:
  std::string folder_, description_;
  std::vector<std::string> rows_;
};

CityDrive::Result CityDrive::run_with(std::size_t speed_rows_late, std::size_t yaw_rate_rows_late,
                                      const std::string& keys) const {
  const auto field = [](const std::string& row, int number) {
    std::istringstream fields(row);
    std::string text;
    for (int i = 0; i <= number; ++i) std::getline(fields, text, ',');
    return text;
  };
  std::string log = "time_s,speed_mps,yaw_rate_radps\n";
  for (std::size_t i = 25; i < rows_.size(); ++i)
    log += field(rows_[i], 0) + "," + field(rows_[i - speed_rows_late], 1) + "," +
           field(rows_[i - yaw_rate_rows_late], 2) + "\n";
  write_text(folder_ + "odometry.csv", log);
  std::string description = description_;
  const std::string entry = "odometry:\n";
  description.insert(description.find(entry) + entry.size(), keys);
  write_text(folder_ + "drive.yaml", description);
  const RunResult result = run({"run", folder_ + "drive.yaml", "-o", folder_ + "out"});
  REQUIRE(result.code == 0);
  const auto metrics = nlohmann::json::parse(read_text(folder_ + "out/metrics.json"));
  return {result.err, metrics["evaluations"][0]["truth"]["fused"]["position"]["rmse_m"].get<double>()};
}

}  // namespace

TEST_CASE("late speed: OBD that is 0.4 s late is moved, told with its key, and costs nothing") {
  const CityDrive drive;
  const CityDrive::Result sound = drive.run_with(0, 0);
  CHECK_FALSE(contains(sound.messages, "seems"));
  const CityDrive::Result late = drive.run_with(10, 0);
  CHECK(contains(late.messages, "warning: the odometry's speed seems 0."));
  CHECK(contains(late.messages,
                 "s late, its yaw rate not: its readings are moved by that; state 'speed_delay: 0."));
  CHECK_FALSE(contains(late.messages, "'time: {offset"));
  CHECK(late.rmse_m < 1.1 * sound.rmse_m);
}

TEST_CASE("late speed: what is stated of delays stays, and what is left is told") {
  const CityDrive drive;
  const CityDrive::Result stated = drive.run_with(20, 0, "  speed_delay: 0\n");
  CHECK(contains(stated.messages, "s late, its yaw rate not: increase 'speed_delay' by 0."));
  CHECK_FALSE(contains(stated.messages, "'time: {offset"));
  const CityDrive::Result right = drive.run_with(20, 0, "  speed_delay: 0.8\n");
  CHECK_FALSE(contains(right.messages, "seems"));
  CHECK(2 * right.rmse_m < stated.rmse_m);
}

TEST_CASE("late speed: a clock that is late for both is still a matter of the clock") {
  const CityDrive drive;
  const CityDrive::Result late = drive.run_with(10, 10);
  CHECK(contains(late.messages, "the odometry is probably late: its readings are moved by that; add -0."));
  CHECK_FALSE(contains(late.messages, "the odometry's clock seems"));  // it is told once
  CHECK_FALSE(contains(late.messages, "speed_delay"));
}

}  // namespace late_speed_test

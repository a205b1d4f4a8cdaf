// Times of counters of 32 bits: they begin anew after 2^32 and go on.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/csv/csv_log.hpp>

namespace csv_counters_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

constexpr std::int64_t kRound = std::int64_t{1} << 32;

/// Returns the stamps of counts in a unit, ns.
std::vector<std::int64_t> stamps(const std::vector<std::int64_t>& counts, const std::string& unit,
                                 std::vector<std::string>* notes = nullptr) {
  LogRequest request;
  request.stream = StreamKind::odometry;
  request.time_scale = TimeScale::utc;
  request.columns["time"] = {"t", unit, ""};
  std::string text = "t,speed,yaw_rate\n";
  for (const std::int64_t count : counts) text += std::to_string(count) + ",1,0\n";
  const LogData data = CsvLogReader().read(text, "log.csv", request);
  if (notes != nullptr) *notes = data.notes;
  std::vector<std::int64_t> result;
  for (const OdometrySample& sample : data.odometry) result.push_back(sample.stamp.nanoseconds);
  return result;
}

}  // namespace

TEST_CASE("csv: micros and millis go on after 2^32, once and again, and a note tells it") {
  std::vector<std::string> notes;
  const std::int64_t half = kRound / 2;
  CHECK(stamps({kRound - 1, 4, half, kRound - 10, 0}, "us", &notes) ==
        std::vector<std::int64_t>{(kRound - 1) * 1000, (kRound + 4) * 1000, (kRound + half) * 1000,
                                  (2 * kRound - 10) * 1000, 2 * kRound * 1000});
  CHECK(notes.back() ==
        "log.csv: the times are those of a counter of 32 bits: 2 of its ends (2^32 us) are in the log, and "
        "they go on");
  CHECK(stamps({kRound - 1, 4}, "ms") ==
        std::vector<std::int64_t>{(kRound - 1) * 1'000'000, (kRound + 4) * 1'000'000});
}

TEST_CASE("csv: counts in disorder stay in their rounds, and other falls are left alone") {
  CHECK(stamps({kRound - 5, 3, kRound - 2, 8}, "us") ==
        std::vector<std::int64_t>{(kRound - 5) * 1000, (kRound + 3) * 1000, (kRound - 2) * 1000,
                                  (kRound + 8) * 1000});
  const auto unchanged = [](const std::vector<std::int64_t>& counts, const std::string& unit,
                            std::int64_t tick_ns) {
    std::vector<std::int64_t> expected;
    for (const std::int64_t count : counts) expected.push_back(count * tick_ns);
    return stamps(counts, unit) == expected;
  };
  CHECK(unchanged({3'000'000'000, 5}, "us", 1000));       // a device that was started again
  CHECK(unchanged({1'000'000, 5}, "us", 1000));           // rows in disorder
  CHECK(unchanged({kRound + 5, 5}, "us", 1000));          // a counter of more bits
  CHECK(unchanged({kRound - 1, 4}, "s", 1'000'000'000));  // no counter of this kind
}

TEST_CASE("csv: the end of a counter is seen in rows that are not read") {
  LogRequest request;
  request.stream = StreamKind::gnss;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 1;
  request.columns["time"] = {"t", "us", ""};
  request.where = RowFilter{"valid", "1", true};
  const LogData data = CsvLogReader().read(
      "t,latitude,longitude,valid\n4294967290,,,0\n10,50,15,1\n20,50,15,1\n", "log.csv", request);
  REQUIRE(data.fixes.size() == 2);
  CHECK(data.fixes[0].stamp.nanoseconds == (kRound + 10) * 1000);
}

}  // namespace csv_counters_test

// Files of one source around the end of a GPS week: each tells times of the week of its own.
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/drive/logs/shared_weeks.hpp>

namespace shared_weeks_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

constexpr std::int64_t kWeek_s = 604'800;

/// A file whose reader counts weeks from that of its first row.
struct File {
  DriveLogs::Log log;
  LogConfig config;

  File(const std::string& name, std::int64_t begin_s, int week) {
    log.file = name;
    config.request.gps_week = week;
    for (int i = 0; i < 10; ++i)
      log.data.readings.stamps.push_back({(week * kWeek_s + begin_s + i) * 1'000'000'000});
  }
  [[nodiscard]] std::int64_t begin_s() const {
    return log.data.readings.stamps.front().nanoseconds / 1'000'000'000;
  }
  [[nodiscard]] std::int64_t end_s() const {
    return log.data.readings.stamps.back().nanoseconds / 1'000'000'000;
  }
};

void share(std::vector<File>& files) {
  std::vector<ReadLog> read;
  for (File& file : files) read.push_back({&file.log, &file.config});
  share_weeks(read);
}

}  // namespace

TEST_CASE("shared weeks: a file that begins after the end of the week of another one goes on behind it") {
  for (const int week : {0, 2314}) {
    INFO(week);
    std::vector<File> files{{"wheels.csv", kWeek_s - 5, week}, {"gyro.csv", 1, week}};
    share(files);
    CHECK(files[0].begin_s() == (week + 1) * kWeek_s - 5);
    CHECK(files[0].end_s() == (week + 1) * kWeek_s + 4);
    CHECK(files[1].begin_s() == (week + 1) * kWeek_s + 1);
    CHECK(files[1].end_s() == (week + 1) * kWeek_s + 10);
    CHECK(files[0].log.data.notes.empty());
    REQUIRE(files[1].log.data.notes.size() == 1);
    CHECK_THAT(files[1].log.data.notes[0], Catch::StartsWith("gyro.csv: ") && Catch::Contains("wheels.csv"));
  }
}

TEST_CASE("shared weeks: files of one week, of weeks that are stated each, and dates stay") {
  std::vector<File> one{{"a.csv", 1000, 0}, {"b.csv", 301'000, 0}};
  share(one);  // 300 000 s are less than half a week
  CHECK(one[0].begin_s() == 1000);
  std::vector<File> stated{{"a.csv", kWeek_s - 5, 2314}, {"b.csv", 1, 2315}};
  share(stated);
  CHECK(stated[1].begin_s() == 2315 * kWeek_s + 1);
  std::vector<File> dates{{"a.csv", 1'400'000'000, 0}, {"b.csv", 1'300'000'000, 0}};
  share(dates);
  CHECK(dates[1].begin_s() == 1'300'000'000);
}

TEST_CASE("shared weeks: a file that overlaps another one as it is stays, however long before it begins") {
  std::vector<File> files{{"wheels.csv", 86'400, 2314}, {"gyro.csv", 450'000, 2314}};
  for (int i = 0; i < 100; ++i)
    files[0].log.data.readings.stamps.push_back({(2314 * kWeek_s + 450'000 + i) * 1'000'000'000});
  share(files);
  CHECK(files[0].begin_s() == 2314 * kWeek_s + 86'400);
  CHECK(files[1].begin_s() == 2314 * kWeek_s + 450'000);
}

}  // namespace shared_weeks_test

// Readings of a sensor that no vehicle has.
#include <string>

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/csv/csv_log.hpp>

namespace csv_garbage_test {

using namespace waymark;

TEST_CASE("csv: a velocity that no vehicle has makes a row of a sensor corrupt, and the rest is read") {
  LogRequest sensor;
  sensor.stream = StreamKind::sensor;
  sensor.readings = {{"vx", "m/s", "body", true, ""},
                     {"yaw_rate", "rad/s", "ccw", true, ""},
                     {"range_rate", "m/s", "", true, ""}};
  const LogData data = formats::CsvLogReader().read(
      "time,vx,yaw_rate,range_rate\n1,10,0.1,-900\n2,-152.125,0.1,0\n3,10,57,0\n4,11,0.1,0\n", "log.csv",
      sensor);
  CHECK(data.readings.size() == 2);
  CHECK(data.corrupt == 2);
  CHECK(data.corrupt_examples.at(0) == "log.csv:3:3: vx: '-152.125' m/s is outside -150 .. 150");
}

}  // namespace csv_garbage_test

/// UBX logs of real receivers: their content, which does not depend on the pieces that they come in.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/ubx/ubx.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "support/skip.hpp"

namespace ubx_real_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

constexpr const char* kLogs = "logs/ubx";

LogRequest sensor_request() {
  LogRequest request;
  request.stream = StreamKind::odometry;
  request.readings = odometry_channels();
  return request;
}

}  // namespace

TEST_CASE("ubx: real logs give the same in pieces of any length") {
  const auto logs = waymark_test::shared_data(kLogs);
  if (!logs) return;
  std::string all;
  for (const auto& entry : std::filesystem::directory_iterator(*logs)) {
    const std::string bytes = read_text_file(entry.path().string());
    INFO(entry.path().string());
    all += bytes;
    for (const LogRequest& request : {LogRequest{}, sensor_request()})
      waymark_test::check_pieces(UbxReader(), bytes, "log.ubx", request);
  }
  // Damaged: every 997th byte lost.
  std::string damaged;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % 997 != 0) damaged += all[i];
  }
  const LogData whole = waymark_test::check_pieces(UbxReader(), damaged, "log.ubx", {});
  CHECK(whole.corrupt > 50);
  CHECK(whole.fixes.size() > 100);
}

TEST_CASE("ubx: real logs are known for UBX even where NMEA is mixed in") {
  const auto logs = waymark_test::shared_data(kLogs);
  if (!logs) return;
  for (const char* name : {"gpsd_navisys-gr8013.log", "gpsd_ublox-glo.log", "gpsd_ublox-neo-m8l.log",
                           "gpsd_ublox-neo-m8u-hnr.log", "gpsd_ublox-zed-f9p-hp.log",
                           "pyubx2_pygpsdata-MIXED.log", "swiftnav_nav_pvt_fix_type.ubx"}) {
    const Recognised recognised = recognise_log(*logs + "/" + name, builtin_log_readers());
    CHECK(recognised.reader.name == "ubx");
    CHECK(recognised.why.certainty == 1);
  }
  for (const auto& entry : std::filesystem::directory_iterator(*logs))
    CHECK(UbxReader().recognise(read_text_file(entry.path().string())).certainty > 0.25);
}

TEST_CASE("ubx: a real log of a vehicle's sensors") {
  const auto logs = waymark_test::shared_data(kLogs);
  if (!logs) return;
  const std::string bytes = read_text_file(*logs + "/gpsd_ublox-neo-m8l.log");
  const LogData data = UbxReader().read(bytes, "log.ubx", sensor_request());
  CHECK(data.records == 612);
  CHECK(data.corrupt == 0);
  REQUIRE(data.readings.size() == 612);
  CHECK(std::is_sorted(data.readings.stamps.begin(), data.readings.stamps.end()));
  const double span = seconds_between(data.readings.stamps.front(), data.readings.stamps.back());
  CHECK(span == Approx(18.9).margin(0.3));  // 189 HNR-PVT of 10 Hz

  std::size_t column = 0;
  while (odometry_channels()[column].name != "acceleration_z") ++column;
  Stamp before{};
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t row = 0; row < data.readings.size(); ++row) {
    const double value = data.readings.at(row, column);
    if (std::isnan(value)) continue;
    // The inertial sensor's own tags are 90 or 91 ms apart.
    if (count > 0) CHECK(seconds_between(before, data.readings.stamps[row]) == Approx(0.0905).margin(0.0015));
    before = data.readings.stamps[row];
    sum += value;
    ++count;
  }
  CHECK(count == 211);
  CHECK(sum / static_cast<double>(count) == Approx(9.8).margin(0.3));  // it stands on its feet
}

TEST_CASE("ubx: real single messages of ESF-MEAS") {
  const auto logs = waymark_test::shared_data(kLogs);
  if (!logs) return;
  const std::string bytes = read_text_file(*logs + "/swiftnav_esf_meas.ubx");
  LogRequest request = sensor_request();
  request.gps_week = 2000;  // the log's only navigation message, NAV-STATUS, tells none
  const LogData data = UbxReader().read(bytes, "log.ubx", request);
  CHECK(data.readings.size() == 7);
  CHECK(data.readings.stamps.at(0).nanoseconds == (2000LL * 604'800'000 + 325'304'500) * 1'000'000);
  const auto value = [&](std::size_t row, const std::string& name) {
    std::size_t column = 0;
    while (odometry_channels()[column].name != name) ++column;
    return data.readings.at(row, column);
  };
  CHECK(value(0, "wheel_ticks") == 25'677);
  CHECK(value(2, "wheel_ticks_front_left") == 25'677);
  CHECK(value(6, "speed") == 25.677);
}

}  // namespace ubx_real_test

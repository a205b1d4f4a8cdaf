// How fast readers are: samples repeated in memory to 100 MB, real ones where there are. Of a build type that
// optimises: waymark_logs_tests "[.throughput]"
#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>

#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/paths.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

constexpr std::size_t kBytes = 100'000'000;
constexpr std::size_t kPiece = 1U << 20U;

/// The best of three runs, in MB/s.
double megabytes_per_second(const LogReader& reader, const std::string& text, const LogRequest& request) {
  double best = 0;
  for (int run = 0; run < 3; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const auto decoder = reader.open("log", request);
    for (std::size_t k = 0; k < text.size(); k += kPiece) {
      decoder->take(std::string_view(text).substr(k, kPiece));
      LogData& data = decoder->data();
      data.fixes.clear();
      data.readings.stamps.clear();
      data.readings.values.clear();
    }
    decoder->finish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    best = std::max(best, 1e-6 * static_cast<double>(text.size()) / seconds.count());
  }
  return best;
}

/// What stands between the first `from` and the last `to` of a sample, which are included, repeated; what
/// stands before and after it once.
std::string repeated(const std::string& once, const std::string& from, const std::string& to) {
  const std::size_t begin = from.empty() ? 0 : once.find(from);
  const std::size_t last = to.empty() ? std::string::npos : once.rfind(to);
  const std::size_t end = last == std::string::npos ? once.size() : last + to.size();
  std::string text = once.substr(0, begin);
  while (text.size() < kBytes) text.append(once, begin, end - begin);
  return text.append(once, end);
}

LogRequest fixes() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 10;
  return request;
}

LogRequest fixes_of_csv() {
  LogRequest request = fixes();
  request.columns = {{"time", {"t_unix_s", "", ""}},
                     {"latitude", {"lat_deg", "", ""}},
                     {"longitude", {"lon_deg", "", ""}},
                     {"accuracy", {"pos_acc_m", "", ""}}};
  return request;
}

LogRequest wheels_of_can() {
  LogRequest request;
  request.stream = StreamKind::sensor;
  for (const std::string wheel : {"FL", "FR", "RL", "RR"}) {
    request.readings.push_back({wheel, "m/s", "", false, ""});
    request.columns[wheel] = {"WHEEL_SPEED_" + wheel, "", ""};
  }
  const auto dbc = waymark_test::shared_data_dir() / "logs" / "can" / "toyota_rav4_2019.dbc";
  if (std::filesystem::exists(dbc)) request.companions["dbc"] = {"dbc", read_text_file(dbc.string())};
  return request;
}

LogRequest sensors_of_ubx() {
  LogRequest request;
  request.stream = StreamKind::odometry;
  request.readings = odometry_channels();
  return request;
}

}  // namespace

TEST_CASE("throughput of log readers", "[.throughput]") {
  struct Sample {
    const char* reader;
    const char* file;
    LogRequest request = fixes();
    const char* from = "";  ///< of what is repeated
    const char* to = "";
  };
  for (const Sample& sample :
       {Sample{"csv", "drives/aarhus_horsens/gnss.csv", fixes_of_csv(), "\n", ""},
        Sample{"gpsd_json", "logs/gpsd/gpsd_ublox-glo.log.chk"},
        Sample{"gpsd_json", "logs/gpsd/gpsd_telit-he910.log.chk"},
        Sample{"candump", "logs/can/rav4_2019_first_seconds.candump.log", wheels_of_can()},
        Sample{"nmea", "logs/nmea/genivi_munich_Petuelring_2009.nmea"},
        Sample{"nmea", "logs/nmea/gpsd_ublox-neo-m9n-nmea.log"},
        Sample{"rtklib_pos", "logs/pos/taroz_rover_1Hz_spp.pos"},
        Sample{"gpx", "logs/gpx/gpsbabel_datalog.gpx", fixes(), "<trkpt", "</trkpt>"},
        Sample{"ubx", "logs/ubx/gpsd_ublox-neo-m8l.log"},
        Sample{"ubx", "logs/ubx/gpsd_ublox-neo-m8l.log", sensors_of_ubx()}}) {
    const auto path = waymark_test::shared_data_dir() / sample.file;
    if (!std::filesystem::exists(path)) {
      std::cout << "SKIPPED: " << path.string() << " is absent\n";
      continue;
    }
    const std::string text = repeated(read_text_file(path.string()), sample.from, sample.to);
    std::cout << sample.reader << ' ' << sample.file << ": "
              << megabytes_per_second(*builtin_log_reader(sample.reader), text, sample.request) << " MB/s\n";
  }
}

TEST_CASE("throughput of log readers, by the specification: NovAtel's example, the first record of KITTI",
          "[.throughput]") {
  const std::string bestpos =
      "#BESTPOSA,COM1,0,47.0,FINESTEERING,1803,27504.000,00000000,6145,9603;SOL_COMPUTED,L1_FLOAT,"
      "32.81519645735,35.00791046612,19.9359,20.3000,WGS84,0.0363,0.0538,0.0956,\"0\",3.000,0.000,18,9,9,0,0,"
      "00,00,01*ecbd3409\r\n";
  std::cout << "novatel BESTPOSA: "
            << megabytes_per_second(*builtin_log_reader("novatel"), repeated(bestpos, "", ""), fixes())
            << " MB/s\n";
  const std::string record =
      "49.015003823272 8.4342971002335 116.43032836914 0.035752 0.00903 -2.6087069803847 -6.811441479104 "
      "-11.275641809511 13.172716663769 -0.12475264293164 -0.032919903047354 -0.44519814607457 "
      "0.042957369847256 10.209865300506 -0.34030092211055 -0.31686915378551 10.209117821189 "
      "0.0090951755733632 -0.023140741253985 -0.017909034508194 0.0089018002187228 -0.022495299354602 "
      "-0.018809330937153 0.027658633371879 0.012727922061358 4 11 6 6 6\n";
  const std::string records = repeated(record, "", "");
  LogRequest request = fixes();
  CompanionFile& stamps = request.companions["timestamps"];
  for (std::size_t i = 0; i < records.size(); i += record.size())
    stamps.text += "2011-09-26 13:02:25.964389445\n";
  std::cout << "kitti_oxts (its time stamps included): "
            << megabytes_per_second(*builtin_log_reader("kitti_oxts"), records, request) << " MB/s\n";
}

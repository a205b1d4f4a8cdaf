#include "logs.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <zlib.h>

#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/paths.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace waymark_bench {
namespace {

constexpr std::size_t kPiece = 1U << 20U;

/// A log that a reader is measured on: a real one below the shared data, or one record made by hand.
struct Sample {
  const char* reader;
  std::string file;  ///< empty: made
  std::string made;
  LogRequest request;
};

LogRequest gnss() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 10;
  return request;
}

std::vector<Sample> samples() {
  LogRequest odometry;
  odometry.stream = StreamKind::odometry;
  odometry.columns = {{"time", {"stamp_s", "", ""}},
                      {"speed", {"speed_mps", "", ""}},
                      {"yaw_rate", {"yaw_rate_radps", "", ""}}};
  LogRequest can;
  can.stream = StreamKind::sensor;
  can.time_scale = TimeScale::unix_time;
  can.readings = {{"yaw_rate", "rad/s", "ccw", false, ""}};
  can.columns["yaw_rate"] = {"YAW_RATE", "deg/s", ""};
  can.companions["dbc"] = {
      {"car.dbc", "BO_ 36 KINEMATICS: 8 X\n SG_ YAW_RATE : 1|10@0+ (0.244,-125) [0|250] \"deg/s\" X\n"}};
  const std::string oxts =
      "49.015003823272 8.4342971002335 116.43032836914 0.035752 0.00903 -2.6087069803847 -6.811441479104 "
      "-11.275641809511 13.172716663769 -0.12475264293164 -0.032919903047354 -0.44519814607457 "
      "0.042957369847256 10.209865300506 -0.34030092211055 -0.31686915378551 10.209117821189 "
      "0.0090951755733632 -0.023140741253985 -0.017909034508194 0.0089018002187228 -0.022495299354602 "
      "-0.018809330937153 0.027658633371879 0.012727922061358 4 11 6 6 6\n";
  const std::string bestpos =
      "#BESTPOSA,COM1,0,47.0,FINESTEERING,1803,27504.000,00000000,6145,9603;SOL_COMPUTED,L1_FLOAT,"
      "32.81519645735,35.00791046612,19.9359,20.3000,WGS84,0.0363,0.0538,0.0956,\"0\",3.000,0.000,18,9,9,0,0,"
      "00,"
      "00,01*ecbd3409\r\n";
  return {{"csv", "drives/nagoya/odometry_imitated_25hz.csv", "", odometry},
          {"gpsd_json", "logs/gpsd/gpsd_ublox-glo.log.chk", "", gnss()},
          {"candump", "logs/can/rav4_2019_first_seconds.candump.log", "", can},
          {"nmea", "logs/nmea/genivi_munich_Petuelring_2009.nmea", "", gnss()},
          {"rtklib_pos", "logs/pos/taroz_rover_1Hz_spp.pos", "", gnss()},
          {"kitti_oxts", "", oxts, gnss()},
          {"gpx", "logs/gpx/gpsbabel_datalog.gpx", "", gnss()},
          {"novatel", "", bestpos, gnss()},
          {"ubx", "logs/ubx/gpsd_ublox-glo.log", "", gnss()}};
}

/// The sample over and over. Of XML the points are repeated, not the document.
std::string repeated(const std::string& reader, const std::string& once, std::size_t size) {
  const std::size_t head = reader == "gpx" ? once.find("<trkpt") : 0;
  const std::size_t tail = reader == "gpx" ? once.rfind("</trkpt>") + 8 : once.size();
  std::string text = once.substr(0, head);
  while (text.size() < size) text += once.substr(head, tail - head);
  return text + once.substr(tail);
}

void set_rate(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void read_log(benchmark::State& state, const Sample& sample) {
  const std::string once = sample.file.empty()
                               ? sample.made
                               : read_text_file((waymark_test::shared_data_dir() / sample.file).string());
  const std::string text = repeated(sample.reader, once, static_cast<std::size_t>(state.range(0)) * 1024);
  LogRequest request = sample.request;
  if (sample.reader == std::string("kitti_oxts")) {
    std::string stamps;
    for (std::size_t size = 0; size < text.size(); size += once.size())
      stamps += "2011-09-26 13:02:25.964389445\n";
    request.companions["timestamps"] = {{"timestamps.txt", stamps}};
  }
  const LogReader& reader = *builtin_log_reader(sample.reader);
  std::size_t taken = 0;
  for (auto _ : state) {
    const auto decoder = reader.open("log", request);
    taken = 0;
    const auto take_out = [&] {
      LogData& data = decoder->data();
      taken += data.fixes.size() + data.odometry.size() + data.readings.size();
      data.fixes.clear();
      data.odometry.clear();
      data.readings.stamps.clear();
      data.readings.values.clear();
    };
    for (std::size_t k = 0; k < text.size(); k += kPiece) {
      decoder->take(std::string_view(text).substr(k, kPiece));
      take_out();
    }
    decoder->finish();
    take_out();
  }
  if (taken == 0) state.SkipWithError("not one sample");
  state.counters["samples"] = static_cast<double>(taken);
  set_rate(state, text.size());
}

void read_file(benchmark::State& state, bool compressed) {
  std::string text;
  while (text.size() < static_cast<std::size_t>(state.range(0)) * 1024)
    text += "553950.040,12.3456,-0.0123" + std::to_string(text.size() * 7919 % 10'007) + '\n';
  const std::string path = (waymark_test::scratch_dir() / (compressed ? "log.gz" : "log")).string();
  const gzFile file = ::gzopen(path.c_str(), compressed ? "wb" : "wbT");
  const int written = ::gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  if (::gzclose(file) != Z_OK || written != static_cast<int>(text.size()))
    return state.SkipWithError("the file cannot be written");
  std::size_t size = 0;
  for (auto _ : state) {
    size = 0;
    if (!read_in_pieces(path, [&](std::string_view piece) { size += piece.size(); }).empty())
      state.SkipWithError("damaged");
  }
  if (size != text.size()) state.SkipWithError("not all was read");
  set_rate(state, text.size());
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->Arg(2000)->Arg(16'000);
}

}  // namespace

void register_log_benchmarks() {
  for (const Sample& sample : samples()) {
    // Without the shared data there are the made ones.
    if (!sample.file.empty() && !std::filesystem::exists(waymark_test::shared_data_dir() / sample.file))
      continue;
    add(std::string("logs/") + sample.reader, [sample](benchmark::State& state) { read_log(state, sample); });
  }
  add("logs/read_in_pieces/plain", [](benchmark::State& state) { read_file(state, false); });
  add("logs/read_in_pieces/gz", [](benchmark::State& state) { read_file(state, true); });
}

}  // namespace waymark_bench

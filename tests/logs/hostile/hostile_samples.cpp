#include "logs/hostile/hostile_samples.hpp"

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/novatel/novatel_message.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/rinex/made_rinex.hpp"
#include "logs/ros/ros_bytes.hpp"
#include "logs/ubx/ubx_bytes.hpp"
#include "support/paths.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace waymark_test {
namespace {

constexpr std::size_t kLongest = 24'000;

/// The beginning of a real log, in whole lines; empty if the data are absent.
std::string real(const std::string& file) {
  const std::filesystem::path path = shared_data_dir() / file;
  if (!std::filesystem::exists(path)) return {};
  std::string text = read_text_file(path.string());
  if (text.size() > kLongest) text.resize(text.rfind('\n', kLongest) + 1);
  return text;
}

std::string novatel_log() {
  std::string text;
  for (int second = 0; second < 40; ++second) {
    const std::string message = fmt::format(
        "BESTPOSA,COM1,0,90.5,FINESTEERING,2062,{}.000,02000020,cdba,15564;SOL_COMPUTED,NARROW_INT,51.15,"
        "-114.0{},1097.2,-17.0,WGS84,0.0123,0.0114,0.0212,\"AAAA\",1.000,0.000,35,30,30,30,00,06,39,33",
        151'500 + second, 100 + second);
    text += fmt::format("#{}*{:08x}\r\n", message, novatel_checksum(message));
  }
  return text;
}

std::string kitti_log() {
  std::string text;
  for (int record = 0; record < 40; ++record)
    text += fmt::format(
        "49.01{} 8.43 112.8 0.03 0.02 1.5 -1.2 5.1 5.2 0.1 0.01 0.2 0.1 9.8 0.2 0.1 9.8 0.01 0.02 0.03 0.01 "
        "0.02 0.03 0.05 0.02 4 11 6 6 6\n",
        record);
  return text;
}

std::string kitti_stamps() {
  std::string text;
  for (int record = 0; record < 40; ++record)
    text += fmt::format("2011-09-26 13:02:{:02}.000000000\n", record);
  return text;
}

std::string ubx_log() {
  std::string text;
  for (int second = 0; second < 40; ++second) text += ubx_frame(0x0107, nav_pvt(second).bytes());
  return text;
}

/// The head of each of its messages is the same: opcode or header, and lengths.
std::string mcap_log() {
  std::string text = kMcapBegin + mcap_channel(1, "/fix", "sensor_msgs/msg/NavSatFix");
  for (unsigned second = 0; second < 40; ++second)
    text += mcap_message(1, nav_sat_fix(Wire::cdr_little, second));
  return text + mcap_end();
}

std::string bag_log() {
  std::string text = kBagBegin + bag_connection(0, "/fix", "sensor_msgs/NavSatFix");
  for (unsigned second = 0; second < 40; ++second) text += bag_message(0, nav_sat_fix(Wire::ros1, second));
  return text;
}

LogRequest gnss() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 5;
  request.date = Stamp{1'300'000'000LL / 86'400 * 86'400 * 1'000'000'000};
  return request;
}

std::vector<HostileSample> make() {
  std::vector<HostileSample> samples;
  HostileSample csv{"csv", real("drives/nagoya/gnss.csv"), gnss(), "55", "0123456789"};
  csv.request.columns = {{"time", {"gps_tow_s", "", ""}},
                         {"latitude", {"lat_deg", "", ""}},
                         {"longitude", {"lon_deg", "", ""}},
                         {"sigma_east", {"sde_m", "", ""}},
                         {"sigma_north", {"sdn_m", "", ""}}};
  samples.push_back(csv);
  samples.push_back(
      {"gpsd_json", real("logs/gpsd/gpsd_ublox-neo-m8l.log.chk"), gnss(), "{\"class\":\"TPV\"", "}"});
  HostileSample candump{"candump", real("logs/can/rav4_2019_first_seconds.candump.log"), {}, "(", "."};
  candump.request.stream = StreamKind::odometry;
  candump.request.time_scale = TimeScale::unix_time;
  candump.request.readings = {{"yaw_rate", "rad/s", "ccw", false, ""}};
  candump.request.columns["yaw_rate"] = {"KINEMATICS.YAW_RATE", "deg/s", ""};
  candump.request.companions["dbc"] = {
      {"car.dbc", "BO_ 36 KINEMATICS: 8 X\n SG_ YAW_RATE : 1|10@0+ (0.244,-125) [0|250] \"deg/s\" X\n"}};
  samples.push_back(candump);
  samples.push_back({"nmea", real("logs/nmea/gpsd_ublox-neo-m9n-nmea.log"), gnss(), "$GNRMC,", "0123456789"});
  samples.push_back({"rtklib_pos", real("logs/pos/taroz_rover_1Hz_spp.pos"), gnss(), "20", "/"});
  HostileSample kitti{"kitti_oxts", kitti_log(), gnss(), "49.", "0123456789"};
  kitti.request.companions["timestamps"] = {{"timestamps.txt", kitti_stamps()}};
  samples.push_back(kitti);
  std::string track = real("logs/gpx/gpsbabel_datalog.gpx");
  if (!track.empty()) track = track.substr(0, track.rfind("<trkpt")) + "</trkseg></trk></gpx>\n";
  samples.push_back({"gpx", track, gnss(), "<trkpt", "0123456789"});
  samples.push_back({"novatel", novatel_log(), gnss(), "#BESTPOSA", ";"});
  samples.push_back({"mcap", mcap_log(), gnss(),
                     mcap_message(1, nav_sat_fix(Wire::cdr_little, 0)).substr(0, 9), "", false});
  samples.push_back(
      {"rosbag", bag_log(), gnss(), bag_message(0, nav_sat_fix(Wire::ros1, 0)).substr(0, 12), "", false});
  HostileSample rinex{"rinex", made_rinex_observations(40), {}, "> 2016", "0123456789"};
  rinex.request.stream = StreamKind::sensor;
  rinex.request.readings = {{"pseudorange", "m", "", true, ""}, {"elevation", "rad", "", true, ""}};
  rinex.request.companions["navigation"] = {{"brdc.nav", made_rinex_navigation()}};
  samples.push_back(rinex);
  samples.push_back({"ubx", ubx_log(), gnss(), "\xB5\x62\x01\x07", "", false});
  std::erase_if(samples, [](const HostileSample& sample) { return sample.text.empty(); });
  return samples;
}

}  // namespace

const LogReader& HostileSample::log_reader() const {
  return *builtin_log_reader(reader);
}

LogData HostileSample::read(std::string_view given, std::size_t piece) const {
  const auto decoder = log_reader().open("run.log", request);
  if (piece == 0) piece = given.size() + 1;
  try {
    for (; !given.empty(); given.remove_prefix(std::min(piece, given.size())))
      decoder->take(given.substr(0, piece));
    decoder->finish();
  } catch (const InputError&) {
    return {};
  }
  return std::move(decoder->data());
}

const std::vector<HostileSample>& hostile_samples() {
  static const std::vector<HostileSample> samples = make();
  return samples;
}

}  // namespace waymark_test

#include <waymark/formats/logs/log_readers.hpp>

#include <vector>

#include <waymark/formats/logs/detail/can/can_log.hpp>
#include <waymark/formats/logs/detail/csv/csv_log.hpp>
#include <waymark/formats/logs/detail/gpsd/gpsd_json.hpp>
#include <waymark/formats/logs/detail/gpx/gpx.hpp>
#include <waymark/formats/logs/detail/kitti/kitti_oxts.hpp>
#include <waymark/formats/logs/detail/nmea/nmea.hpp>
#include <waymark/formats/logs/detail/novatel/novatel.hpp>
#include <waymark/formats/logs/detail/rinex/rinex.hpp>
#include <waymark/formats/logs/detail/ros/bag.hpp>
#include <waymark/formats/logs/detail/ros/mcap.hpp>
#include <waymark/formats/logs/detail/rtklib/rtklib_pos.hpp>
#include <waymark/formats/logs/detail/tables/gnss_logger.hpp>
#include <waymark/formats/logs/detail/tables/vbo.hpp>
#include <waymark/formats/logs/detail/ubx/ubx.hpp>

namespace waymark::formats {

std::span<const LogReaderType> builtin_log_readers() {
  static const CsvLogReader csv;
  static const GpsdJsonReader gpsd_json;
  static const CanLogReader candump("candump");
  static const CanLogReader asc("asc");
  static const CanLogReader trc("trc");
  static const NmeaReader nmea;
  static const RtklibPosReader rtklib_pos;
  static const KittiOxtsReader kitti_oxts;
  static const GpxReader gpx;
  static const NovatelReader novatel;
  static const UbxReader ubx;
  static const GnssLoggerReader gnss_logger;
  static const VboReader vbo;
  static const McapReader mcap;
  static const BagReader rosbag;
  static const RinexReader rinex;
  static const std::vector<LogReaderType> readers{
      {"csv", "separated values with a column map: odometry, gnss, truth", &csv, true},
      {"gpsd_json", "gpsd's JSON reports (TPV): gnss, truth", &gpsd_json},
      {"candump", "CAN frames (candump) with a DBC: odometry, gnss, truth, sensors", &candump},
      {"asc", "CAN frames (Vector ASC), as candump", &asc},
      {"trc", "CAN frames (PEAK TRC), as candump", &trc},
      {"nmea", "NMEA 0183 sentences (RMC, GGA, GNS, GST, VTG, ZDA, GLL): gnss, truth", &nmea},
      {"rtklib_pos", "solutions of RTKLIB (.pos): gnss, truth", &rtklib_pos},
      {"kitti_oxts", "KITTI's oxts records with their time stamps: odometry, gnss, truth", &kitti_oxts},
      {"gpx", "tracks of GPX 1.0 and 1.1: gnss, truth", &gpx},
      {"novatel", "ASCII messages of NovAtel receivers (BESTPOSA, INSPVAXA): gnss, truth", &novatel},
      {"ubx", "u-blox binary messages: gnss, truth, odometry and sensor channels (ESF-MEAS)", &ubx},
      {"gnss_logger", "text logs of Android's GnssLogger: gnss, truth", &gnss_logger},
      {"vbo", "Racelogic's VBO files: gnss, truth", &vbo},
      {"mcap", "ROS messages in MCAP (CDR, JSON): odometry, gnss, truth, sensor channels", &mcap, true},
      {"rosbag", "ROS 1 bags of version 2.0, as mcap", &rosbag, true},
      {"rinex", "RINEX 2 and 3 observations with their navigation files: sensor gnss_raw", &rinex},
  };
  return readers;
}

void register_log_readers(TypeRegistry& registry) {
  for (const LogReaderType& reader : builtin_log_readers()) registry.add_log_reader(reader);
}

const LogReader* builtin_log_reader(std::string_view name) {
  for (const LogReaderType& entry : builtin_log_readers()) {
    if (entry.name == name) return entry.reader;
  }
  return nullptr;
}

}  // namespace waymark::formats

#include "targets.hpp"

#include <array>

namespace waymark_fuzz {

std::span<const Target> targets() {
  static constexpr std::array kTargets = {Target{"csv", fuzz_log_reader},
                                          Target{"gpsd_json", fuzz_log_reader},
                                          Target{"candump", fuzz_log_reader},
                                          Target{"asc", fuzz_log_reader},
                                          Target{"trc", fuzz_log_reader},
                                          Target{"nmea", fuzz_log_reader},
                                          Target{"rtklib_pos", fuzz_log_reader},
                                          Target{"kitti_oxts", fuzz_log_reader},
                                          Target{"gpx", fuzz_log_reader},
                                          Target{"novatel", fuzz_log_reader},
                                          Target{"ubx", fuzz_log_reader},
                                          Target{"gnss_logger", fuzz_log_reader},
                                          Target{"vbo", fuzz_log_reader},
                                          Target{"mcap", fuzz_log_reader},
                                          Target{"rosbag", fuzz_log_reader},
                                          Target{"rinex", fuzz_log_reader},
                                          Target{"dbc", fuzz_dbc},
                                          Target{"log_file", fuzz_log_file},
                                          Target{"graph", fuzz_graph},
                                          Target{"g2o", fuzz_graph},
                                          Target{"toro", fuzz_graph},
                                          Target{"covariance", fuzz_graph},
                                          Target{"drive_yaml", fuzz_drive_yaml},
                                          Target{"metrics_json", fuzz_results},
                                          Target{"summary_json", fuzz_results},
                                          Target{"options", fuzz_options},
                                          Target{"module", fuzz_module},
                                          Target{"tum", fuzz_tum},
                                          Target{"geojson_map", fuzz_geojson_map}};
  return kTargets;
}

}  // namespace waymark_fuzz

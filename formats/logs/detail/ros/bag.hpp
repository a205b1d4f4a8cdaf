/// Bags of ROS 1 (wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "rosbag": messages of a bag of version 2.0, without anything of ROS (RosLogDecoder).
///
/// The records are read in their order, so a bag needs no index: one that was not closed (`.active`) is read too,
/// up to its end. Chunks may be compressed with bz2 and, if this build has it, LZ4.
class BagReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

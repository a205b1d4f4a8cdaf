/// MCAP files (mcap.dev/spec, version 0), as ROS 2 and Foxglove record them.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "mcap": messages in ROS 2's CDR, ROS 1's form and JSON (RosLogDecoder).
///
/// The records are read in their order, so a file needs no index and no end. Chunks may be compressed with
/// Zstandard and, if this build has it, LZ4. The CRC of a chunk and of the data section are checked: a chunk with
/// a wrong one is left out as a corrupt record. A file that is cut is read up to the cut. Records of other kinds
/// and messages on other topics are passed over without being kept, whatever their length.
class McapReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats

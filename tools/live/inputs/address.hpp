/// Where live bytes come from or go to: "gpsd://localhost:2947/dev/ttyACM0", "tcp://host:port",
/// "udp://:port", "serial:///dev/ttyACM0?baud=38400", "can://can0", "-", or a file.
#pragma once

#include <map>
#include <string>

namespace waymark::live {

struct Address {
  enum class Kind { file, standard, tcp, udp, gpsd, serial, can };
  Kind kind = Kind::file;
  std::string text;  ///< as it was written
  std::string host;  ///< empty: any
  std::string port;
  std::string path;                            ///< file, device; interface of CAN
  std::map<std::string, std::string> options;  ///< after '?': "baud=38400&rate=10"
};

/// @throws UsageError for an unknown scheme, a missing port, or an option that the kind does not have
[[nodiscard]] Address parse_address(const std::string& text);

}  // namespace waymark::live

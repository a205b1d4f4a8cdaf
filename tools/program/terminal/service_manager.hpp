/// Tells systemd how the service is: READY, WATCHDOG, STOPPING (sd_notify(3)). Without it nothing happens.
#pragma once

#include <string>

namespace waymark::program {

class ServiceManager {
 public:
  ServiceManager();
  void ready() const { notify("READY=1"); }
  /// Call it more often than the unit's WatchdogSec.
  void alive() const { notify("WATCHDOG=1"); }
  void stopping() const { notify("STOPPING=1"); }

 private:
  void notify(const std::string& text) const;
  std::string socket_;
};

}  // namespace waymark::program

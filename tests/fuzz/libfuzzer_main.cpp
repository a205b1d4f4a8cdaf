// One target (WAYMARK_FUZZ_TARGET) as libFuzzer calls it.
#include <algorithm>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const waymark_fuzz::Target& target =
      *std::find_if(waymark_fuzz::targets().begin(), waymark_fuzz::targets().end(),
                    [](const waymark_fuzz::Target& one) { return one.name == WAYMARK_FUZZ_TARGET; });
  target.run(target.name, bytes, size);
  return 0;
}

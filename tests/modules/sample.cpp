// A plugin in many variants, each wrong in one way (tests/CMakeLists.txt): compiled with other flags, linked
// with -Ofast, a tag that is taken, a registration that throws or crashes, a solver that fails, no descriptor. A sound
// one tells, by a file, when any of its code runs.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <waymark/core/registry/plugin.hpp>

#include "sample_types.hpp"

namespace {

/// Runs when the module is loaded, before anything of it is called.
[[maybe_unused]] const bool told = [] {
  if (const char* file = std::getenv("WAYMARK_TEST_MODULE_RAN")) {
    if (std::FILE* opened = std::fopen(file, "a")) std::fclose(opened);
  }
  return true;
}();

[[maybe_unused]] void register_types(waymark::TypeRegistry& registry) {
  using namespace waymark_test::modules;
#if defined(SAMPLE_DUPLICATE)
  add_taken_edge(registry);
#elif defined(SAMPLE_WRONG_JACOBIAN)
  add_edge_with_wrong_jacobian(registry);
#elif defined(SAMPLE_FALSELY_RELATIVE)
  add_falsely_relative_edge(registry);
#else
  add_sound_edge(registry);
#endif
#if defined(SAMPLE_BROKEN_SOLVER)
  add_refusing_solver(registry);
#elif defined(SAMPLE_LOCATED)
  add_located_sensor(registry);
#elif defined(SAMPLE_THROWS)
  throw std::runtime_error("the sensor is not plugged in");
#elif defined(SAMPLE_CRASHES)
  std::abort();
#elif defined(SAMPLE_THROWS_NUMBER)
  throw 42;
#endif
}

}  // namespace

#if defined(SAMPLE_OTHER_ABI)
extern "C" __attribute__((visibility("default"))) const std::uint32_t waymark_plugin[2];
const std::uint32_t waymark_plugin[2] = {waymark::kPluginMagic, waymark::kPluginAbi - 1};
#elif !defined(SAMPLE_NO_DESCRIPTOR)
WAYMARK_PLUGIN(sample, "1.2.3", register_types);
#endif

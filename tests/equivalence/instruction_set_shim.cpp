// Preloaded into a program (LD_PRELOAD), it answers in the place of the library which vector instructions the
// processor has: none beyond SSE2 if WAYMARK_TEST_INSTRUCTIONS is sse2, and no AVX-512 if it is avx2.
#include <cstdlib>
#include <cstring>

#include <waymark/core/base/detail/processor.hpp>

#if defined(__x86_64__)

namespace {

bool limited_to(const char* instructions) {
  static const char* const limit = std::getenv("WAYMARK_TEST_INSTRUCTIONS");
  return limit != nullptr && std::strcmp(limit, instructions) == 0;
}

}  // namespace

namespace waymark {

bool has_fused_multiply() {
  return !limited_to("sse2") && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

bool has_wide_vectors() {
  return has_fused_multiply() && !limited_to("avx2") && __builtin_cpu_supports("avx512f") &&
         __builtin_cpu_supports("avx512vl");
}

}  // namespace waymark

#endif

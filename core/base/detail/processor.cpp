#include <waymark/core/base/detail/processor.hpp>

namespace waymark {

#if defined(__x86_64__)

bool has_fused_multiply() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}

bool has_wide_vectors() {
  static const bool has =
      has_fused_multiply() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl");
  return has;
}

#else

bool has_fused_multiply() {
  return false;
}
bool has_wide_vectors() {
  return false;
}

#endif

}  // namespace waymark

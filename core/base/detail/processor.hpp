/// Features of this processor beyond the baseline of the build.
#pragma once

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Tells whether it has AVX2 and fused multiply-add.
[[nodiscard]] bool has_fused_multiply();
/// Tells whether it has AVX-512 foundation and vector length.
[[nodiscard]] bool has_wide_vectors();

}  // namespace waymark

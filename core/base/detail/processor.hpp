/// What the processor at hand can do beyond the baseline that everything is compiled for.
#pragma once

namespace waymark {

/// AVX2 and fused multiply-add.
[[nodiscard]] bool has_fused_multiply();
/// AVX-512, foundation and vector length.
[[nodiscard]] bool has_wide_vectors();

}  // namespace waymark

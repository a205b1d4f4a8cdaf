/// Benchmarks of the live estimator.
#pragma once

namespace waymark_bench {

/// live/WHAT/POSES in the window.
void register_live_benchmarks();

}  // namespace waymark_bench

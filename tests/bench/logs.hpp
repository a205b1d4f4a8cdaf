/// Benchmarks of the log readers: bytes per second.
#pragma once

namespace waymark_bench {

/// Registers `logs/READER/KIB` for every reader with an available sample, and
/// `logs/read_in_pieces/plain|gz/KIB`.
void register_log_benchmarks();

}  // namespace waymark_bench

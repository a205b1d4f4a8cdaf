/// Counts the memory requests of the process. counting_allocator.cpp replaces malloc and
/// its relatives.
#pragma once

#include <atomic>

namespace waymark_test {

/// Returns the requests so far, from any library: malloc, calloc, realloc and the aligned ones.
[[nodiscard]] long memory_requests();

}  // namespace waymark_test

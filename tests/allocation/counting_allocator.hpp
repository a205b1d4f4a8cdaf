/// Counts the process's requests for memory (counting_allocator.cpp takes the place of malloc and its kin).
#pragma once

#include <atomic>

namespace waymark_test {

/// Requests so far: malloc, calloc, realloc and the aligned ones, from whatever library.
[[nodiscard]] long memory_requests();

}  // namespace waymark_test

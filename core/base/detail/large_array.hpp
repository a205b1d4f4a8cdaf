/// A growing array for the largest data of an optimisation. It uses huge pages if the system
/// gives them on request, because touching fresh memory 4 KB at a time costs more than
/// factorising a chain.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

template <typename T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (count > (std::numeric_limits<std::ptrdiff_t>::max() - kHugePage) / sizeof(T)) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kHugePage / 2) {
      if (void* memory = std::malloc(bytes)) return static_cast<T*>(memory);
      throw std::bad_alloc();
    }
    const std::size_t whole = (bytes + kHugePage - 1) / kHugePage * kHugePage;
    void* memory = std::aligned_alloc(kHugePage, whole);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    // This is only advice. It leaves out the rest after the last whole page, because the system
    // would clear that for nothing.
    (void)madvise(memory, std::max(bytes / kHugePage, std::size_t{1}) * kHugePage, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) {
    std::free(memory);
  }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) {
    return true;
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;
};

template <typename T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

}  // namespace waymark

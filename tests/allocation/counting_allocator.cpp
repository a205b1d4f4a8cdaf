// Every request for memory of the whole process, libraries in C included, passes here on its way to glibc:
// operator new, and malloc for large arrays and in CHOLMOD, have one count.
#include <cerrno>
#include <cstddef>

#include "allocation/counting_allocator.hpp"

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

std::atomic<long> requests = 0;

}  // namespace

namespace waymark_test {

long memory_requests() {
  return requests.load(std::memory_order_relaxed);
}

}  // namespace waymark_test

extern "C" {

void* malloc(std::size_t size) {
  ++requests;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  ++requests;
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  ++requests;
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  ++requests;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}

int posix_memalign(void** place, std::size_t alignment, std::size_t size) {
  *place = memalign(alignment, size);
  return *place == nullptr ? ENOMEM : 0;
}

}  // extern "C"

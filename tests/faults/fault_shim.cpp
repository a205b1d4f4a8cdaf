// Preloaded into a program (LD_PRELOAD), it fails the n-th call of one function of the system, and every
// later one with FAULT_LASTS. FAULT_CALL names the function, FAULT_NUMBER is n (from 1; 0: none), FAULT_SEEN
// a file to which the number of calls is written at the end. Only what the program does with files is
// counted: calls that create, write or rename, and the reading of files that are no libraries.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};

/// The environment as it was at the start; reading it may not allocate.
struct Fault {
  const char* call = std::getenv("FAULT_CALL");
  const char* seen = std::getenv("FAULT_SEEN");
  long number = std::getenv("FAULT_NUMBER") == nullptr ? 0 : std::atol(std::getenv("FAULT_NUMBER"));
  bool lasts = std::getenv("FAULT_LASTS") != nullptr;
};

Fault& fault() {
  static Fault instance;
  return instance;
}

/// Counts a call, and tells whether it must fail.
bool fails(const char* call) {
  const Fault& f = fault();
  if (f.call == nullptr || std::strcmp(f.call, call) != 0) return false;
  const long number = ++calls;
  return f.number > 0 && (number == f.number || (f.lasts && number > f.number));
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// Whether opening is of interest: the system's own files are always there.
bool counts(const char* path) {
  for (const char* own : {"/lib", "/usr", "/etc", "/proc", "/sys", "/dev"})
    if (std::strncmp(path, own, std::strlen(own)) == 0) return false;
  return true;
}

int open_or_fail(const char* name, const char* path, int flags, mode_t mode) {
  if (counts(path) && fails("open")) {
    errno = EMFILE;
    return -1;
  }
  return next<int(const char*, int, ...)>(name)(path, flags, mode);
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (fails("write")) {
    errno = ENOSPC;
    return -1;
  }
  return next<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, size);
}

ssize_t read(int descriptor, void* bytes, size_t size) {
  if (fails("read")) {
    errno = EIO;
    return -1;
  }
  return next<ssize_t(int, void*, size_t)>("read")(descriptor, bytes, size);
}

int close(int descriptor) {
  const int result = next<int(int)>("close")(descriptor);
  if (!fails("close")) return result;
  errno = EIO;
  return -1;
}

int rename(const char* from, const char* to) noexcept {
  if (fails("rename")) {
    errno = EACCES;
    return -1;
  }
  return next<int(const char*, const char*)>("rename")(from, to);
}

int fsync(int descriptor) {
  if (fails("fsync")) {
    errno = EIO;
    return -1;
  }
  return next<int(int)>("fsync")(descriptor);
}

void* mmap(void* address, size_t size, int protection, int flags, int descriptor, off_t offset) noexcept {
  if (fails("mmap")) {
    errno = ENOMEM;
    return MAP_FAILED;
  }
  return next<void*(void*, size_t, int, int, int, off_t)>("mmap")(address, size, protection, flags,
                                                                  descriptor, offset);
}

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = static_cast<mode_t>((flags & O_CREAT) != 0 ? va_arg(arguments, unsigned) : 0U);
  va_end(arguments);
  return open_or_fail("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = static_cast<mode_t>((flags & O_CREAT) != 0 ? va_arg(arguments, unsigned) : 0U);
  va_end(arguments);
  return open_or_fail("open64", path, flags, mode);
}

/// glibc's own name of malloc: dlsym() itself allocates.
void* __libc_malloc(size_t size);
void* malloc(size_t size) {
  return fails("malloc") ? nullptr : __libc_malloc(size);
}

}  // extern "C"

namespace {

struct Report {
  ~Report() {
    const Fault f = fault();
    if (f.seen == nullptr) return;
    fault().call = nullptr;
    if (std::FILE* file = std::fopen(f.seen, "w")) {
      std::fprintf(file, "%ld\n", calls.load());
      std::fclose(file);
    }
  }
} report;

}  // namespace

#include <waymark/formats/text/folder_lock.hpp>

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>

namespace waymark::formats {

FolderLock::FolderLock(const std::string& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw OutputError(folder + ": cannot open the folder: " + std::generic_category().message(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw OutputError(folder +
                    ": another program of Waymark writes into this folder now; wait until it has "
                    "ended, or name another folder");
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

}  // namespace waymark::formats

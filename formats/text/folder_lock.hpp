/// Keeps two programs from writing into one folder at the same time.
#pragma once

#include <string>

namespace waymark::formats {

/// Holds a folder until it is destroyed. The lock is on the open folder itself (flock), so nothing is written
/// and nothing is left behind, whatever ends the program. A file system without locks is not locked.
class FolderLock {
 public:
  /// @param folder must exist
  /// @throws OutputError if another program holds the folder, or it cannot be opened
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace waymark::formats

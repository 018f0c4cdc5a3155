// A folder for one commissioning at a time.
#pragma once

#include <string>

namespace host {

/// Held until it dies; the system lets it go when the process ends, however it ends. Where the folder's file system
/// knows no locks there is none.
class FolderLock {
 public:
  /// Makes the folder where it is not there. Throws Failure: permission, refused (another process holds it).
  explicit FolderLock(const std::string& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_ = -1;
};

}  // namespace host

// Locks a folder, so that only one commissioning uses it at a time.
#pragma once

#include <string>

namespace host {

/// Held for its lifetime; the system releases it when the process ends. Without effect if the file system has no locks.
class FolderLock {
 public:
  /// Makes the folder if it is missing. Throws Failure: permission, refused (another process holds it).
  explicit FolderLock(const std::string& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_ = -1;
};

}  // namespace host

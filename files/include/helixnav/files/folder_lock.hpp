// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace helixnav::files {

/// Reserves a folder for one process as long as this object lives: two writing the same run or campaign would mix their
/// tables. InputError if another process holds it. If the file system has no locks, or the path is not a folder, nobody
/// else is assumed to be there. Test: runs/run_writer_test.cpp.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace helixnav::files

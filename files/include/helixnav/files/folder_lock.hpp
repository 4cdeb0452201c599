// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace helixnav::files {

/// Keeps a folder to one process as long as it lives: two that wrote the same run or campaign would mix their tables.
/// InputError where another has it. A file system that knows no locks, and a folder that is none, are taken at their word
/// that nobody else is there. Test: runs/run_writer_test.cpp.
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

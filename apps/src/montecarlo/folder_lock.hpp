// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace helixnav::apps {

/// Keeps a folder to one process as long as it lives: two that wrote the same campaign would lose each other's runs.
/// InputError where another process has it. A file system that knows no locks is taken at its word that nobody else is there.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace helixnav::apps

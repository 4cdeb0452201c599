// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace helixnav::files {

/// A file that grows. What was passed to `append` has been handed to the operating system when it returns, so that it
/// survives the death of the process (not of the machine). InputError when the system refuses, or if `path` is a
/// symbolic link.
class AppendFile {
 public:
  explicit AppendFile(const std::string& path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  void append(std::string_view bytes);

 private:
  std::string path_;
  int descriptor_ = -1;
};

/// Writes `bytes` under a temporary name and renames: the file appears whole or not at all, and a symbolic link of that
/// name is replaced, not followed. On InputError the temporary file is removed. Test: runs/run_writer_test.cpp.
void write_whole_file(const std::string& path, std::string_view bytes);
/// The same for a file that is written piece by piece.
void write_whole_file(const std::string& path, const std::function<void(AppendFile&)>& write);

/// InputError with the reason if write_whole_file could not write a small file of this name now; leaves nothing behind.
/// Test: apps/hostile/lost_output_test.cpp.
void check_writable(const std::string& path);

/// The file's bytes. InputError when it cannot be read, is a folder, or has more than `most_bytes`; from anything
/// without a size, such as a device or a pipe, at most 64 MiB are read. Test: apps/hostile/hostile_run_test.cpp.
std::string read_whole_file(const std::string& path, std::size_t most_bytes = std::size_t{4} << 30);

}  // namespace helixnav::files

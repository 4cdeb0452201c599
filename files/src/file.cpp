// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/files/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "helixnav/core/errors.hpp"

namespace helixnav::files {

namespace {

[[noreturn]] void refuse(const std::string& path, const char* verb) {
  throw core::InputError(path + ": cannot " + verb + ": " + std::strerror(errno));
}

/// Anything without a size, such as a device or a pipe, may never end.
constexpr std::size_t most_device_bytes = 64u << 20;

/// A file open for reading.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) refuse(path_, "read");
    if (::fstat(descriptor_, &status_) == 0 && !S_ISDIR(status_.st_mode)) return;
    ::close(descriptor_);
    throw core::InputError(path_ + ": expected a file, found a folder");
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool is_regular() const { return S_ISREG(status_.st_mode); }

  /// Appends the next bytes and returns how many there were; 0 at the end.
  std::size_t read_into(std::string& bytes) const {
    constexpr std::size_t block_bytes = 1u << 18;
    const std::size_t before = bytes.size();
    bytes.resize(before + block_bytes);
    ssize_t got = 0;
    do {
      got = ::read(descriptor_, bytes.data() + before, bytes.size() - before);
    } while (got < 0 && errno == EINTR);
    if (got < 0) refuse(path_, "read");
    bytes.resize(before + static_cast<std::size_t>(got));
    return static_cast<std::size_t>(got);
  }

 private:
  std::string path_;
  int descriptor_ = -1;
  struct stat status_ {};
};

}  // namespace

AppendFile::AppendFile(const std::string& path)
    : path_(path),
      descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644)) {
  if (descriptor_ < 0) refuse(path_, "create");
}

AppendFile::~AppendFile() { ::close(descriptor_); }

void AppendFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse(path_, "write");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void write_whole_file(const std::string& path, std::string_view bytes) {
  write_whole_file(path, [bytes](AppendFile& file) { file.append(bytes); });
}

void write_whole_file(const std::string& path, const std::function<void(AppendFile&)>& write) {
  const std::string temporary = path + ".part";
  ::unlink(temporary.c_str());  // left by a killed process, or a link planted to be written through
  try {
    {
      AppendFile file(temporary);
      write(file);
    }
    if (std::rename(temporary.c_str(), path.c_str()) != 0) refuse(path, "write");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void check_writable(const std::string& path) {
  constexpr std::size_t small_file = 4096;
  const std::string temporary = path + ".part";
  ::unlink(temporary.c_str());
  try {
    AppendFile(temporary).append(std::string(small_file, ' '));
  } catch (const core::InputError&) {
    const int why = errno;
    ::unlink(temporary.c_str());
    errno = why;
    refuse(path, "write");
  }
  ::unlink(temporary.c_str());
}

std::string read_whole_file(const std::string& path, std::size_t most_bytes) {
  const OpenFile file(path);
  const std::size_t most = std::min(most_bytes, file.is_regular() ? most_bytes : most_device_bytes);
  std::string bytes;
  for (std::size_t got = file.read_into(bytes); got > 0; got = file.read_into(bytes)) {
    if (bytes.size() <= most) continue;
    throw core::InputError(path + ": expected a file of at most " + std::to_string(most) + " bytes, found more");
  }
  return bytes;
}

}  // namespace helixnav::files

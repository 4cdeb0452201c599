// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/files/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include "helixnav/core/errors.hpp"

namespace helixnav::files {

namespace {

[[noreturn]] void refuse(const std::string& path, const char* verb) {
  throw core::InputError(path + ": cannot " + verb + ": " + std::strerror(errno));
}

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
  const std::string temporary = path + ".part";
  ::unlink(temporary.c_str());  // left by a process that was killed, or a link planted to be written through
  try {
    AppendFile(temporary).append(bytes);
    if (std::rename(temporary.c_str(), path.c_str()) != 0) refuse(path, "write");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

std::string read_whole_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "read");
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) refuse(path, "read");
  return bytes;
}

}  // namespace helixnav::files

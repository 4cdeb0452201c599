// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/recording.hpp"
#include "temporary_folder.hpp"

namespace helixnav::fuzz {

/// Aborts the process with a message, like a libFuzzer finding.
[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "invariant broken: %s\n", what.c_str());
  std::abort();
}

inline void require(bool condition, const char* what) {
  if (!condition) fail(what);
}

/// The input as a file that exists in memory only.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(::memfd_create("input", MFD_CLOEXEC)) {
    for (std::size_t at = 0; at < size;) {
      const ssize_t written = ::write(descriptor_, data + at, size - at);
      if (written <= 0) fail("the input cannot be written");
      at += static_cast<std::size_t>(written);
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// What a reader may do: read, or refuse with InputError. Any other exception is a finding.
template <class Read>
void read_or_refuse(Read&& read) {
  try {
    read();
  } catch (const core::InputError& error) {
    require(std::string_view(error.what()).size() < 2000, "a message longer than anybody reads");
  }
}

/// What a reader accepts, an estimator accepts: valid events in time order, with one label per observation.
inline void check_recording(const core::Recording& recording) {
  std::size_t scans = 0;
  core::Nanoseconds last_ns = std::numeric_limits<core::Nanoseconds>::min();
  for (const core::Event& event : recording.events) {
    try {
      core::check(event);
      core::check_order(last_ns, core::time_of(event));
    } catch (const core::PreconditionError& error) {
      fail(std::string("a reader let pass: ") + error.what());
    }
    last_ns = core::time_of(event);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    if (!recording.labels.empty()) {
      require(scans < recording.labels.size(), "a scan without labels");
      require(recording.labels[scans].size() == scan->observations.size(), "an observation without a label");
    }
    ++scans;
  }
  require(recording.labels.empty() || recording.labels.size() == scans, "labels without a scan");
}

/// Files of a folder as one text: a line "=== name" before each.
inline std::map<std::string, std::string> files_of(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::map<std::string, std::string> files;
  std::string name;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end == std::string_view::npos ? end : end + 1);
    if (line.substr(0, 4) == "=== ") {
      name = std::string(line.substr(4, line.find_last_not_of("\r\n") - 3));
    } else if (!name.empty()) {
      files[name] += line;
    }
    rest.remove_prefix(line.size());
  }
  return files;
}

/// Writes such files into a folder, except names that no log has: with paths, hidden, or overlong.
template <class Content>
void write_files(const std::uint8_t* data, std::size_t size, const testing::TemporaryFolder& folder,
                 Content&& content) {
  for (const auto& [name, text] : files_of(data, size)) {
    if (name.empty() || name.find('/') != std::string::npos || name[0] == '.' || name.size() > 40) continue;
    if (name.find('\0') != std::string::npos) continue;
    folder.write(name, content(name, text));
  }
}

/// A folder of this process, in memory if the system offers that; so are all temporary folders made after the call.
inline const std::filesystem::path& folder() {
  static const bool in_memory = std::filesystem::exists("/dev/shm") && ::setenv("TMPDIR", "/dev/shm", 1) == 0;
  static const testing::TemporaryFolder own;
  static_cast<void>(in_memory);
  return own.path();
}

}  // namespace helixnav::fuzz

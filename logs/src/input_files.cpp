// SPDX-License-Identifier: BSD-3-Clause
#include "input_files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include <archive.h>
#include <archive_entry.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::logs {
namespace {

struct CloseArchive {
  void operator()(archive* reader) const { archive_read_free(reader); }
};
using ArchiveReader = std::unique_ptr<archive, CloseArchive>;

ArchiveReader open_archive(const std::filesystem::path& path) {
  ArchiveReader reader(archive_read_new());
  archive_read_support_filter_all(reader.get());
  archive_read_support_format_zip(reader.get());
  archive_read_support_format_tar(reader.get());
  constexpr std::size_t block_bytes = 1 << 16;
  if (archive_read_open_filename(reader.get(), path.c_str(), block_bytes) != ARCHIVE_OK) {
    return nullptr;
  }
  return reader;
}

[[noreturn]] void fail(const std::filesystem::path& path, archive* reader) {
  const char* why = reader != nullptr ? archive_error_string(reader) : nullptr;
  throw core::InputError(path.string() + ": expected a zip or tar archive that can be read to its end" +
                         (why != nullptr ? std::string(", found: ") + why : std::string()));
}

std::string name_of(archive_entry* entry) {
  const char* path = archive_entry_pathname(entry);
  return path == nullptr ? std::string() : std::filesystem::path(path).filename().string();
}

/// A few megabytes of zip may hold terabytes of the same byte. The longest known log has 60 MB.
constexpr std::size_t most_text_bytes = 512u << 20;

std::string content(const std::filesystem::path& path, archive* reader, archive_entry* entry) {
  std::string text;
  if (archive_entry_size_is_set(entry) != 0) {
    constexpr std::int64_t reserved_at_most_bytes = 64 << 20;  // a false size must not allocate the memory
    text.reserve(
        static_cast<std::size_t>(std::clamp<std::int64_t>(archive_entry_size(entry), 0, reserved_at_most_bytes)));
  }
  std::string block(1 << 18, '\0');
  for (;;) {
    const la_ssize_t got = archive_read_data(reader, block.data(), block.size());
    if (got < 0) {
      fail(path, reader);
    }
    if (got == 0) {
      return text;
    }
    if (text.size() + static_cast<std::size_t>(got) > most_text_bytes) {
      throw core::InputError(path.string() + ": expected at most 512 MiB in " + name_of(entry) + ", found more");
    }
    text.append(block.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw core::InputError(path.string() + ": expected a file that can be read, found: " +
                           (std::filesystem::is_directory(path) ? "a folder" : std::strerror(errno)));
  }
  std::string text;
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  file.seekg(0, std::ios::beg);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return text;
}

TextByName read_archive(const std::filesystem::path& path, const std::vector<std::string>& names) {
  read_file(path).clear();  // reports a missing or unreadable file in the same words as everywhere
  const ArchiveReader reader = open_archive(path);
  if (reader == nullptr) {
    fail(path, nullptr);
  }
  TextByName texts;
  archive_entry* entry = nullptr;
  int status = ARCHIVE_OK;
  while ((status = archive_read_next_header(reader.get(), &entry)) == ARCHIVE_OK || status == ARCHIVE_WARN) {
    const std::string name = name_of(entry);
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      texts[name] = content(path, reader.get(), entry);
    }
  }
  if (status != ARCHIVE_EOF) {
    fail(path, reader.get());
  }
  return texts;
}

std::vector<std::string> names_in_archive(const std::filesystem::path& path) {
  const ArchiveReader reader = open_archive(path);
  std::vector<std::string> names;
  archive_entry* entry = nullptr;
  while (reader != nullptr && archive_read_next_header(reader.get(), &entry) == ARCHIVE_OK) {
    names.push_back(name_of(entry));
  }
  return names;
}

}  // namespace helixnav::logs

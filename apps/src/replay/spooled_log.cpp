// SPDX-License-Identifier: BSD-3-Clause
#include "spooled_log.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp is POSIX

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

std::string new_folder() {
  std::string name = (fs::temp_directory_path() / "helixnav-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw core::InputError(name + ": cannot make a folder: " + std::strerror(errno));
  return name;
}

void copy_whole(const std::string& from, const std::string& to) {
  std::ifstream in(from, std::ios::binary);
  if (!in) throw core::InputError(from + ": cannot be read");
  std::ofstream out(to, std::ios::binary);
  if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
  out.close();
  if (!out) throw core::InputError(to + ": cannot be written; TMPDIR names another place");
}

}  // namespace

SpooledLog::SpooledLog(const std::string& path) : path_(path) {
  std::error_code error;
  if (!fs::is_fifo(path, error)) return;
  folder_ = new_folder();
  path_ = (fs::path(folder_) / (fs::path(path).stem().string() + ".jsonl")).string();
  try {
    copy_whole(path, path_);
    const fs::path vehicle = fs::absolute(path).parent_path() / "vehicle.toml";
    if (fs::exists(vehicle)) fs::copy_file(vehicle, fs::path(folder_) / "vehicle.toml");
  } catch (...) {
    fs::remove_all(folder_, error);
    throw;
  }
}

SpooledLog::~SpooledLog() {
  std::error_code ignored;
  if (is_copy()) fs::remove_all(folder_, ignored);
}

}  // namespace helixnav::apps

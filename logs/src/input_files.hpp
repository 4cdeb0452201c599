// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace helixnav::logs {

/// Of a file's name, say.
inline bool ends_with(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() && text.substr(text.size() - ending.size()) == ending;
}

/// The whole content of a file. Throws core::InputError naming the file when it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// Contents of files by their name without folders.
using TextByName = std::map<std::string, std::string>;

/// The files called `names` (without folders, any depth) of a zip or tar, by libarchive; missing ones are left out.
/// Throws core::InputError for a file that is not an archive or is cut off.
TextByName read_archive(const std::filesystem::path& path, const std::vector<std::string>& names);

/// The names (without folders) of all files in an archive; empty when it is not an archive.
std::vector<std::string> names_in_archive(const std::filesystem::path& path);

}  // namespace helixnav::logs

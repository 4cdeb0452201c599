// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "little_endian.hpp"
#include "missing_rows.hpp"

namespace helixnav::runs {
namespace {

/// The blocks of a drive.bin: one for the start, one for each scan, perhaps one for what came after the last.
struct DriveExtent {
  std::size_t blocks = 0;
  bool is_whole = false;  ///< the last one ends where the file does
};

DriveExtent extent_of_drive(const std::string& path) {
  constexpr std::uintmax_t drive_header = 12, block_header = 12;  // drive_file.cpp
  const std::uintmax_t size = std::filesystem::file_size(path);
  std::ifstream file(path, std::ios::binary);
  DriveExtent extent;
  std::uintmax_t at = drive_header;
  std::string bytes(8, '\0');
  while (at + block_header <= size) {
    file.seekg(static_cast<std::streamoff>(at));
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return extent;
    LittleEndian numbers(bytes);
    const std::uint32_t block = numbers.small();
    const std::uintmax_t next = at + block_header + block;
    if (numbers.small() != ~block || next > size) return extent;
    ++extent.blocks;
    at = next;
  }
  extent.is_whole = at == size;
  return extent;
}

}  // namespace

void tell_cut_drive(const std::string& folder, std::size_t steps, std::vector<std::string>& missing) {
  const std::string path = folder + "/drive.bin";
  if (!std::filesystem::is_regular_file(path)) return;
  const DriveExtent extent = extent_of_drive(path);
  const std::size_t scans = extent.blocks == 0 ? 0 : extent.blocks - 1;
  if (extent.is_whole && scans >= steps) return;
  missing.push_back(path + ": " + std::to_string(scans) + " of " + std::to_string(std::max(steps, scans + 1)) +
                    " scans: the run came to its end, and the file was cut since");
}

}  // namespace helixnav::runs

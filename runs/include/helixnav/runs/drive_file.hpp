// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::files {
class AppendFile;
}

namespace helixnav::runs {

/// A drive as it was fed to a navigator. Feeding it again to one with the same settings gives the same belief to the
/// byte, including open search, particles and learnt noise (docs/adr/0017-driving-again.md).
struct FedDrive {
  core::PoseGaussian start;
  std::vector<core::Event> events;
  /// Number of events before the input ended. Later ones were released by the end alone: scans that might have had
  /// more to come, or whose motion was not known to its end. All events if nothing ended.
  std::size_t before_end_of_input = 0;
};

/// Writes drive.bin (docs/run-folder.md) while the drive goes on. Cost per scan: its bytes and one write.
class DriveFile {
 public:
  /// InputError if the file cannot be written.
  DriveFile(const std::string& path, const core::PoseGaussian& start);
  ~DriveFile();
  DriveFile(const DriveFile&) = delete;
  DriveFile& operator=(const DriveFile&) = delete;

  /// What the navigator has taken. A scan, with what came before it, has been handed to the operating system when this
  /// returns.
  void add(const core::Event& event);
  /// Whatever is added from here on was released because the input has ended (FedDrive::before_end_of_input).
  void end_input();
  /// What has come since the last scan.
  void finish();

 private:
  std::unique_ptr<files::AppendFile> file_;
  std::string block_;  ///< since the last scan
};

/// Reads a drive.bin, bit for bit; an incomplete last block, as left by a killed process, is dropped. InputError naming
/// file and byte if it cannot be read, is not a drive.bin, is of another version or damaged, or holds what no navigator
/// accepts. Test: runs/drive_file_test.cpp (every byte flipped, every length).
FedDrive read_drive(const std::string& path);

}  // namespace helixnav::runs

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

/// A drive as a navigator was fed it. Fed again to one with the same settings it gives the same belief to the byte, with open
/// search, particles, learnt noise and all (docs/adr/0017-driving-again.md).
struct FedDrive {
  core::PoseGaussian start;
  std::vector<core::Event> events;
  /// Of the events: those before the input ended. What comes behind, the end alone brought forth: scans of which more might have
  /// come, or whose motion was not told to its end. As many as there are where nothing ended.
  std::size_t before_end_of_input = 0;
};

/// Writes drive.bin (docs/run-folder.md) while the drive goes on. Cost of a scan: its bytes and one write.
class DriveFile {
 public:
  /// InputError where the file cannot be written.
  DriveFile(const std::string& path, const core::PoseGaussian& start);
  ~DriveFile();
  DriveFile(const DriveFile&) = delete;
  DriveFile& operator=(const DriveFile&) = delete;

  /// What the navigator has taken. A scan, with what came before it, is with the operating system when this returns.
  void add(const core::Event& event);
  /// What is added from here on is so because the input has ended (FedDrive::before_end_of_input).
  void end_input();
  /// What has come since the last scan.
  void finish();

 private:
  std::unique_ptr<files::AppendFile> file_;
  std::string block_;  ///< since the last scan
};

/// Reads a drive.bin, bit for bit; a last block that was not written to its end, as of a process that was killed, is left out.
/// InputError naming file and byte where it cannot be read, is none, is of another version or damaged, or holds what no
/// navigator takes. Test: runs/drive_file_test.cpp (every byte flipped, every length).
FedDrive read_drive(const std::string& path);

}  // namespace helixnav::runs

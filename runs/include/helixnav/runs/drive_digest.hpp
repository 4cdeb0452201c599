// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/core/events.hpp"

namespace helixnav::runs {

/// Identifies a drive, whatever was made of it and however far it went: the SHA-256 of its first observations, 16 or
/// more from whole scans, by time and measurement. Maps with a drive in common share information and must not be
/// joined, because it would count twice. Options, covariances and mountings are not included. Test:
/// runs/drive_digest_test.cpp.
class DriveDigest {
 public:
  /// The next scan of the drive. Scans after the first few are ignored.
  void add(const core::Scan& scan);

  /// 64 hexadecimal digits; empty if there were too few observations, which make no map that could be joined either.
  std::string text() const;

 private:
  std::string bytes_;
  std::size_t observations_ = 0;
};

/// From the scans among the events; empty or one.
std::vector<std::string> drives_of(const std::vector<core::Event>& events);

/// The union of both, sorted, without repeats.
std::vector<std::string> united_drives(std::vector<std::string> drives, const std::vector<std::string>& others);

}  // namespace helixnav::runs

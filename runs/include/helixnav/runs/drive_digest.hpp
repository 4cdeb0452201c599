// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/core/events.hpp"

namespace helixnav::runs {

/// What a drive is known by, whatever was made of it and however far it went: the SHA-256 of its first observations, 16 or more of
/// whole scans, by time and measurement. Maps with a drive in common know the same thing and must not be joined, where it would count
/// twice. Options, covariances and mountings are not in it. Test: runs/drive_digest_test.cpp.
class DriveDigest {
 public:
  /// The next scan of the drive. Nothing is done for any after the first few.
  void add(const core::Scan& scan);

  /// 64 hexadecimal digits; empty where there were not enough observations, which make no map that could be joined either.
  std::string text() const;

 private:
  std::string bytes_;
  std::size_t observations_ = 0;
};

/// Of the scans among the events; empty or one.
std::vector<std::string> drives_of(const std::vector<core::Event>& events);

/// Of both, sorted, each once.
std::vector<std::string> united_drives(std::vector<std::string> drives, const std::vector<std::string>& others);

}  // namespace helixnav::runs

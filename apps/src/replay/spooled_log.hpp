// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace helixnav::apps {

/// A log that can be read repeatedly: itself or, for a FIFO, which can be read once, a copy of everything that came through
/// it, as JSON Lines in a file deleted with this object, beside a copy of the vehicle.toml that is beside the FIFO. Waits for
/// the writer. InputError if the copy cannot be written.
/// Test: apps/own_log_test.cpp.
class SpooledLog {
 public:
  explicit SpooledLog(const std::string& path);
  ~SpooledLog();
  SpooledLog(const SpooledLog&) = delete;
  SpooledLog& operator=(const SpooledLog&) = delete;

  const std::string& path() const { return path_; }

 private:
  bool is_copy() const { return !folder_.empty(); }

  std::string path_;
  std::string folder_;  ///< of the copy; empty if there is none
};

}  // namespace helixnav::apps

// SPDX-License-Identifier: BSD-3-Clause
// Time and memory of the calling program.
#pragma once

#include <ctime>
#include <fstream>
#include <string>

namespace helixnav::bench {

/// Processor time of this thread: time taken by other programs does not count.
inline double seconds_of_this_thread() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A row of /proc/self/status in kB, as MB; 0 if there is none.
inline double status_mb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(key + ":", 0) == 0) return 1e-3 * std::stod(line.substr(key.size() + 1));
  }
  return 0.0;
}

inline double resident_mb() { return status_mb("VmRSS"); }
inline double peak_mb() { return status_mb("VmHWM"); }

}  // namespace helixnav::bench

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace helixnav::testing {

/// Folder of the real logs: $HELIXNAV_DATA, else the folder beside the source tree that CMake compiled in.
inline std::filesystem::path real_data_folder() {
  const char* chosen = std::getenv("HELIXNAV_DATA");
  return chosen != nullptr ? chosen : HELIXNAV_DEFAULT_DATA;
}

/// Base of tests on real logs. `find_real_data` sets `path_` to a file of theirs, or skips the test and says why.
class RealDataTest : public ::testing::Test {
 protected:
  std::filesystem::path path_;

  void find_real_data(const std::filesystem::path& relative) {
    path_ = real_data_folder() / relative;
    if (!std::filesystem::exists(path_)) {
      GTEST_SKIP() << path_ << " is not there; set HELIXNAV_DATA to the folder of the real logs";
    }
  }
};

}  // namespace helixnav::testing

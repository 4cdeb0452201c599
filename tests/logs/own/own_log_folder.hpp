// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "helixnav/logs/own_log.hpp"
#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {

/// A folder with a valid log of the user's own, until a test overwrites one of its files.
struct OwnLogFolder {
  OwnLogFolder() {
    write("vehicle.toml",
          "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\nsigma_heading_deg_per_sqrt_m = 0.5\n"
          "[[sensor]]\nx_m = 0.3\nreach_m = 40\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
    write("odometry.csv", "t_s,v_mps,omega_radps\n0,1,0\n1,1,0.1\n2,1,0\n");
    write("detections.csv", "t_s,range_m,bearing_deg\n0.5,10,90\n0.5,20,-45\n1.5,10,95\n");
  }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return folder.write(name, text);
  }
  OwnLog read() const { return read_own_log(folder.path()); }
  core::Recording recording() const { return make_recording(read(), read_vehicle(folder.path() / "vehicle.toml")); }
  std::string error() const {
    return testing::input_error_of([&] { recording(); });
  }

  testing::TemporaryFolder folder;
};

}  // namespace helixnav::logs

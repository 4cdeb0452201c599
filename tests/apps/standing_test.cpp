// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

/// Straight past four poles, with a stop of 3 s; odometry noise is given per distance only, so that an
/// increment during the stop has none.
void write_drive_with_stop(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream vehicle(folder / "vehicle.toml"), odometry(folder / "odometry.csv"), seen(folder / "detections.csv");
  vehicle << "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\nsigma_sideways_m_per_sqrt_m = 0.01\n"
             "sigma_heading_deg_per_sqrt_m = 0.2\n[[sensor]]\nreach_m = 20\nsigma_range_m = 0.05\n"
             "sigma_bearing_deg = 0.5\n";
  odometry << "t_s,dx_m,dy_m,dheading_deg\n0,0,0,0\n";
  seen << "t_s,range_m,bearing_deg\n";
  double x_m = 0.0;
  for (int k = 1; k <= 60; ++k) {
    const double moved_m = k > 20 && k <= 26 ? 0.0 : 0.2;
    x_m += moved_m;
    odometry << 0.5 * k << ',' << moved_m << ",0,0\n";
    for (const double pole_x_m : {1.0, 4.0, 7.0, 10.0}) {
      const double error_m = (k * 7 + static_cast<int>(pole_x_m) * 5) % 11 * 0.01 - 0.05;
      const double ahead_m = pole_x_m - x_m, left_m = pole_x_m > 5.0 ? 3.0 : -3.0;
      seen << 0.5 * k << ',' << std::hypot(ahead_m, left_m) + error_m << ','
           << std::atan2(left_m, ahead_m) / core::pi * 180.0 - 10.0 * error_m << '\n';
    }
  }
}

TEST(Standing, WithNoiseByTheWayIsSolvedAsAWhole) {
  const testing::TemporaryFolder folder;
  const auto log = folder.path() / "log";
  write_drive_with_stop(log);
  const Outcome smoothed = run({"replay", log, "--smooth", "--out", folder.path() / "run"});
  EXPECT_EQ(smoothed.exit_code, 0) << smoothed.err;
  EXPECT_EQ(smoothed.out.find("rank two"), std::string::npos) << "the rest of the drive keeps its noise";
}

}  // namespace
}  // namespace helixnav::apps

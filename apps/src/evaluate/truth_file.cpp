// SPDX-License-Identifier: BSD-3-Clause
#include "truth_file.hpp"

#include <filesystem>

#include "helixnav/logs/acfr_log.hpp"

namespace helixnav::apps {

runs::RunTruth read_truth_file(const std::string& path, double offset_s, const runs::RunTruth& run) {
  runs::RunTruth truth;
  if (std::filesystem::path(path).extension() == ".mat") {
    for (const logs::GpsFix& fix : logs::read_victoria_park_gps(path)) {
      truth.positions.push_back({fix.t_ns, fix.position_m});
    }
    truth.antenna_robot_m = run.antenna_robot_m;
  } else {
    truth = runs::read_truth(path);
  }
  const core::Nanoseconds offset_ns = core::nanoseconds_from_seconds(offset_s);
  for (core::TruePosition& fix : truth.positions) fix.t_ns += offset_ns;
  for (core::TruePose& pose : truth.poses) pose.t_ns += offset_ns;
  return truth;
}

}  // namespace helixnav::apps

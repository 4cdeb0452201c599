// SPDX-License-Identifier: BSD-3-Clause
#include "truth_file.hpp"

#include <filesystem>

#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/read_recording.hpp"

namespace helixnav::apps {
namespace {

bool is_own_log(const std::filesystem::path& path) {
  return path.extension() == ".jsonl" || std::filesystem::exists(path / "odometry.csv");
}

}  // namespace

runs::RunTruth read_truth_file(const std::string& path, double offset_s, const runs::RunTruth& run) {
  runs::RunTruth truth;
  if (std::filesystem::path(path).extension() == ".mat") {
    for (const logs::GpsFix& fix : logs::read_victoria_park_gps(path)) {
      truth.positions.push_back({fix.t_ns, fix.position_m});
    }
    truth.antenna_robot_m = run.antenna_robot_m;
  } else if (is_own_log(path)) {
    truth = runs::truth_of(logs::read_recording(path));
    truth.labels = run.labels;  // by steps of the run, which may have taken fewer scans
  } else {
    truth = runs::read_truth(path);
  }
  const core::Nanoseconds offset_ns = core::nanoseconds_from_seconds(offset_s);
  for (core::TruePosition& fix : truth.positions) fix.t_ns += offset_ns;
  for (core::TruePose& pose : truth.poses) pose.t_ns += offset_ns;
  return truth;
}

}  // namespace helixnav::apps

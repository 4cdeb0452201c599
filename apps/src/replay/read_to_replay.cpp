// SPDX-License-Identifier: BSD-3-Clause
#include "read_to_replay.hpp"

#include "estimate_range_scale.hpp"
#include "fuse_gps.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "settings/vehicle_option.hpp"

namespace helixnav::apps {
namespace {

/// By the scale given, or by one estimated from the log itself.
void scale_ranges(LogToReplay& log, const Settings& settings) {
  double scale = settings.plaza_range_scale;
  if (scale == 0.0 && !settings.known_association) return;  // the scale needs names; drive says what is missing
  if (scale == 0.0) {
    scale = estimate_range_scale(log.recording, settings.navigator);
    log.estimated_range_scale = scale;
  }
  divide_ranges(log.recording, scale);
}

}  // namespace

LogToReplay read_to_replay(const std::string& path, Settings& settings) {
  settings.logs.plaza.range_scale = 1.0;  // see scale_ranges
  LogToReplay log{logs::read_recording(path, settings.logs), std::nullopt};
  const logs::LogFormat format = logs::recognise(path);
  if (settings.logs.vehicle) tell_vehicle(log.recording, format, *settings.logs.vehicle);
  if (format == logs::LogFormat::plaza) scale_ranges(log, settings);
  if (settings.gps.fuse) fuse_gps(log.recording, settings.gps);
  if (!log.recording.true_poses.empty()) log.recording.true_positions.clear();  // the better truth
  return log;
}

}  // namespace helixnav::apps

// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/own_log.hpp"
#include "motion.hpp"
#include "own/tables/sensor_rows.hpp"
#include "own_doubts.hpp"
#include "own_overlap.hpp"
#include "own_truth.hpp"
#include "plausible.hpp"
#include "weaver.hpp"

namespace helixnav::logs {
namespace {

[[noreturn]] void fail(const OwnLog& log, const std::string& message) {
  throw core::InputError(log.name + ": " + message);
}

/// [sensor of the log] the vehicle's.
std::vector<SensorModel> sensors_of(const OwnLog& log, const Vehicle& vehicle) {
  std::vector<SensorModel> sensors;
  for (const std::string& name : log.sensor_names) sensors.push_back(sensor_called(name, log.name, vehicle));
  return sensors;
}

struct LabelledScan {
  core::Scan scan;
  std::vector<core::Label> labels;
  std::size_t sensor = 0;
};

std::vector<LabelledScan> scans_of(const OwnLog& log, const std::vector<SensorModel>& sensors, const Vehicle& vehicle) {
  std::vector<LabelledScan> scans;
  for (std::size_t i = 0; i < log.detections.size(); ++i) {
    const OwnDetection& row = log.detections[i];
    const SensorModel& sensor = sensors[row.sensor];
    const bool same = i > 0 && log.detections[i - 1].t_ns == row.t_ns && log.detections[i - 1].sensor == row.sensor;
    if (!same) {
      LabelledScan& begun = scans.emplace_back();
      begun.scan.t_ns = row.t_ns - core::nanoseconds_from_seconds(sensor.delay_s);
      begun.scan.T_robot_sensor = sensor.T_vehicle_sensor;
      begun.sensor = row.sensor;
    }
    if (row.kind == OwnDetection::Kind::nothing) continue;
    if (scans.back().labels.size() == most_observations) {
      fail(log, "more than " + std::to_string(most_observations) + " detections in one scan, at " +
                    std::to_string(core::seconds(row.t_ns)) + " s; do the rows have times of their own?");
    }
    scans.back().scan.observations.push_back(observation_of(row, sensor, vehicle));
    scans.back().labels.push_back(row.label);
  }
  std::stable_sort(scans.begin(), scans.end(),
                   [](const LabelledScan& a, const LabelledScan& b) { return a.scan.t_ns < b.scan.t_ns; });
  return scans;
}

/// Adds each sensor's view, estimated from its observations if the vehicle file does not state it.
void add_views(std::vector<LabelledScan>& scans, const std::vector<SensorModel>& sensors) {
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    core::Recording alone;
    const SensorModel& sensor = sensors[s];
    const bool all_told = sensor.reach_m && sensor.min_bearing_rad;
    for (const LabelledScan& scan : scans) {
      if (!all_told && scan.sensor == s) alone.events.emplace_back(scan.scan);
    }
    core::FieldOfView view = all_told ? core::FieldOfView() : estimate_field_of_view(alone);
    tell_view(sensor, view);
    for (LabelledScan& scan : scans) {
      if (scan.sensor == s) scan.scan.field_of_view = view;
    }
  }
}

void check_clocks(const OwnLog& log, const std::vector<LabelledScan>& scans) {
  if (log.odometry.empty() || scans.empty()) fail(log, "a log needs odometry and detections");
  const double odometry_from_s = core::seconds(log.odometry.front().t_ns);
  const double odometry_to_s = core::seconds(log.odometry.back().t_ns);
  const double scans_from_s = core::seconds(scans.front().scan.t_ns);
  const double scans_to_s = core::seconds(scans.back().scan.t_ns);
  if (scans_from_s <= odometry_to_s && odometry_from_s <= scans_to_s) return;
  char text[256];
  std::snprintf(text, sizeof text,
                "the clocks of odometry (%.9g to %.9g s) and detections (%.9g to %.9g s) do not overlap; are both in "
                "the same unit and of the same clock? A constant difference is delay_s of the [[sensor]]",
                odometry_from_s, odometry_to_s, scans_from_s, scans_to_s);
  fail(log, text);
}

/// Increments and poses do not determine where a scan was taken after their end: such scans are left out, and counted
/// in a remark. If nearly all are, the two have different clocks or units, as with times in milliseconds in a column of
/// seconds.
void leave_out_untold(const OwnLog& log, std::vector<LabelledScan>& scans, std::vector<std::string>& remarks) {
  if (log.odometry_kind != OdometryKind::increments && log.odometry_kind != OdometryKind::poses) return;
  const core::Nanoseconds end_ns =
      told_until_ns(log.odometry.front().t_ns, log.odometry.back().t_ns, log.odometry.size());
  const auto is_untold = [&](const LabelledScan& scan) { return scan.scan.t_ns > end_ns; };
  const auto first = std::find_if(scans.begin(), scans.end(), is_untold);
  if (first == scans.end()) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "%td of %zu scans were taken after the odometry ends at %.9g s (%.9g to %.9g s); they are not used",
                scans.end() - first, scans.size(), core::seconds(log.odometry.back().t_ns),
                core::seconds(first->scan.t_ns), core::seconds(scans.back().scan.t_ns));
  const std::ptrdiff_t used = first - scans.begin();
  if (scans.size() >= 20 && 10 * static_cast<std::size_t>(used) < scans.size()) {
    fail(log, text + std::string(". Are both of the same clock and in the same unit? A column t_s holds seconds, t_ms "
                                 "milliseconds; a constant difference is delay_s of the [[sensor]]"));
  }
  remarks.emplace_back(text);
  scans.erase(first, scans.end());
}

/// Identities may also stand with the true landmarks alone.
bool names_any(const std::vector<LabelledScan>& scans) {
  return std::any_of(scans.begin(), scans.end(), [](const LabelledScan& scan) {
    return std::any_of(scan.labels.begin(), scan.labels.end(),
                       [](core::Label label) { return label != core::no_label; });
  });
}

/// Adds motion and scans of the whole log; that the vehicle was carried, before the first scan after it. Returns when
/// the first motion begins.
core::Nanoseconds weave(const OwnLog& log, const Vehicle& vehicle, std::vector<LabelledScan>& scans,
                        core::Recording& recording) {
  Motions motions(log, vehicle);
  Weaver weaver(vehicle.odometry.T_vehicle_odometry, recording.events);
  auto lost = log.lost_ns.begin();
  std::size_t next = 0;
  const bool has_labels = log.has_labels && names_any(scans);
  const auto add_next = [&](const Motion* motion) {
    LabelledScan& scan = scans[next++];
    for (; lost != log.lost_ns.end() && *lost < scan.scan.t_ns; ++lost) {
      if (motion != nullptr) weaver.move(*motion, *lost);
      weaver.lose(*lost);
    }
    if (motion != nullptr) weaver.move(*motion, scan.scan.t_ns);
    weaver.add(std::move(scan.scan));
    if (has_labels) recording.labels.push_back(std::move(scan.labels));
  };
  const core::Nanoseconds last_ns = scans.back().scan.t_ns;
  core::Nanoseconds first_ns = last_ns;
  for (std::size_t row = 0; row < log.odometry.size(); ++row) {
    const std::optional<Motion> motion = motions.of_row(row, last_ns);
    if (!motion) continue;
    first_ns = std::min(first_ns, motion->begin_ns);
    while (next < scans.size() && scans[next].scan.t_ns < motion->end_ns) add_next(&*motion);
    for (; next < scans.size() && lost != log.lost_ns.end() && *lost < motion->end_ns; ++lost) {
      weaver.move(*motion, *lost);
      weaver.lose(*lost);
    }
    weaver.move(*motion, motion->end_ns);
  }
  const std::optional<Motion> beyond = motions.beyond_last();
  while (next < scans.size()) add_next(beyond ? &*beyond : nullptr);
  weaver.flush();
  return first_ns;
}

/// The first row of increments describes what was driven until its time: if no scan was taken before that, the first event.
Beginning beginning_of(const OwnLog& log, const Vehicle& vehicle, core::Nanoseconds first_scan_ns,
                       core::Nanoseconds first_motion_ns) {
  Beginning beginning;
  beginning.t_ns = std::min(first_scan_ns, first_motion_ns);
  const core::Nanoseconds row_ns = log.odometry.front().t_ns;
  if (log.odometry_kind != OdometryKind::increments || first_scan_ns < row_ns) return beginning;
  beginning.t_ns = row_ns;
  const std::optional<Motion> first = Motions(log, vehicle).of_row(0, row_ns);
  beginning.T_start_first = part_of(*first, 1.0, row_ns, vehicle.odometry.T_vehicle_odometry).T_before_after;
  if (log.odometry.size() > 1) beginning.lasted_ns = log.odometry[1].t_ns - row_ns;
  return beginning;
}

}  // namespace

core::Recording make_recording(const OwnLog& log, const Vehicle& vehicle) {
  const std::vector<SensorModel> sensors = sensors_of(log, vehicle);
  std::vector<LabelledScan> scans = scans_of(log, sensors, vehicle);
  check_clocks(log, scans);
  core::Recording recording;
  recording.remarks = log.remarks;
  leave_out_untold(log, scans, recording.remarks);
  add_views(scans, sensors);
  recording.name = log.name;
  recording.label_names = log.id_names;
  recording.extraneous_per_scan = 0.0;
  recording.antenna_robot_m = vehicle.antenna_m;
  const core::Nanoseconds first_scan_ns = scans.front().scan.t_ns;
  const core::Nanoseconds first_motion_ns = weave(log, vehicle, scans, recording);
  add_truth(log, beginning_of(log, vehicle, first_scan_ns, first_motion_ns), recording);
  for (std::string& doubt : doubts_of(log, vehicle, recording)) recording.remarks.push_back(std::move(doubt));
  return recording;
}

}  // namespace helixnav::logs

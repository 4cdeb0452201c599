// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/own_log.hpp"
#include "motion.hpp"
#include "own_doubts.hpp"
#include "own_truth.hpp"
#include "plausible.hpp"

namespace helixnav::logs {
namespace {

[[noreturn]] void fail(const OwnLog& log, const std::string& message) {
  throw core::InputError(log.name + ": " + message);
}

std::string where(const Vehicle& vehicle) { return vehicle.path.empty() ? "no vehicle.toml" : vehicle.path; }

/// [sensor of the log] the vehicle's; a log that names none, and a vehicle that has but one, need no names.
std::vector<SensorModel> sensors_of(const OwnLog& log, const Vehicle& vehicle) {
  std::vector<SensorModel> sensors;
  for (const std::string& name : log.sensor_names) {
    const SensorModel* found = nullptr;
    std::string known;
    for (const SensorModel& sensor : vehicle.sensors) {
      if (sensor.name == name || (vehicle.sensors.size() == 1 && (name.empty() || sensor.name.empty())))
        found = &sensor;
      known += (known.empty() ? "" : ", ") + sensor.name;
    }
    if (found == nullptr && !vehicle.sensors.empty()) {
      throw core::InputError(where(vehicle) + ": no [[sensor]] is called '" + name + "' as in the column sensor of " +
                             log.name + "; there are: " + known);
    }
    sensors.push_back(found == nullptr ? SensorModel() : *found);
  }
  return sensors;
}

double given_variance(const std::optional<double>& sigma, const SensorModel& sensor, const Vehicle& vehicle,
                      const char* key) {
  if (sigma) return *sigma * *sigma;
  throw core::InputError(where(vehicle) +
                         ": no noise of a detection is given: neither a column of detections.csv nor " + key +
                         " in section [[sensor]]" + (sensor.name.empty() ? "" : " of '" + sensor.name + "'") +
                         "; 'helixnav new-vehicle' writes an example");
}

/// As the sensor measures it, with the noise of the row, else of the sensor.
core::Observation observation_of(const OwnDetection& row, const SensorModel& sensor, const Vehicle& vehicle) {
  const bool own = row.R[0] > 0.0;
  const auto range_variance = [&] {
    return own ? row.R[0] : given_variance(sensor.sigma_range_m, sensor, vehicle, "sigma_range_m");
  };
  const auto bearing_variance = [&](double own_variance) {
    return own ? own_variance : given_variance(sensor.sigma_bearing_rad, sensor, vehicle, "sigma_bearing_deg");
  };
  core::Observation observation;
  if (row.kind == OwnDetection::Kind::range_bearing) {
    observation = core::make_range_bearing(row.z[0] / sensor.range_scale, row.z[1], std::sqrt(range_variance()),
                                           std::sqrt(bearing_variance(row.R[2])));
  } else if (row.kind == OwnDetection::Kind::range) {
    observation = core::make_range(row.z[0] / sensor.range_scale, std::sqrt(range_variance()));
  } else if (row.kind == OwnDetection::Kind::bearing) {
    observation = core::make_bearing(row.z[0], std::sqrt(bearing_variance(row.R[0])));
  } else {
    Eigen::Matrix2d R;
    R << row.R[0], row.R[1], row.R[1], row.R[2];
    if (!own) R = given_variance(sensor.sigma_point_m, sensor, vehicle, "sigma_point_m") * Eigen::Matrix2d::Identity();
    observation = core::make_cartesian(Eigen::Vector2d(row.z[0], row.z[1]) / sensor.range_scale, R);
  }
  observation.R *= sensor.noise_scale * sensor.noise_scale;
  return observation;
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

/// Of each sensor, as its observations say where the vehicle file does not.
void add_views(std::vector<LabelledScan>& scans, const std::vector<SensorModel>& sensors) {
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    core::Recording alone;
    const SensorModel& sensor = sensors[s];
    const bool all_told = (sensor.reach_m || sensor.reliable_range_m) && sensor.min_bearing_rad;
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

/// Lets motion come in, and scans at their times.
class Weaver {
 public:
  Weaver(const OwnLog& log, const Vehicle& vehicle, core::Recording& recording)
      : log_(log),
        motions_(log, vehicle),
        T_vehicle_odometry_(vehicle.odometry.T_vehicle_odometry),
        recording_(recording) {}

  /// When the first motion begins.
  core::Nanoseconds weave(std::vector<LabelledScan>& scans) {
    const core::Nanoseconds last_ns = scans.back().scan.t_ns;
    core::Nanoseconds first_ns = last_ns;
    for (std::size_t row = 0; row < log_.odometry.size(); ++row) {
      const std::optional<Motion> motion = motions_.of_row(row, last_ns);
      if (!motion) continue;
      first_ns = std::min(first_ns, motion->begin_ns);
      for (; next_ < scans.size() && scans[next_].scan.t_ns < motion->end_ns; ++next_) {
        move(*motion, scans[next_].scan.t_ns);
        add(scans[next_]);
      }
      move(*motion, motion->end_ns);
    }
    for (; next_ < scans.size(); ++next_) add(scans[next_]);
    flush();
    return first_ns;
  }

 private:
  /// On to t_ns, as far as the motion goes there.
  void move(const Motion& motion, core::Nanoseconds t_ns) {
    if (!now_ns_ || *now_ns_ < motion.begin_ns) now_ns_ = motion.begin_ns;
    const bool instantaneous = motion.end_ns == motion.begin_ns;
    const bool nothing = motion.twist.isZero(0.0) && motion.covariance.isZero(0.0);
    if (instantaneous && (nothing || t_ns != motion.end_ns)) return;
    if (!instantaneous && t_ns <= *now_ns_) return;
    const double share =
        instantaneous ? 1.0 : core::seconds(t_ns - *now_ns_) / core::seconds(motion.end_ns - motion.begin_ns);
    const core::Odometry part = part_of(motion, share, t_ns, T_vehicle_odometry_);
    pending_ = pending_ ? core::chain(*pending_, part) : part;
    now_ns_ = t_ns;
  }

  void flush() {
    if (pending_) recording_.events.emplace_back(*pending_);
    pending_.reset();
  }

  void add(LabelledScan& scan) {
    flush();
    recording_.events.emplace_back(std::move(scan.scan));
    if (log_.has_labels) recording_.labels.push_back(std::move(scan.labels));
  }

  const OwnLog& log_;
  Motions motions_;
  core::Pose2 T_vehicle_odometry_;
  core::Recording& recording_;
  std::optional<core::Nanoseconds> now_ns_;
  std::optional<core::Odometry> pending_;
  std::size_t next_ = 0;
};

}  // namespace

core::Recording make_recording(const OwnLog& log, const Vehicle& vehicle) {
  const std::vector<SensorModel> sensors = sensors_of(log, vehicle);
  std::vector<LabelledScan> scans = scans_of(log, sensors, vehicle);
  check_clocks(log, scans);
  add_views(scans, sensors);
  core::Recording recording;
  recording.name = log.name;
  recording.extraneous_per_scan = 0.0;
  recording.antenna_robot_m = vehicle.antenna_m;
  recording.remarks = log.remarks;
  const core::Nanoseconds first_scan_ns = scans.front().scan.t_ns;
  const core::Nanoseconds first_motion_ns = Weaver(log, vehicle, recording).weave(scans);
  add_truth(log, std::min(first_scan_ns, first_motion_ns), recording);
  for (std::string& doubt : doubts_of(log, vehicle, recording)) recording.remarks.push_back(std::move(doubt));
  return recording;
}

}  // namespace helixnav::logs

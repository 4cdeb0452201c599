// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/acfr_recording.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::logs {
namespace {

/// Turns held samples of speed and steering into increments that end where requested.
class HeldSteering {
 public:
  HeldSteering(const AcfrLog& log, const AcfrSettings& settings) : log_(log), settings_(settings) {}

  /// Appends the motion from the last end until `t_ns`; nothing before the first sample.
  void move_until(core::Nanoseconds t_ns, std::vector<core::Event>& events) {
    if (started_ && t_ns > now_ns_) {
      events.emplace_back(increment(t_ns));
      now_ns_ = t_ns;
    }
  }

  /// The reading `index` holds from now on.
  void hold(std::size_t index) {
    index_ = index;
    if (!started_) {
      started_ = true;
      now_ns_ = log_.dead_reckoning[index].t_ns;
    }
  }

 private:
  core::Odometry increment(core::Nanoseconds t_ns) const {
    const DeadReckoning& held = log_.dead_reckoning[index_];
    core::AckermannSample sample;
    sample.wheel_speed_mps = settings_.speed_scale * held.wheel_speed_mps;
    sample.steering_rad = settings_.steering_scale * held.steering_rad + settings_.steering_offset_rad;
    sample.duration_s = core::seconds(t_ns - now_ns_);
    core::Odometry odometry = ackermann_increment(settings_.geometry, settings_.noise, sample);
    odometry.covariance *= core::seconds(holds_until_ns(t_ns) - held.t_ns) / sample.duration_s;
    odometry.covariance += side_slip(odometry.T_before_after);
    odometry.t_ns = t_ns;
    return odometry;
  }

  /// In proportion to distance, not per sample, so that parts add up to the whole; across the middle of the arc.
  Eigen::Matrix3d side_slip(const core::Pose2& moved) const {
    const double sigma = settings_.sigma_sideways_m_per_sqrt_m;
    const double half_turn_rad = 0.5 * moved.heading_rad;
    const Eigen::Vector3d across(-std::sin(half_turn_rad), std::cos(half_turn_rad), 0.0);
    return sigma * sigma * moved.position_m().norm() * across * across.transpose();
  }

  /// One sample has one error: a whole of duration d has d²σ², so that a part p of it carries p·d·σ².
  core::Nanoseconds holds_until_ns(core::Nanoseconds otherwise_ns) const {
    const bool last = index_ + 1 == log_.dead_reckoning.size();
    return last ? otherwise_ns : log_.dead_reckoning[index_ + 1].t_ns;
  }

  const AcfrLog& log_;
  const AcfrSettings& settings_;
  std::size_t index_ = 0;
  core::Nanoseconds now_ns_ = 0;
  bool started_ = false;
};

std::vector<SickDetection> detect(const SickScan& scan, const AcfrSettings& settings) {
  return settings.detector == AcfrSettings::Detector::trees ? detect_trees(scan, settings.trees)
                                                            : detect_reflectors(scan, settings.reflectors);
}

core::FieldOfView field_of_view(const AcfrSettings& settings) {
  const bool trees = settings.detector == AcfrSettings::Detector::trees;
  const double half_rad = core::pi / 2.0 - (trees ? settings.trees.edge_margin_rad : 0.0);
  return {trees ? settings.trees.min_range_m : 0.0, settings.view_range_m, -half_rad, half_rad, settings.reach_m};
}

core::Scan observe(const SickScan& raw, const AcfrSettings& settings) {
  core::Scan scan;
  scan.t_ns = raw.t_ns;
  scan.T_robot_sensor = settings.T_robot_laser;
  scan.field_of_view = field_of_view(settings);
  for (const SickDetection& seen : detect(raw, settings)) {
    scan.observations.push_back(
        core::make_range_bearing(seen.range_m, seen.bearing_rad, settings.sigma_range_m, settings.sigma_bearing_rad));
  }
  return scan;
}

core::Nanoseconds time_of(const AcfrLog& log, const AcfrLog::Reading& reading) {
  if (reading.sensor == AcfrLog::Sensor::gps) return log.gps[reading.index].t_ns;
  if (reading.sensor == AcfrLog::Sensor::laser) return log.scans[reading.index].t_ns;
  return log.dead_reckoning[reading.index].t_ns;
}

}  // namespace

AcfrLog without_laser_delay(AcfrLog log, double delay_s) {
  if (delay_s == 0.0) return log;
  for (SickScan& scan : log.scans) scan.t_ns -= core::nanoseconds_from_seconds(delay_s);
  std::stable_sort(log.order.begin(), log.order.end(), [&](const AcfrLog::Reading& a, const AcfrLog::Reading& b) {
    return time_of(log, a) < time_of(log, b);
  });
  return log;
}

AcfrSettings car_park_settings() {
  AcfrSettings settings;
  settings.detector = AcfrSettings::Detector::reflectors;
  settings.noise = {1.0, 0.15};  // so wide that slip is in it
  settings.sigma_sideways_m_per_sqrt_m = 0.0;
  settings.speed_scale = 1.0;
  settings.steering_scale = 1.0;
  settings.steering_offset_rad = 0.0075;
  settings.laser_delay_s = 0.0;
  settings.T_robot_laser = {3.78, 0.5, 0.0};
  settings.sigma_range_m = 0.05;
  settings.sigma_bearing_rad = 0.01;
  settings.view_range_m = 5.0;
  settings.extraneous_per_scan = 0.5;  // hardly anything else is bright: 22 landmarks started in 586 scans
  return settings;
}

core::Recording make_recording(const AcfrLog& as_recorded, const AcfrSettings& settings) {
  const AcfrLog log = without_laser_delay(as_recorded, settings.laser_delay_s);
  core::Recording recording;
  recording.name = log.name;
  recording.true_landmarks = log.beacons;
  recording.extraneous_per_scan = settings.extraneous_per_scan;
  recording.antenna_robot_m = settings.T_robot_laser.position_m();
  recording.events.reserve(log.dead_reckoning.size() + 2 * log.scans.size());
  HeldSteering steering(log, settings);
  for (const AcfrLog::Reading& reading : log.order) {
    if (reading.sensor == AcfrLog::Sensor::dead_reckoning) {
      steering.move_until(log.dead_reckoning[reading.index].t_ns, recording.events);
      steering.hold(reading.index);
    } else if (reading.sensor == AcfrLog::Sensor::laser) {
      steering.move_until(log.scans[reading.index].t_ns, recording.events);
      recording.events.emplace_back(observe(log.scans[reading.index], settings));
    } else {
      recording.true_positions.push_back({log.gps[reading.index].t_ns, log.gps[reading.index].position_m});
    }
  }
  return recording;
}

}  // namespace helixnav::logs

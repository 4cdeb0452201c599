// SPDX-License-Identifier: BSD-3-Clause
#include "example_log.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <variant>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::apps {
namespace {

constexpr const char* vehicle_text =
    R"(# A vehicle. Lengths are in metres; an angle ends in _deg or in _rad, as you like. Only lines without # are
# settings; everything else is a default or is taken from the log. Positions are in the frame of the vehicle: x ahead, y to the
# left, and its origin is the point whose path you want to know.
name = "example cart"

[odometry]
# Where the odometry is measured (the middle of the rear axle), when that is not the origin of the frame.
# x_m = 0.0
# y_m = 0.0
# Noise that grows with the way or with the time: after 100 m of straight driving, sigma_along_m_per_sqrt_m = 0.05 means
# a standard deviation of 0.05 * sqrt(100) = 0.5 m. What a column of odometry.csv says comes first.
sigma_along_m_per_sqrt_m = 0.027
sigma_sideways_m_per_sqrt_m = 0.005
sigma_heading_deg_per_sqrt_m = 0.16
# sigma_heading_deg_per_sqrt_s = 0.1     # of a gyro
# sigma_heading_deg_per_sqrt_turn = 4.0  # of wheels that slide when the vehicle turns on the spot; 360 degrees are a turn
# Noise of each sample of speed and turn rate, instead or as well:
# sigma_v_mps = 0.1
# sigma_omega_deg_per_s = 1.0
# What is known to be wrong with it:
# scale = 1.0                            # times distances and speeds
# turn_scale = 1.0                       # times turns
# turn_bias_deg_per_s = 0.0              # taken off every turn rate
# A car, whose odometry.csv has v_mps and steering_deg:
# wheelbase_m = 2.7
# steering_offset_deg = 0.0
# steering_scale = 1.0
# sigma_steering_deg = 1.0
# Two driven wheels, whose odometry.csv has v_left_mps and v_right_mps:
# track_m = 0.5
# sigma_v_mps = 0.1                      # of each wheel; with sigma_omega_deg_per_s beside it: of the speed of both

[[sensor]]                               # one section for each; several are told apart by their names
name = "laser"
x_m = 0.5                                # where it is on the vehicle
y_m = 0.0
heading_deg = 0.0                        # where it looks
reach_m = 30.0                           # it sees landmarks up to here; all lengths of the navigator follow from this
# reliable_range_m = 25.0                # and surely up to here: a landmark that is missed nearer is doubted
min_range_m = 1.0
view_deg = [-90, 90]                     # from the right to the left; all around: [-180, 180]
sigma_range_m = 0.1                      # noise of a detection; what a column of detections.csv says comes first
sigma_bearing_deg = 0.7
# sigma_point_m = 0.1                    # for detections as x_m, y_m
detection_probability = 0.9              # that a landmark in view is detected in one scan
clutter_per_scan = 0.5                   # detections of nothing
# delay_s = 0.0                          # a scan was taken so long before its time in the log

# [antenna]                              # of fixes.csv
# x_m = 0.0
# y_m = 0.0
# sigma_m = 1.0
)";

constexpr double deg_in_rad = 180.0 / core::pi;

template <class... Values>
void append(std::string& text, const char* format, Values... values) {
  std::array<char, 160> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  text += buffer.data();
}

core::Recording example_drive() {
  sim::Scenario scenario = sim::named_scenario("figure-of-eight");
  scenario.scanner.T_robot_sensor = {0.5, 0.0, 0.0};
  scenario.true_noise.odometry = {0.15, 0.0147};
  return sim::simulate(scenario, 1);
}

void append_scan(const core::Scan& scan, ExampleLog& log) {
  const double t_s = core::seconds(scan.t_ns);
  if (scan.observations.empty()) append(log.detections, "%.3f,,\n", t_s);  // nothing seen: that is information, too
  for (const core::Observation& z : scan.observations)
    append(log.detections, "%.3f,%.3f,%.2f\n", t_s, z.z[0], deg_in_rad * (z.z[1]));
}

}  // namespace

ExampleLog make_example_log() {
  const core::Recording recording = example_drive();
  ExampleLog log;
  log.vehicle = vehicle_text;
  log.odometry = "t_s,dx_m,dy_m,dheading_deg\n";
  log.detections = "t_s,range_m,bearing_deg\n";
  log.truth_poses = "t_s,x_m,y_m,heading_deg\n";
  log.truth_landmarks = "x_m,y_m\n";
  append(log.odometry, "%.3f,0,0,0\n", core::seconds(core::time_of(recording.events.front())));
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      const core::Pose2& moved = odometry->T_before_after;
      append(log.odometry, "%.3f,%.4f,%.4f,%.4f\n", core::seconds(odometry->t_ns), moved.x_m, moved.y_m,
             deg_in_rad * (moved.heading_rad));
    }
    if (const auto* scan = std::get_if<core::Scan>(&event)) append_scan(*scan, log);
  }
  for (const core::TruePose& pose : recording.true_poses) {
    append(log.truth_poses, "%.3f,%.4f,%.4f,%.4f\n", core::seconds(pose.t_ns), pose.T_world_robot.x_m,
           pose.T_world_robot.y_m, deg_in_rad * (pose.T_world_robot.heading_rad));
  }
  for (const core::TrueLandmark& tree : recording.true_landmarks) {
    append(log.truth_landmarks, "%.3f,%.3f\n", tree.point_m.x(), tree.point_m.y());
  }
  return log;
}

}  // namespace helixnav::apps

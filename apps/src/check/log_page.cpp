// SPDX-License-Identifier: BSD-3-Clause
#include "log_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <variant>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/logs/field_of_view.hpp"

namespace helixnav::apps {
namespace {

constexpr double deg_per_rad = 180.0 / core::pi;

template <class... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 320> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return std::string(buffer.data()) + '\n';
}

double rate(std::size_t count, double duration_s) {
  return duration_s > 0.0 ? static_cast<double>(count - 1) / duration_s : 0.0;
}

struct ScanCounts {
  std::size_t scans = 0, empty = 0, observations = 0;
  std::array<std::size_t, 4> of_kind{};
  double first_s = 0.0, last_s = 0.0, gap_s = 0.0, gap_from_s = 0.0;
};

ScanCounts count_scans(const core::Recording& recording) {
  ScanCounts counts;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    const double t_s = core::seconds(scan->t_ns);
    if (counts.scans == 0) counts.first_s = counts.last_s = t_s;
    if (t_s - counts.last_s > counts.gap_s) {
      counts.gap_s = t_s - counts.last_s;
      counts.gap_from_s = counts.last_s;
    }
    counts.last_s = t_s;
    ++counts.scans;
    counts.empty += scan->observations.empty() ? 1 : 0;
    counts.observations += scan->observations.size();
    for (const core::Observation& observation : scan->observations)
      ++counts.of_kind[static_cast<std::size_t>(observation.kind)];
  }
  return counts;
}

std::string motion_text(const core::Recording& recording) {
  double way_m = 0.0, turned_rad = 0.0, left_rad = 0.0;
  for (const core::Event& event : recording.events) {
    const auto* odometry = std::get_if<core::Odometry>(&event);
    if (odometry == nullptr) continue;
    way_m += odometry->T_before_after.position_m().norm();
    turned_rad += std::abs(odometry->T_before_after.heading_rad);
    left_rad += odometry->T_before_after.heading_rad;
  }
  return line("motion      %.4g m driven, %.4g deg turned, in sum %.4g deg to the left", way_m,
              deg_per_rad * (turned_rad), deg_per_rad * (left_rad));
}

std::string kinds_text(const ScanCounts& counts) {
  constexpr std::array names{"range and bearing", "points", "bearings", "ranges"};
  std::string text;
  for (std::size_t kind = 0; kind < names.size(); ++kind) {
    if (counts.of_kind[kind] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(counts.of_kind[kind]) + ' ' + names[kind];
  }
  return text.empty() ? "nothing" : text;
}

std::string view_text(const char* what, const core::FieldOfView& view) {
  std::array<char, 64> reach{};
  std::snprintf(reach.data(), reach.size(), view.reach() ? "reach %.4g m" : "reach unknown",
                view.reach().value_or(0.0));
  return line("%s %s, surely from %.3g to %.4g m, bearings from %.4g to %.4g deg", what, reach.data(), view.min_range_m,
              view.max_range_m, deg_per_rad * (view.min_bearing_rad), deg_per_rad * (view.max_bearing_rad));
}

/// The scans of each sensor, by where it is mounted, in the order in which they come.
std::vector<core::Recording> apart_by_sensor(const core::Recording& recording) {
  std::vector<core::Pose2> mounted;
  std::vector<core::Recording> sensors;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    const auto known = std::find_if(mounted.begin(), mounted.end(), [&](const core::Pose2& other) {
      return other.vector() == scan->T_robot_sensor.vector();
    });
    const auto sensor = static_cast<std::size_t>(known - mounted.begin());
    if (known == mounted.end()) {
      mounted.push_back(scan->T_robot_sensor);
      sensors.emplace_back();
    }
    sensors[sensor].events.push_back(event);
  }
  return sensors;
}

std::string sensor_name(const core::Pose2& T_robot_sensor, const logs::Vehicle* vehicle) {
  if (vehicle != nullptr) {
    for (const logs::SensorModel& sensor : vehicle->sensors) {
      if (sensor.T_vehicle_sensor.vector() == T_robot_sensor.vector() && !sensor.name.empty()) return sensor.name;
    }
  }
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "sensor at (%.3g, %.3g) m", T_robot_sensor.x_m, T_robot_sensor.y_m);
  return text.data();
}

std::string views_text(const core::Recording& recording, const logs::Vehicle* vehicle) {
  const std::vector<core::Recording> sensors = apart_by_sensor(recording);
  std::string text;
  for (const core::Recording& sensor : sensors) {
    const auto& scan = std::get<core::Scan>(sensor.events.front());
    const std::string name = sensors.size() > 1 ? ' ' + sensor_name(scan.T_robot_sensor, vehicle) + ':' : "";
    const core::FieldOfView seen = logs::estimate_field_of_view(sensor);
    if (seen.reach()) text += view_text(("view seen  " + name).c_str(), seen);
    text += view_text(("view used  " + name).c_str(), logs::field_of_view_of(sensor));
  }
  return text;
}

std::string truth_text(const core::Recording& recording) {
  std::set<core::Label> labels;
  for (const auto& of_scan : recording.labels) labels.insert(of_scan.begin(), of_scan.end());
  labels.erase(core::no_label);
  return line("truth       %zu poses, %zu positions or fixes, %zu landmarks; %zu identities in the detections",
              recording.true_poses.size(), recording.true_positions.size(), recording.true_landmarks.size(),
              labels.size());
}

}  // namespace

std::string tables_text(const logs::OwnLog& log) {
  if (log.odometry.empty()) return {};
  const double from_s = core::seconds(log.odometry.front().t_ns), to_s = core::seconds(log.odometry.back().t_ns);
  std::string text =
      line("odometry    %zu rows of %s, %.4g a second, %.9g to %.9g s; noise: %s", log.odometry.size(),
           std::string(logs::name_of(log.odometry_kind)).c_str(), rate(log.odometry.size(), to_s - from_s), from_s,
           to_s, log.odometry_covariances.empty() ? "the vehicle's" : "the log's own");
  const auto own = std::count_if(log.detections.begin(), log.detections.end(),
                                 [](const logs::OwnDetection& row) { return row.R[0] > 0.0; });
  text += line("detections  %zu rows, %td with noise of their own", log.detections.size(), own);
  const auto classes = std::count_if(log.detections.begin(), log.detections.end(),
                                     [](const logs::OwnDetection& row) { return !row.class_name.empty(); });
  const auto sizes = std::count_if(log.detections.begin(), log.detections.end(),
                                   [](const logs::OwnDetection& row) { return row.size_m > 0.0; });
  if (classes + sizes > 0) text += line("            %td tell a class, %td a size", classes, sizes);
  if (log.sensor_names.size() > 1) {
    std::string names;
    for (const std::string& name : log.sensor_names) names += (names.empty() ? "" : ", ") + name;
    text += line("sensors     %s", names.c_str());
  }
  if (!log.id_names.empty()) {
    text += line("identities  names, numbered in their order: %s is 0 …", log.id_names.front().c_str());
  }
  return text;
}

bool fixes_no_point(const core::Recording& recording) {
  const ScanCounts counts = count_scans(recording);
  return counts.observations > 0 && counts.of_kind[0] + counts.of_kind[1] == 0;
}

std::string events_text(const core::Recording& recording, const logs::Vehicle* vehicle) {
  const ScanCounts counts = count_scans(recording);
  std::string text = motion_text(recording);
  if (counts.scans == 0) return text;
  text += line("scans       %zu, %.4g a second, %.9g to %.9g s, longest gap %.3g s (from %.9g s)", counts.scans,
               rate(counts.scans, counts.last_s - counts.first_s), counts.first_s, counts.last_s, counts.gap_s,
               counts.gap_from_s);
  text += line("            %.3g detections a scan, %zu scans saw nothing; %s",
               static_cast<double>(counts.observations) / static_cast<double>(counts.scans), counts.empty,
               kinds_text(counts).c_str());
  return text + views_text(recording, vehicle) + truth_text(recording);
}

}  // namespace helixnav::apps

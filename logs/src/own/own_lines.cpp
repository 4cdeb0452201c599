// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/own_lines.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/number_text.hpp"

namespace helixnav::logs {
namespace {

/// One object, member by member.
class Line {
 public:
  explicit Line(std::string& text) : text_(text) { text_ += '{'; }

  Line& add(const char* name, double value) {
    begin(name);
    files::append_number(text_, value);
    return *this;
  }
  Line& add(const char* name, std::int64_t value) {
    begin(name);
    files::append_number(text_, value);
    return *this;
  }
  Line& add(const char* name, std::string_view word) {
    begin(name);
    text_ += '"';
    for (const char letter : word) {
      if (letter == '"' || letter == '\\') text_ += '\\';
      text_ += letter;
    }
    text_ += '"';
    return *this;
  }
  void end() { text_ += '}'; }

 private:
  void begin(const char* name) {
    text_ += text_.back() == '{' ? "\"" : ", \"";
    text_ += name;
    text_ += "\": ";
  }

  std::string& text_;
};

void append(const core::Odometry& odometry, std::string& text) {
  text += "{\"odometry\": ";
  const Eigen::Matrix3d& P = odometry.covariance;
  const core::Pose2& moved = odometry.T_before_after;
  Line(text)
      .add("t_ns", odometry.t_ns)
      .add("dx", moved.x_m)
      .add("dy", moved.y_m)
      .add("dheading", moved.heading_rad)
      .add("cov_xx", P(0, 0))
      .add("cov_xy", P(0, 1))
      .add("cov_xh", P(0, 2))
      .add("cov_yy", P(1, 1))
      .add("cov_yh", P(1, 2))
      .add("cov_hh", P(2, 2))
      .end();
  text += "}\n";
}

void add_measured(const core::Observation& observation, Line& line) {
  const core::ObsVector& z = observation.z;
  const core::ObsMatrix& R = observation.R;
  switch (observation.kind) {
    case core::ObservationKind::range_bearing:
      line.add("range", z[0]).add("bearing", z[1]);
      line.add("sigma_range", std::sqrt(R(0, 0))).add("sigma_bearing", std::sqrt(R(1, 1)));
      return;
    case core::ObservationKind::cartesian:
      line.add("x", z[0]).add("y", z[1]).add("cov_xx", R(0, 0)).add("cov_xy", R(0, 1)).add("cov_yy", R(1, 1));
      return;
    case core::ObservationKind::bearing:
      line.add("bearing", z[0]).add("sigma_bearing", std::sqrt(R(0, 0)));
      return;
    case core::ObservationKind::range:
      line.add("range", z[0]).add("sigma_range", std::sqrt(R(0, 0)));
      return;
  }
}

void append(const core::Scan& scan, const std::vector<core::Label>* labels, std::string& text) {
  text += "{\"detections\": [";
  if (scan.observations.empty()) Line(text).add("t_ns", scan.t_ns).end();
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    if (i > 0) text += ", ";
    Line line(text);
    line.add("t_ns", scan.t_ns);
    add_measured(scan.observations[i], line);
    if (labels != nullptr && (*labels)[i] != core::no_label) line.add("id", std::int64_t{(*labels)[i]});
    const core::Appearance& seen = scan.observations[i].appearance;
    if (!seen.name.empty()) line.add("class", seen.name.text());
    if (seen.size_m > 0.0) line.add("size", seen.size_m).add("sigma_size", seen.sigma_size_m);
    line.end();
  }
  text += "]}\n";
}

/// In the frame in which it was given, so that truths of several logs stay in one frame.
void append_truth(const core::Recording& recording, std::string& text) {
  const core::Pose2 T_truth_map = recording.truth_frame.T_truth_map.value_or(core::Pose2());
  for (const core::TruePose& pose : recording.true_poses) {
    text += "{\"truth_poses\": ";
    const core::Pose2 at = core::compose(T_truth_map, pose.T_world_robot);
    Line(text).add("t_ns", pose.t_ns).add("x", at.x_m).add("y", at.y_m).add("heading", at.heading_rad).end();
    text += "}\n";
  }
  for (const core::TrueLandmark& landmark : recording.true_landmarks) {
    text += "{\"truth_landmarks\": ";
    Line line(text);
    if (landmark.label != core::no_label) line.add("id", std::int64_t{landmark.label});
    const Eigen::Vector2d at_m = core::transform(T_truth_map, landmark.point_m);
    line.add("x", at_m.x()).add("y", at_m.y()).end();
    text += "}\n";
  }
}

void append_key(const char* key, double value, std::string& text) {
  text += key;
  text += " = ";
  files::append_number(text, value);
  text += '\n';
}

const core::Scan* first_scan(const core::Recording& recording) {
  for (const core::Event& event : recording.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) return scan;
  }
  return nullptr;
}

/// From the first class that is given: a sensor has one.
std::optional<double> class_error_of(const core::Recording& recording) {
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (const core::Observation& one : scan->observations) {
      if (!one.appearance.name.empty()) return one.appearance.class_error;
    }
  }
  return std::nullopt;
}

/// A scan at the end of a motion has its time, and a vehicle that was carried is assumed to have been so after a scan
/// of that time.
bool may_share_time(const core::Event& event, const core::Event& before) {
  if (std::holds_alternative<core::Scan>(event)) return std::holds_alternative<core::Odometry>(before);
  return std::holds_alternative<core::Lost>(event);
}

}  // namespace

std::size_t tell_times_apart(core::Recording& recording) {
  std::size_t later = 0;
  std::vector<core::Event>& events = recording.events;
  for (std::size_t i = 1; i < events.size(); ++i) {
    const core::Nanoseconds least_ns =
        core::time_of(events[i - 1]) + (may_share_time(events[i], events[i - 1]) ? 0 : 1);
    if (core::time_of(events[i]) >= least_ns) continue;
    std::visit([&](auto& event) { event.t_ns = least_ns; }, events[i]);
    ++later;
  }
  return later;
}

std::string own_lines(const core::Recording& recording) {
  std::string text;
  std::size_t scans = 0;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) append(*odometry, text);
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      append(*scan, recording.labels.empty() ? nullptr : &recording.labels[scans], text);
      ++scans;
    }
    if (const auto* lost = std::get_if<core::Lost>(&event)) {
      text += "{\"lost\": ";
      Line(text).add("t_ns", lost->t_ns).end();
      text += "}\n";
    }
    if (std::holds_alternative<core::AbsoluteFix>(event))
      throw core::PreconditionError("own_lines: fixes among the events; they go with the truth");
  }
  append_truth(recording, text);
  return text;
}

std::string vehicle_of_lines(const core::Recording& recording) {
  std::string text = "name = \"" + recording.name + "\"\n\n[[sensor]]\n";
  const core::Scan* first = first_scan(recording);
  if (first == nullptr) return text;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr || scan->T_robot_sensor.vector() == first->T_robot_sensor.vector()) continue;
    throw core::InputError(recording.name + ": scans by several sensors, which JSON Lines need names for");
  }
  const core::Pose2& at = first->T_robot_sensor;
  append_key("x_m", at.x_m, text);
  append_key("y_m", at.y_m, text);
  append_key("heading_rad", at.heading_rad, text);
  if (const auto class_error = class_error_of(recording)) append_key("class_error", *class_error, text);
  const core::FieldOfView& view = first->field_of_view;
  const std::optional<double> reach_m = view.reach();
  if (!reach_m) return text;
  append_key("reach_m", *reach_m, text);
  if (std::isfinite(view.max_range_m) && view.max_range_m < *reach_m)
    append_key("reliable_range_m", view.max_range_m, text);
  append_key("min_range_m", view.min_range_m, text);
  text += "view_rad = [";
  files::append_number(text, view.min_bearing_rad);
  text += ", ";
  files::append_number(text, view.max_bearing_rad);
  text += "]\n";
  return text;
}

}  // namespace helixnav::logs

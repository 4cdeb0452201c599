// SPDX-License-Identifier: BSD-3-Clause
#include "live_scans.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "live_motion.hpp"
#include "own/tables/sensor_rows.hpp"
#include "plausible.hpp"

namespace helixnav::logs {

std::string LiveScans::text_of(core::Nanoseconds t_ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", core::seconds(t_ns));
  return text;
}

std::size_t LiveScans::sensor_called(const std::string& name) {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    if (sensors_[i].name == name) return i;
  }
  constexpr std::size_t most = 255;
  if (sensors_.size() == most) throw StreamRefusal("sensor", "more than 255 sensors");
  Sensor sensor;
  sensor.name = name;
  try {
    sensor.model = logs::sensor_called(name, "the stream", vehicle_);
  } catch (const core::InputError& error) {
    throw StreamRefusal("sensor", error.what());
  }
  tell_view(sensor.model, sensor.view);
  sensors_.push_back(std::move(sensor));
  return sensors_.size() - 1;
}

core::Nanoseconds LiveScans::time_of(core::Nanoseconds row_ns, const Sensor& sensor) const {
  return row_ns - core::nanoseconds_from_seconds(sensor.model.delay_s);
}

void LiveScans::check_time(const OwnDetection& row, const Sensor& sensor, core::Nanoseconds woven_ns) const {
  const core::Nanoseconds t_ns = time_of(row.t_ns, sensor);
  if (sensor.answered_ns && row.t_ns == *sensor.answered_ns) {
    throw StreamRefusal("t", "the scan of " + text_of(row.t_ns) +
                                 " s was answered before this line came; detections of one scan belong on one line");
  }
  const bool late = (sensor.answered_ns && row.t_ns < *sensor.answered_ns) || t_ns < woven_ns;
  if (!late) return;
  throw StreamRefusal(
      "t", "late: a scan of " + text_of(t_ns) + " s when everything up to " + text_of(woven_ns) + " s is done");
}

/// [label] of the words of one line.
std::vector<core::Label> LiveScans::labels_of(const std::vector<std::string>& words) {
  std::vector<core::Label> labels;
  for (const std::string& word : words) {
    if (!by_identity_) {
      constexpr std::size_t bits = std::numeric_limits<core::Label>::max();
      labels.push_back(static_cast<core::Label>(std::hash<std::string>{}(word)&bits));
      continue;
    }
    const std::optional<std::int64_t> number = whole_number(word);
    if (!identities_are_numbers_) identities_are_numbers_ = number.has_value();
    if (*identities_are_numbers_ && !number) {
      throw StreamRefusal("id", "the identity '" + word + "' is a name, and the first one was a number");
    }
    labels.push_back(*identities_are_numbers_ ? *number : names_.of(word));
  }
  return labels;
}

std::vector<LiveScans::Seen> LiveScans::check(const OwnLog& log, core::Nanoseconds woven_ns) {
  std::vector<Seen> rows;
  for (const OwnDetection& row : log.detections) {
    Seen& seen = rows.emplace_back();
    seen.sensor = sensor_called(log.sensor_names[row.sensor]);
    seen.row_ns = row.t_ns;
    const Sensor& sensor = sensors_[seen.sensor];
    check_time(row, sensor, woven_ns);
    if (row.kind == OwnDetection::Kind::nothing) continue;
    seen.observation = observation_of(row, sensor.model, vehicle_);
    const LiveScan* scan = waiting_scan(row.t_ns, seen.sensor);
    if (rows.size() + (scan == nullptr ? 0 : scan->labels.size()) > most_observations) {
      throw StreamRefusal("detections", "more than " + std::to_string(most_observations) + " detections in one scan");
    }
  }
  const std::vector<core::Label> label_of = labels_of(log.id_names);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const core::Label label = log.detections[i].label;
    if (label >= 0) rows[i].label = label_of[static_cast<std::size_t>(label)];
  }
  check_is_new(rows);
  return rows;
}

/// A line that adds nothing to scans that still wait was sent twice.
void LiveScans::check_is_new(const std::vector<Seen>& rows) {
  const auto is_known = [this](const Seen& row) {
    const LiveScan* scan = waiting_scan(row.row_ns, row.sensor);
    return scan != nullptr && (!row.observation || holds(*scan, row));
  };
  if (rows.empty() || !std::all_of(rows.begin(), rows.end(), is_known)) return;
  throw StreamRefusal("t", "repeats the detections of " + text_of(rows.front().row_ns) + " s");
}

bool LiveScans::holds(const LiveScan& scan, const Seen& row) {
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    const core::Observation& other = scan.scan.observations[i];
    if (other.kind == row.observation->kind && other.z == row.observation->z && scan.labels[i] == row.label)
      return true;
  }
  return false;
}

LiveScan* LiveScans::waiting_scan(core::Nanoseconds row_ns, std::size_t sensor) {
  for (auto scan = waiting_.rbegin(); scan != waiting_.rend(); ++scan) {
    if (scan->row_ns == row_ns && scan->sensor == sensor) return &*scan;
  }
  return nullptr;
}

LiveScan& LiveScans::begun_scan(const Seen& row, std::size_t line) {
  const Sensor& sensor = sensors_[row.sensor];
  LiveScan scan;
  scan.scan.t_ns = time_of(row.row_ns, sensor);
  scan.scan.T_robot_sensor = sensor.model.T_vehicle_sensor;
  scan.scan.field_of_view = sensor.view;
  scan.row_ns = row.row_ns;
  scan.sensor = row.sensor;
  scan.line = line;
  const auto before = [](const LiveScan& a, const LiveScan& b) { return a.order() < b.order(); };
  const auto place = std::upper_bound(waiting_.begin(), waiting_.end(), scan, before);
  return *waiting_.insert(place, std::move(scan));
}

void LiveScans::add(const std::vector<Seen>& rows, bool whole, std::size_t line) {
  for (LiveScan& scan : waiting_) {
    const auto adds = [&](const Seen& row) { return row.row_ns == scan.row_ns && row.sensor == scan.sensor; };
    if (std::none_of(rows.begin(), rows.end(), adds)) scan.closed = true;
  }
  for (const Seen& row : rows) {
    LiveScan* known = waiting_scan(row.row_ns, row.sensor);
    LiveScan& scan = known != nullptr ? *known : begun_scan(row, line);
    scan.closed = whole;
    if (!row.observation || holds(scan, row)) continue;
    scan.scan.observations.push_back(*row.observation);
    scan.labels.push_back(row.label);
  }
}

void LiveScans::close_all() {
  for (LiveScan& scan : waiting_) scan.closed = true;
}

LiveScan LiveScans::pop() {
  LiveScan scan = std::move(waiting_.front());
  waiting_.pop_front();
  sensors_[scan.sensor].answered_ns = scan.row_ns;
  return scan;
}

}  // namespace helixnav::logs

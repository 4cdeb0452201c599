// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/own_stream.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "json_rows.hpp"
#include "live_motion.hpp"
#include "live_scans.hpp"
#include "own/tables/own_tables.hpp"

namespace helixnav::logs {
namespace {

constexpr core::Nanoseconds nothing_yet_ns = std::numeric_limits<core::Nanoseconds>::min();

bool is_without_rows(const OwnLog& log) {
  return log.odometry.empty() && log.detections.empty() && log.lost_ns.empty() && log.fixes.empty() &&
         log.true_poses.empty() && log.true_positions.empty() && log.true_landmarks.empty();
}

void check_told(const Vehicle& vehicle) {
  if (vehicle.sensors.empty()) throw core::InputError(vehicle.path + ": a stream needs a [[sensor]], found none");
  for (const SensorModel& sensor : vehicle.sensors) {
    const bool reach = sensor.reach_m || sensor.reliable_range_m;
    if (reach && sensor.min_bearing_rad) continue;
    throw core::InputError(vehicle.path + ": a stream needs " + (reach ? "view_deg" : "reach_m") + " in [[sensor]]" +
                           (sensor.name.empty() ? "" : " '" + sensor.name + "'") +
                           ", because it cannot be estimated from a log that is yet to come");
  }
}

/// The quoted key at this position of the line, from 1; empty if none starts there.
std::string key_at(std::string_view line, std::size_t column) {
  if (column == 0 || column > line.size() || line[column - 1] != '"') return {};
  const std::size_t end = line.find('"', column);
  return end == std::string_view::npos ? std::string() : std::string(line.substr(column, end - column));
}

/// A list is a whole scan: of one time per sensor.
void check_is_one_scan(const std::vector<OwnDetection>& rows) {
  std::map<std::size_t, core::Nanoseconds> time_of;  // [sensor]
  for (const OwnDetection& row : rows) {
    const core::Nanoseconds first_ns = time_of.emplace(row.sensor, row.t_ns).first->second;
    if (first_ns == row.t_ns) continue;
    throw StreamRefusal("t", "a list is a whole scan, and this one has detections of " + LiveScans::text_of(first_ns) +
                                 " s and of " + LiveScans::text_of(row.t_ns) + " s; give each scan a line");
  }
}

}  // namespace

struct OwnStream::State {
  State(const Vehicle& given, bool by_identity)
      : vehicle(given),
        motion(vehicle, late_s),
        scans(vehicle, by_identity),
        by_name(by_identity),
        rows(std::make_unique<JsonRows>("stream")) {}

  void read(std::string_view line, std::size_t number);
  void refuse(std::size_t line, std::string key, std::string why) {
    out.refused.push_back({line, std::move(key), std::move(why)});
  }
  void check_times(const OwnLog& log);
  void tell_unnamed_sensor(const std::string& name);
  void check_jump(core::Nanoseconds t_ns);
  void check_lost(const std::vector<core::Nanoseconds>& rows_ns) const;
  void weave_lost(core::Nanoseconds before_ns);
  void remark_once(const std::string& text);
  void weave(bool at_end);

  Vehicle vehicle;
  LiveMotion motion;
  LiveScans scans;
  bool by_name;
  std::vector<core::Nanoseconds> lost_ns;  ///< ascending; for the first scan after each
  std::unique_ptr<JsonRows> rows;
  OwnTables tables{true};
  core::Nanoseconds newest_ns = nothing_yet_ns;
  core::Nanoseconds jumped_ns = nothing_yet_ns;  ///< an event that was refused because it was too far ahead
  std::vector<std::string> said;
  StreamedEvents out;
};

void OwnStream::State::remark_once(const std::string& text) {
  constexpr std::size_t most = 50;
  if (said.size() >= most || std::find(said.begin(), said.end(), text) != said.end()) return;
  said.push_back(text);
  out.remarks.push_back(text);
}

/// One wrong stamp must not make everything after it late.
void OwnStream::State::check_jump(core::Nanoseconds t_ns) {
  constexpr core::Nanoseconds hour_ns = 3'600'000'000'000;
  if (newest_ns != nothing_yet_ns && t_ns > newest_ns + hour_ns) {
    const bool again = jumped_ns != nothing_yet_ns && std::abs(t_ns - jumped_ns) < hour_ns;
    if (!again) {
      jumped_ns = t_ns;
      throw StreamRefusal("t", "the time is " + LiveScans::text_of(t_ns - newest_ns) +
                                   " s ahead of the newest; it is believed when the next one is there, too");
    }
  }
  jumped_ns = nothing_yet_ns;
  newest_ns = std::max(newest_ns, t_ns);
}

/// Whatever a sensor is called, it is taken for the only one if that has no name.
void OwnStream::State::tell_unnamed_sensor(const std::string& name) {
  if (name.empty() || vehicle.sensors.size() != 1 || !vehicle.sensors.front().name.empty()) return;
  remark_once("stream: sensor '" + name + "' is taken for the only [[sensor]], which has no name");
}

void OwnStream::State::check_times(const OwnLog& log) {
  core::Nanoseconds latest_ns = nothing_yet_ns;
  for (const OwnOdometry& row : log.odometry) latest_ns = std::max(latest_ns, row.t_ns);
  for (const OwnDetection& row : log.detections) latest_ns = std::max(latest_ns, row.t_ns);
  for (const core::Nanoseconds row_ns : log.lost_ns) latest_ns = std::max(latest_ns, row_ns);
  if (latest_ns != nothing_yet_ns) check_jump(latest_ns);
}

void OwnStream::State::read(std::string_view line, std::size_t number) {
  try {
    rows->read(line, number, tables);
    const OwnLog log = tables.take_rows();
    for (const std::string& remark : log.remarks) remark_once(remark);
    if (!log.fixes.empty() || !log.true_poses.empty() || !log.true_positions.empty() || !log.true_landmarks.empty()) {
      remark_once("stream: fixes and truth are not used; replay compares with them");
    }
    if (is_without_rows(log)) {
      throw StreamRefusal("", "holds no row; a scan that saw nothing is a time alone, {\"detections\": {\"t\": 1.5}}");
    }
    if (rows->last_was_list()) check_is_one_scan(log.detections);
    for (const std::string& name : log.sensor_names) tell_unnamed_sensor(name);
    check_times(log);
    motion.check(log);
    check_lost(log.lost_ns);
    const std::vector<LiveScans::Seen> seen = scans.check(log, motion.woven_ns());
    motion.add(log);
    scans.add(seen, rows->last_was_list(), number);
    lost_ns.insert(lost_ns.end(), log.lost_ns.begin(), log.lost_ns.end());
    std::sort(lost_ns.begin(), lost_ns.end());
    return;
  } catch (const PlacedInputError& error) {
    refuse(number, key_at(line, error.column()), error.message());
  } catch (const StreamRefusal& refusal) {
    refuse(number, refusal.key(), refusal.what());
  } catch (const core::InputError& error) {
    refuse(number, "", error.what());
  }
  // A refused line leaves nothing behind: no rows, no kind of odometry, no columns.
  tables = OwnTables(true);
  rows = std::make_unique<JsonRows>("stream");
}

void OwnStream::State::check_lost(const std::vector<core::Nanoseconds>& rows_ns) const {
  for (const core::Nanoseconds row_ns : rows_ns) {
    if (by_name) throw StreamRefusal("lost", "a vehicle that was carried is not found again by identities");
    if (row_ns >= motion.woven_ns() && lost_ns.size() < most_waiting) continue;
    throw StreamRefusal("t", "the time " + LiveScans::text_of(row_ns) + " s lies before a scan that was answered");
  }
}

/// The vehicle was carried before a scan of that time.
void OwnStream::State::weave_lost(core::Nanoseconds before_ns) {
  auto lost = lost_ns.begin();
  for (; lost != lost_ns.end() && *lost < before_ns; ++lost) {
    motion.weave_to(*lost, out.recording.events);
    out.recording.events.emplace_back(core::Lost{*lost});
  }
  lost_ns.erase(lost_ns.begin(), lost);
}

void OwnStream::State::weave(bool at_end) {
  if (at_end) {
    scans.close_all();
    if (!scans.empty()) motion.end_at(scans.last_ns());
  }
  std::vector<core::Event>& events = out.recording.events;
  while (scans.first_is_closed() && (at_end || motion.covers(scans.first_ns()))) {
    LiveScan scan = scans.pop();
    if (at_end && !motion.tells(scan.scan.t_ns)) {
      refuse(scan.line, "t",
             "the odometry ended before the time of this scan, " + LiveScans::text_of(scan.scan.t_ns) + " s");
      continue;
    }
    weave_lost(scan.scan.t_ns);
    motion.weave_to(scan.scan.t_ns, events);
    events.emplace_back(std::move(scan.scan));
    out.recording.labels.push_back(std::move(scan.labels));
    out.lines.push_back(scan.line);
  }
  core::Nanoseconds next_ns = scans.empty() ? nothing_yet_ns : scans.first_ns();
  if (!lost_ns.empty()) next_ns = scans.empty() ? lost_ns.front() : std::min(next_ns, lost_ns.front());
  motion.weave_old(next_ns);
  while (scans.size() > most_waiting) {
    const LiveScan scan = scans.pop();
    refuse(scan.line, "t",
           "no odometry has reached the time of this scan, " + LiveScans::text_of(scan.scan.t_ns) +
               " s; are both of the same clock?");
  }
}

OwnStream::OwnStream(const Vehicle& vehicle, bool by_identity) {
  check_told(vehicle);
  state_ = std::make_unique<State>(vehicle, by_identity);
}

OwnStream::~OwnStream() = default;

StreamedEvents OwnStream::take(std::string_view line, std::size_t number) {
  state_->out = StreamedEvents();
  state_->out.recording.extraneous_per_scan = 0.0;
  if (line.find_first_not_of(" \t") == std::string_view::npos) return std::move(state_->out);
  if (line.size() > longest_line) {
    state_->refuse(number, "", "a line longer than 1 MiB");
    return std::move(state_->out);
  }
  state_->read(line, number);
  state_->weave(false);
  return std::move(state_->out);
}

StreamedEvents OwnStream::finish() {
  state_->out = StreamedEvents();
  state_->out.recording.extraneous_per_scan = 0.0;
  state_->weave(true);
  return std::move(state_->out);
}

}  // namespace helixnav::logs

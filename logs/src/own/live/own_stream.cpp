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

/// Rows that a stream has no use for.
bool tells_more(const OwnLog& log) {
  return !log.fixes.empty() || !log.true_poses.empty() || !log.true_positions.empty() || !log.true_landmarks.empty();
}

core::Nanoseconds latest_of(const OwnLog& log) {
  core::Nanoseconds latest_ns = nothing_yet_ns;
  for (const OwnOdometry& row : log.odometry) latest_ns = std::max(latest_ns, row.t_ns);
  for (const OwnDetection& row : log.detections) latest_ns = std::max(latest_ns, row.t_ns);
  for (const core::Nanoseconds row_ns : log.lost_ns) latest_ns = std::max(latest_ns, row_ns);
  return latest_ns;
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
        longest_ns(longest_delay_ns(given)),
        motion(vehicle, late_s),
        scans(vehicle, by_identity),
        by_name(by_identity),
        rows(std::make_unique<JsonRows>("stream")) {}

  /// A line that could be read.
  struct Read {
    OwnLog log;
    bool is_list = false;
    std::size_t number = 0;
    core::Nanoseconds latest_ns = nothing_yet_ns;
  };
  std::optional<Read> read(std::string_view line, std::size_t number);
  void take(Read read);
  void use(const Read& read);
  core::Nanoseconds far_ahead_ns() const;
  void refuse_held();
  void forget_columns();
  void refuse(std::size_t line, std::string key, std::string why) {
    out.refused.push_back({line, std::move(key), std::move(why)});
  }
  void tell_unnamed_sensor(const std::string& name);
  void check_lost(const std::vector<core::Nanoseconds>& rows_ns) const;
  void weave_lost(core::Nanoseconds before_ns);
  void remark_once(const std::string& text);
  bool is_due(core::Nanoseconds t_ns) const;
  void weave(bool at_end);

  Vehicle vehicle;
  core::Nanoseconds longest_ns;  ///< that a scan may come after others taken with it
  LiveMotion motion;
  LiveScans scans;
  bool by_name;
  std::vector<core::Nanoseconds> lost_ns;  ///< ascending; for the first scan after each
  std::unique_ptr<JsonRows> rows;
  OwnTables tables{true};
  core::Nanoseconds newest_ns = nothing_yet_ns;
  core::Nanoseconds advanced_ns = 0;  ///< from line to line, without those that were far ahead
  std::size_t lines_used = 0;
  std::optional<Read> held;  ///< too far ahead to be believed before the next line is there, too
  std::vector<std::string> said;
  StreamedEvents out;
};

void OwnStream::State::remark_once(const std::string& text) {
  constexpr std::size_t most = 50;
  if (said.size() >= most || std::find(said.begin(), said.end(), text) != said.end()) return;
  said.push_back(text);
  out.remarks.push_back(text);
}

/// Whatever a sensor is called, it is taken for the only one if that has no name.
void OwnStream::State::tell_unnamed_sensor(const std::string& name) {
  if (name.empty() || vehicle.sensors.size() != 1 || !vehicle.sensors.front().name.empty()) return;
  remark_once("stream: sensor '" + name + "' is taken for the only [[sensor]], which has no name");
}

void OwnStream::State::forget_columns() {
  tables = OwnTables(true);
  rows = std::make_unique<JsonRows>("stream");
}

/// A refused line leaves nothing behind: no rows, no kind of odometry, no columns.
std::optional<OwnStream::State::Read> OwnStream::State::read(std::string_view line, std::size_t number) {
  try {
    rows->read(line, number, tables);
    Read read{tables.take_rows(), rows->last_was_list(), number, nothing_yet_ns};
    for (const std::string& remark : read.log.remarks) remark_once(remark);
    if (tells_more(read.log)) remark_once("stream: fixes and truth are not used; replay compares with them");
    if (is_without_rows(read.log)) {
      throw StreamRefusal("", "holds no row; a scan that saw nothing is a time alone, {\"detections\": {\"t\": 1.5}}");
    }
    if (read.is_list) check_is_one_scan(read.log.detections);
    for (const std::string& name : read.log.sensor_names) tell_unnamed_sensor(name);
    read.latest_ns = latest_of(read.log);
    return read;
  } catch (const PlacedInputError& error) {
    refuse(number, key_at(line, error.column()), error.message());
  } catch (const StreamRefusal& refusal) {
    refuse(number, refusal.key(), refusal.what());
  } catch (const core::InputError& error) {
    refuse(number, "", error.what());
  }
  forget_columns();
  return std::nullopt;
}

void OwnStream::State::refuse_held() {
  if (!held) return;
  refuse(held->number, "t",
         "the time is " + LiveScans::text_of(held->latest_ns - newest_ns) +
             " s ahead of the newest, and no line after it is there, too");
  held.reset();
  forget_columns();
}

/// Ten seconds, and a hundred mean intervals of the lines so far; an hour before these are known.
core::Nanoseconds OwnStream::State::far_ahead_ns() const {
  constexpr std::size_t enough = 20;
  constexpr core::Nanoseconds hour_ns = 3'600'000'000'000, least_ns = 10'000'000'000, intervals = 100;
  if (lines_used < enough) return hour_ns;
  return std::max(least_ns, intervals * (advanced_ns / static_cast<core::Nanoseconds>(lines_used)));
}

/// One wrong stamp must not make everything after it late: a line far ahead waits until the next one is there, too.
void OwnStream::State::take(Read read) {
  if (read.latest_ns == nothing_yet_ns) return use(read);  // fixes and truth
  const core::Nanoseconds far_ns = far_ahead_ns();
  if (held && std::abs(read.latest_ns - held->latest_ns) < far_ns) {
    use(*held);
    held.reset();
  }
  refuse_held();
  if (newest_ns != nothing_yet_ns && read.latest_ns > newest_ns + far_ns) {
    held = std::move(read);
    return;
  }
  if (newest_ns != nothing_yet_ns) advanced_ns += std::max<core::Nanoseconds>(0, read.latest_ns - newest_ns);
  use(read);
}

void OwnStream::State::use(const Read& read) {
  ++lines_used;
  newest_ns = std::max(newest_ns, read.latest_ns);
  try {
    motion.check(read.log);
    check_lost(read.log.lost_ns);
    const std::vector<LiveScans::Seen> seen = scans.check(read.log, motion.woven_ns());
    motion.add(read.log);
    scans.add(seen, read.is_list, read.number);
    lost_ns.insert(lost_ns.end(), read.log.lost_ns.begin(), read.log.lost_ns.end());
    std::sort(lost_ns.begin(), lost_ns.end());
    return;
  } catch (const StreamRefusal& refusal) {
    refuse(read.number, refusal.key(), refusal.what());
  } catch (const core::InputError& error) {
    refuse(read.number, "", error.what());
  }
  forget_columns();
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

/// Once odometry has reached the scan, and no earlier one can come any more: a scan of the sensor with the longest delay comes that
/// long after others that were taken with it.
bool OwnStream::State::is_due(core::Nanoseconds t_ns) const {
  return motion.covers(t_ns) && newest_ns >= t_ns + longest_ns;
}

void OwnStream::State::weave(bool at_end) {
  if (at_end) {
    scans.close_all();
    if (!scans.empty()) motion.end_at(scans.last_ns());
  }
  std::vector<core::Event>& events = out.recording.events;
  while (scans.first_is_closed() && (at_end || is_due(scans.first_ns()))) {
    LiveScan scan = scans.pop();
    if (at_end && !motion.tells(scan.scan.t_ns)) {
      const std::string t_s = LiveScans::text_of(scan.scan.t_ns) + " s";
      refuse(scan.line, "t",
             motion.has_begun() ? "the odometry ended before the time of this scan, " + t_s
                                : "no line of odometry has come: nobody knows where this scan was taken, " + t_s);
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
  if (auto read = state_->read(line, number)) state_->take(std::move(*read));
  state_->weave(false);
  return std::move(state_->out);
}

StreamedEvents OwnStream::finish() {
  state_->out = StreamedEvents();
  state_->out.recording.extraneous_per_scan = 0.0;
  state_->refuse_held();
  state_->weave(true);
  return std::move(state_->out);
}

}  // namespace helixnav::logs

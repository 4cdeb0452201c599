// SPDX-License-Identifier: BSD-3-Clause
#include "own_doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/in_view.hpp"
#include "helixnav/logs/handedness.hpp"
#include "own/own_overlap.hpp"
#include "own/vehicle/units.hpp"

namespace helixnav::logs {
namespace {

using Doubts = std::vector<std::string>;

template <class... Values>
std::string sentence(const char* format, Values... values) {
  std::array<char, 320> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

double value_at(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<double> intervals_s(const OwnLog& log) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < log.odometry.size(); ++i) {
    intervals.push_back(core::seconds(log.odometry[i].t_ns - log.odometry[i - 1].t_ns));
  }
  return intervals;
}

/// How far the vehicle moved between the previous row and this one, according to the rows; 0 if that needs its
/// geometry.
double length_m(const OwnLog& log, std::size_t row) {
  const Eigen::Vector3d& value = log.odometry[row].value;
  if (log.odometry_kind == OdometryKind::increments) return value.head<2>().norm();
  if (log.odometry_kind == OdometryKind::poses) return (value - log.odometry[row - 1].value).head<2>().norm();
  if (log.odometry_kind != OdometryKind::velocities) return 0.0;
  const core::Nanoseconds before_ns = log.odometry[row - 1].t_ns;
  return log.odometry[row - 1].value.head<2>().norm() * core::seconds(log.odometry[row].t_ns - before_ns);
}

/// The increment after a gap covers no more than those beside it do, in a much longer time: the rows between are missing,
/// and the motion in them.
bool doubt_missing_rows(const OwnLog& log, std::size_t before, double gap_s, Doubts& doubts) {
  constexpr double much = 0.3;
  if (log.odometry_kind != OdometryKind::increments || before == 0 || before + 2 >= log.odometry.size()) return false;
  const auto speed_mps = [&](std::size_t row) {
    const double duration_s = core::seconds(log.odometry[row].t_ns - log.odometry[row - 1].t_ns);
    return duration_s > 0.0 ? length_m(log, row) / duration_s : 0.0;
  };
  const double beside_mps = std::min(speed_mps(before), speed_mps(before + 2));
  if (!(speed_mps(before + 1) < much * beside_mps)) return false;
  doubts.push_back(sentence(
      "odometry: rows are missing from %.9g s on for %.4g s: the vehicle moves %.3g m in that time, and %.3g "
      "m/s before and after. The path breaks there; if the vehicle did drive, the motion is lost (event lost says so)",
      core::seconds(log.odometry[before].t_ns), gap_s, length_m(log, before + 1), beside_mps));
  return true;
}

void doubt_times(const OwnLog& log, Doubts& doubts) {
  std::vector<double> intervals = intervals_s(log);
  if (intervals.empty()) return;
  const double median_s = value_at(intervals, 0.5);
  if (median_s > 5.0) {
    doubts.push_back(
        sentence("odometry: a row every %.4g s; if its times are in milliseconds, call the column t_ms", median_s));
  } else if (median_s < 1e-4) {
    doubts.push_back(sentence("odometry: a row every %.4g s; are its times in seconds?", median_s));
  }
  const double long_s = std::max(1.0, 10.0 * median_s);
  std::size_t count = 0, longest = 0;
  intervals = intervals_s(log);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    count += intervals[i] > long_s ? 1 : 0;
    if (intervals[i] > intervals[longest]) longest = i;
  }
  if (count == 0) return;
  if (doubt_missing_rows(log, longest, intervals[longest], doubts)) return;
  const bool held = log.odometry_kind != OdometryKind::increments && log.odometry_kind != OdometryKind::poses;
  doubts.push_back(sentence("odometry: %zu %s longer than %.3g s, the longest %.4g s from %.9g s on; %s", count,
                            count == 1 ? "gap" : "gaps", long_s, intervals[longest],
                            core::seconds(log.odometry[longest].t_ns),
                            held ? "the row before a gap is held through it, as uncertain as its changes so far"
                                 : "motion in it is spread evenly"));
}

/// Of the motion that was made.
void doubt_speeds(const core::Recording& recording, Doubts& doubts) {
  std::vector<double> speeds_mps;
  core::Nanoseconds last_ns = recording.events.empty() ? 0 : core::time_of(recording.events.front());
  for (const core::Event& event : recording.events) {
    const auto* odometry = std::get_if<core::Odometry>(&event);
    if (odometry != nullptr && odometry->t_ns > last_ns) {
      const double duration_s = core::seconds(odometry->t_ns - last_ns);
      speeds_mps.push_back(odometry->T_before_after.position_m().norm() / duration_s);
    }
    last_ns = std::max(last_ns, core::time_of(event));
  }
  if (speeds_mps.empty()) return;
  const double speed_mps = value_at(speeds_mps, 0.95);
  if (speed_mps > 70.0) doubts.push_back(sentence("odometry: speeds of %.4g m/s; what unit is it in?", speed_mps));
  if (*std::max_element(speeds_mps.begin(), speeds_mps.end()) == 0.0) {
    doubts.emplace_back("odometry: the vehicle never moves");
  }
}

/// A row that exceeds what the log itself drives: a wrong digit, or a vehicle that was moved elsewhere.
void doubt_jumps(const OwnLog& log, Doubts& doubts) {
  constexpr std::size_t least_rows = 20;
  constexpr double beyond = 10.0, least_m = 1.0;
  std::vector<double> speeds_mps;
  for (std::size_t i = 1; i < log.odometry.size(); ++i) {
    const double duration_s = core::seconds(log.odometry[i].t_ns - log.odometry[i - 1].t_ns);
    speeds_mps.push_back(duration_s > 0.0 ? length_m(log, i) / duration_s : 0.0);
  }
  if (speeds_mps.size() < least_rows) return;
  std::vector<double> sorted = speeds_mps;
  const auto most = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sorted.size() - 1));  // never the fastest
  std::nth_element(sorted.begin(), sorted.begin() + most, sorted.end());
  const double usual_mps = sorted[static_cast<std::size_t>(most)];
  const auto is_jump = [&](std::size_t i) {
    return usual_mps > 0.0 && speeds_mps[i] > beyond * usual_mps && length_m(log, i + 1) > least_m;
  };
  std::size_t count = 0, farthest = 0;
  for (std::size_t i = 0; i < speeds_mps.size(); ++i) {
    if (!is_jump(i)) continue;
    if (count++ == 0 || speeds_mps[i] > speeds_mps[farthest]) farthest = i;
  }
  if (count == 0) return;
  doubts.push_back(sentence(
      "odometry: %zu %s faster than ten times what 99 %% of them are (%.3g m/s); at %.9g s the vehicle moves %.4g m at "
      "%.4g m/s",
      count, count == 1 ? "row is" : "rows are", usual_mps, core::seconds(log.odometry[farthest + 1].t_ns),
      length_m(log, farthest + 1), speeds_mps[farthest]));
}

/// The turn that a row reports, relative to the one before it: an angle, or a rate.
double turn_of(const OwnLog& log, std::size_t row) {
  const Eigen::Vector3d& value = log.odometry[row].value;
  if (log.odometry_kind == OdometryKind::increments || log.odometry_kind == OdometryKind::velocities) return value.z();
  if (log.odometry_kind != OdometryKind::poses || row == 0) return 0.0;
  return core::wrap_to_pi(value.z() - log.odometry[row - 1].value.z());
}

void doubt_turns(const OwnLog& log, Doubts& doubts) {
  const bool rate = log.odometry_kind == OdometryKind::velocities;
  const double most = rate ? 6.0 : 1.0;
  std::size_t large = 0;
  for (std::size_t i = 0; i < log.odometry.size(); ++i) large += std::abs(turn_of(log, i)) > most ? 1 : 0;
  if (large * 50 <= log.odometry.size()) return;
  doubts.push_back(
      sentence("odometry: %zu of %zu rows turn by more than %g %s; are the headings in degrees? Then end the name "
               "of the column in %s",
               large, log.odometry.size(), most, rate ? "rad/s" : "rad", rate ? "_degps" : "_deg"));
}

void doubt_bearings(const OwnLog& log, Doubts& doubts) {
  double most_rad = 0.0;
  std::size_t count = 0;
  for (const OwnDetection& row : log.detections) {
    if (row.kind != OwnDetection::Kind::range_bearing && row.kind != OwnDetection::Kind::bearing) continue;
    most_rad = std::max(most_rad, std::abs(row.z[row.kind == OwnDetection::Kind::bearing ? 0 : 1]));
    ++count;
  }
  if (count > 100 && most_rad < 2.0 * core::pi * rad_per_deg) {
    doubts.push_back(sentence("detections: all %zu bearings lie within ±%.3g degrees; are they in radians?", count,
                              most_rad / rad_per_deg));
  }
}

/// Noise that a driver computes from what it measured: of many looks at one landmark the short ones get more weight, and their
/// weighted mean is too short by twice the square of the share.
void doubt_relative_noise(const OwnLog& log, Doubts& doubts) {
  constexpr double alike = 0.02, least_share = 0.03;
  constexpr std::size_t many = 100;
  std::vector<double> shares;
  for (const OwnDetection& row : log.detections) {
    const bool given = row.kind == OwnDetection::Kind::range_bearing && row.R[0] > 0.0 && row.z[0] > 0.0;
    if (given) shares.push_back(std::sqrt(row.R[0]) / row.z[0]);
  }
  if (shares.size() < many) return;
  const double share = value_at(shares, 0.5);
  if (share < least_share) return;
  if (value_at(shares, 0.05) < (1.0 - alike) * share || value_at(shares, 0.95) > (1.0 + alike) * share) return;
  doubts.push_back(sentence(
      "detections: sigma_range is %.2g %% of the measured range: short measurements count more than long ones, and "
      "ranges come out some %.2g %% too short; compute it from an expected range, or state one sigma_range_m",
      100.0 * share, 200.0 * share * share));
}

void doubt_few_detections(const OwnLog& log, Doubts& doubts) {
  const auto count = std::count_if(log.detections.begin(), log.detections.end(),
                                   [](const OwnDetection& row) { return row.kind != OwnDetection::Kind::nothing; });
  const bool one_scan = !log.detections.empty() && log.detections.front().t_ns == log.detections.back().t_ns;
  if (count >= 2 && one_scan) {
    doubts.emplace_back("detections: all are of one time; there is nothing to be seen again in them");
  }
  if (count >= 2) return;
  doubts.push_back(sentence("detections: %td in all of the log; there is nothing to be seen again in it", count));
}

/// 0 for a bearing alone.
double range_of(const core::Observation& z) {
  if (z.kind == core::ObservationKind::bearing) return 0.0;
  return z.kind == core::ObservationKind::cartesian ? z.z.norm() : z.z[0];
}

struct Seen {
  std::size_t count = 0;
  double farthest_m = 0.0;
};

/// All lengths of the navigator follow from the reach. Among many detections the farthest comes close to it if the
/// sensor is what limits them; a few may all be near by chance.
void doubt_reach(const Vehicle& vehicle, const core::Recording& recording, Doubts& doubts) {
  constexpr double beyond = 3.0, beyond_few = 10.0;
  constexpr std::size_t many = 200;
  std::map<double, Seen> seen_up_to;  // [reach]
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr || !scan->field_of_view.reach()) continue;
    Seen& seen = seen_up_to[*scan->field_of_view.reach()];
    for (const core::Observation& z : scan->observations) seen.farthest_m = std::max(seen.farthest_m, range_of(z));
    seen.count += scan->observations.size();
  }
  for (const SensorModel& sensor : vehicle.sensors) {
    const auto found = sensor.reach_m ? seen_up_to.find(*sensor.reach_m) : seen_up_to.end();
    if (found == seen_up_to.end()) continue;
    const auto& [reach_m, seen] = *found;
    const double factor = seen.count >= many ? beyond : beyond_few;
    if (!(seen.farthest_m > 0.0) || reach_m <= factor * seen.farthest_m) continue;
    doubts.push_back(sentence(
        "%s: a reach of %.4g m, and the farthest of %zu detections is at %.4g m; is it in metres, and of this sensor?",
        vehicle.path.c_str(), reach_m, seen.count, seen.farthest_m));
  }
}

/// What vehicle.toml states of a view; the rest is estimated, and some detections lie outside of that.
struct Stated {
  bool reach = false;
  bool bearings = false;
};

Stated stated_by(const Vehicle& vehicle, const core::FieldOfView& view) {
  const auto any = [&](auto has) { return std::any_of(vehicle.sensors.begin(), vehicle.sensors.end(), has); };
  return {any([&](const SensorModel& sensor) { return sensor.reach_m && view.reach() == sensor.reach_m; }),
          any([&](const SensorModel& sensor) { return sensor.min_bearing_rad == view.min_bearing_rad; })};
}

bool is_outside(const core::Observation& z, const core::FieldOfView& view, const Stated& stated) {
  const bool polar = z.kind == core::ObservationKind::range_bearing, point = z.kind == core::ObservationKind::cartesian;
  constexpr double slack = 1.05, slack_rad = 0.05;
  const double range_m = polar || z.kind == core::ObservationKind::range ? z.z[0] : point ? z.z.norm() : 0.0;
  if (stated.reach && view.reach() && range_m > slack * *view.reach()) return true;
  if (!stated.bearings || z.kind == core::ObservationKind::range) return false;
  const double bearing_rad = point ? std::atan2(z.z[1], z.z[0]) : core::wrap_to_pi(z.z[polar ? 1 : 0]);
  return !core::is_between_bearings(view, bearing_rad, -slack_rad);
}

void doubt_vehicle(const Vehicle& vehicle, const core::Recording& recording, Doubts& doubts) {
  std::size_t seen = 0, outside = 0;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    const Stated stated = stated_by(vehicle, scan->field_of_view);
    for (const core::Observation& observation : scan->observations) {
      ++seen;
      outside += is_outside(observation, scan->field_of_view, stated) ? 1 : 0;
    }
  }
  if (outside * 20 > seen) {
    doubts.push_back(sentence(
        "%zu of %zu detections (%.0f %%) lie outside the reach and view that %s states; is it the vehicle "
        "of this log?",
        outside, seen, 100.0 * static_cast<double>(outside) / static_cast<double>(seen), vehicle.path.c_str()));
  }
}

}  // namespace

Doubts doubts_of(const OwnLog& log, const Vehicle& vehicle, const core::Recording& recording) {
  Doubts doubts;
  doubt_times(log, doubts);
  doubt_speeds(recording, doubts);
  doubt_jumps(log, doubts);
  doubt_turns(log, doubts);
  doubt_bearings(log, doubts);
  doubt_relative_noise(log, doubts);
  doubt_few_detections(log, doubts);
  doubt_overlap(log, recording, doubts);
  if (std::optional<std::string> doubt = doubt_handedness(recording)) doubts.push_back(std::move(*doubt));
  doubt_reach(vehicle, recording, doubts);
  doubt_vehicle(vehicle, recording, doubts);
  return doubts;
}

}  // namespace helixnav::logs

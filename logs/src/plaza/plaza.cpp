// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/plaza.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "helixnav/core/errors.hpp"
#include "input_files.hpp"
#include "plausible.hpp"
#include "reading_times.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

constexpr std::string_view odometry_ending = "_odometry.csv";

struct Increment {
  core::Nanoseconds t_ns;  ///< its end
  double distance_m;
  double turn_rad;
};

struct Range {
  core::Nanoseconds t_ns;
  core::Label beacon;
  double range_m;
};

/// The run's path up to but not including "_odometry.csv".
std::string run_prefix(const std::filesystem::path& folder_or_odometry) {
  std::string found = folder_or_odometry.string();
  if (std::filesystem::is_directory(folder_or_odometry)) {
    found.clear();
    for (const auto& entry : std::filesystem::directory_iterator(folder_or_odometry)) {
      if (ends_with(entry.path().string(), odometry_ending)) {
        if (!found.empty()) {
          throw core::InputError(folder_or_odometry.string() +
                                 ": expected one …_odometry.csv, found several: name one");
        }
        found = entry.path().string();
      }
    }
  }
  if (!ends_with(found, odometry_ending)) {
    throw core::InputError(folder_or_odometry.string() + ": expected a folder with a …_odometry.csv, or that file");
  }
  return found.substr(0, found.size() - odometry_ending.size());
}

/// Reads a comma-separated file.
template <class ReadRow>
void for_each_row(const std::string& path, std::string_view columns, const ReadRow& read_row) {
  const std::string text = read_file(path);
  TextCursor cursor(text, path, ',');
  for_each_row(cursor, columns, read_row);
}

std::vector<Increment> read_increments(const std::string& path) {
  std::vector<Increment> increments;
  ReadingTimes times;
  for_each_row(path, "time, distance, turn", [&](TextCursor& cursor) {
    Increment& increment = increments.emplace_back();
    increment.t_ns = times.next(cursor);
    increment.distance_m = cursor.number_between(-most_motion_m, most_motion_m, "a distance [m]");
    increment.turn_rad = cursor.number_between(-most_turn_rad, most_turn_rad, "a turn [rad]");
  });
  if (increments.empty()) {
    throw core::InputError(path + ": expected at least one row of time, distance, turn, found none");
  }
  return increments;
}

std::vector<Range> read_ranges(const std::string& path) {
  std::vector<Range> ranges;
  for_each_row(path, "time, antenna, beacon, range", [&](TextCursor& cursor) {
    Range& range = ranges.emplace_back();
    range.t_ns = ReadingTimes().next(cursor);
    cursor.integer("the number of an antenna");
    range.beacon = static_cast<core::Label>(cursor.number_between(0, 1e9, "the number of a beacon"));
    range.range_m = cursor.number_between(0.0, most_distance_m, "a range [m]");
  });
  std::stable_sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.t_ns < b.t_ns; });
  return ranges;
}

std::vector<core::TruePosition> read_true_positions(const std::string& path) {
  std::vector<core::TruePosition> positions;
  ReadingTimes times;
  for_each_row(path, "time, x, y, heading", [&](TextCursor& cursor) {
    core::TruePosition& position = positions.emplace_back();
    position.t_ns = times.next(cursor);
    position.position_m.x() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "x [m]");
    position.position_m.y() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "y [m]");
    cursor.number("a heading [rad]");
  });
  return positions;
}

std::vector<core::TrueLandmark> read_true_beacons(const std::string& path) {
  std::vector<core::TrueLandmark> beacons;
  for_each_row(path, "beacon, x, y", [&](TextCursor& cursor) {
    core::TrueLandmark& beacon = beacons.emplace_back();
    beacon.label = read_name(cursor, "the number of a beacon");
    beacon.point_m.x() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "x [m]");
    beacon.point_m.y() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "y [m]");
  });
  return beacons;
}

/// The part `share` in (0, 1] of an increment, on an arc, its variances in the same proportion.
core::Odometry part_of(const Increment& increment, double share, core::Nanoseconds t_ns,
                       const PlazaSettings& settings) {
  const double distance_m = share * increment.distance_m;
  const double half_turn_rad = share * increment.turn_rad / 2.0;
  const double chord_m = half_turn_rad == 0.0 ? distance_m : distance_m * std::sin(half_turn_rad) / half_turn_rad;
  core::Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after =
      core::Pose2(chord_m * std::cos(half_turn_rad), chord_m * std::sin(half_turn_rad), 2.0 * half_turn_rad);
  const Eigen::Vector3d sigmas(settings.sigma_distance_m_per_sqrt_m, settings.sigma_sideways_m_per_sqrt_m,
                               settings.sigma_heading_rad_per_sqrt_m);
  odometry.covariance = (std::abs(distance_m) * sigmas.cwiseAbs2()).asDiagonal();
  return odometry;
}

core::Scan scan_of(const Range& range, const PlazaSettings& settings) {
  core::Scan scan;
  scan.t_ns = range.t_ns;
  constexpr double smallest_m = 0.01;
  const double range_m = std::max(smallest_m, range.range_m / settings.range_scale);
  scan.observations.push_back(core::make_range(range_m, settings.sigma_range_m));
  return scan;
}

/// Weaves increments and ranges together in time, splitting the increments; labels go along with the scans. If no
/// range came for a while, an empty scan lets the run report where the robot is.
void weave(const std::vector<Increment>& increments, const std::vector<Range>& ranges, const PlazaSettings& settings,
           core::Recording& recording) {
  std::vector<core::Event>& events = recording.events;
  core::Nanoseconds last_scan_ns = increments.front().t_ns;
  const auto add_scan = [&](const core::Scan& scan, const std::vector<core::Label>& labels) {
    events.emplace_back(scan);
    recording.labels.push_back(labels);
    last_scan_ns = scan.t_ns;
  };
  std::size_t next_range = 0;
  core::Nanoseconds now_ns =
      increments.front().t_ns;  // the first increment has no known beginning: it is instantaneous
  for (const Increment& increment : increments) {
    const core::Nanoseconds begin_ns = now_ns;
    const auto move_until = [&](core::Nanoseconds t_ns) {
      const bool instantaneous = increment.t_ns == begin_ns;
      const double share =
          instantaneous ? 1.0 : core::seconds(t_ns - now_ns) / core::seconds(increment.t_ns - begin_ns);
      if (share > 0.0) {
        events.emplace_back(part_of(increment, share, t_ns, settings));
      }
      now_ns = t_ns;
    };
    for (; next_range < ranges.size() && ranges[next_range].t_ns < increment.t_ns; ++next_range) {
      if (ranges[next_range].t_ns > now_ns) {
        move_until(ranges[next_range].t_ns);
      }
      add_scan(scan_of(ranges[next_range], settings), {ranges[next_range].beacon});
    }
    move_until(increment.t_ns);
    if (core::seconds(increment.t_ns - last_scan_ns) >= settings.empty_scan_after_s) {
      core::Scan nothing;
      nothing.t_ns = increment.t_ns;
      add_scan(nothing, {});
    }
  }
  for (; next_range < ranges.size(); ++next_range) {
    add_scan(scan_of(ranges[next_range], settings), {ranges[next_range].beacon});
  }
}

}  // namespace

core::Recording read_plaza(const std::filesystem::path& folder_or_odometry, const PlazaSettings& settings) {
  const std::string prefix = run_prefix(folder_or_odometry);
  const std::vector<Range> ranges = read_ranges(prefix + "_ranges.csv");
  core::Recording recording;
  recording.name = std::filesystem::path(prefix).filename().string();
  weave(read_increments(prefix + "_odometry.csv"), ranges, settings, recording);
  if (std::filesystem::exists(prefix + "_groundtruth.csv")) {
    recording.true_positions = read_true_positions(prefix + "_groundtruth.csv");
  }
  if (std::filesystem::exists(prefix + "_beacons_true.csv")) {
    recording.true_landmarks = read_true_beacons(prefix + "_beacons_true.csv");
  }
  return recording;
}

}  // namespace helixnav::logs

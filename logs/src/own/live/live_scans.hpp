// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_log.hpp"
#include "own/tables/own_tables.hpp"

namespace helixnav::logs {

/// A scan that has arrived and is not due yet.
struct LiveScan {
  core::Scan scan;
  std::vector<core::Label> labels;
  core::Nanoseconds row_ns = 0;  ///< as in its rows, before the sensor's delay
  std::size_t sensor = 0;        ///< in the order in which they came
  std::size_t line = 0;
  bool closed = false;  ///< no more rows are added

  std::tuple<core::Nanoseconds, core::Nanoseconds, std::size_t> order() const { return {scan.t_ns, row_ns, sensor}; }
};

/// The scans of a stream that wait for odometry, in time order.
class LiveScans {
 public:
  /// `by_identity`: labels are as make_recording numbers them. Otherwise they only show whether two identities are the
  /// same, and are not remembered.
  LiveScans(const Vehicle& vehicle, bool by_identity) : vehicle_(vehicle), by_identity_(by_identity) {}

  /// A row of detections as an observation, or as a scan that saw nothing.
  struct Seen {
    std::size_t sensor = 0;
    core::Nanoseconds row_ns = 0;
    std::optional<core::Observation> observation;
    core::Label label = core::no_label;
  };

  /// Throws StreamRefusal or core::InputError for rows that cannot be used; everything up to `woven_ns` is already
  /// woven.
  std::vector<Seen> check(const OwnLog& log, core::Nanoseconds woven_ns);

  /// Adds rows that were checked. `whole`: they are all the rows of their scans. Otherwise their scans are closed by
  /// the next rows of any other kind; an empty list closes the open ones.
  void add(const std::vector<Seen>& rows, bool whole, std::size_t line);

  void close_all();
  bool empty() const { return waiting_.empty(); }
  std::size_t size() const { return waiting_.size(); }
  bool first_is_closed() const { return !waiting_.empty() && waiting_.front().closed; }
  core::Nanoseconds first_ns() const { return waiting_.front().scan.t_ns; }
  core::Nanoseconds last_ns() const { return waiting_.back().scan.t_ns; }
  LiveScan pop();

  /// Seconds, for messages.
  static std::string text_of(core::Nanoseconds t_ns);

 private:
  struct Sensor {
    std::string name;
    SensorModel model;
    core::FieldOfView view;
    std::optional<core::Nanoseconds> answered_ns;  ///< of its last scan that was taken off
  };
  std::size_t sensor_called(const std::string& name);
  void check_time(const OwnDetection& row, const Sensor& sensor, core::Nanoseconds woven_ns) const;
  core::Nanoseconds time_of(core::Nanoseconds row_ns, const Sensor& sensor) const;
  void check_is_new(const std::vector<Seen>& rows);
  static bool holds(const LiveScan& scan, const Seen& row);
  LiveScan* waiting_scan(core::Nanoseconds row_ns, std::size_t sensor);
  LiveScan& begun_scan(const Seen& row, std::size_t line);
  std::vector<core::Label> labels_of(const std::vector<std::string>& words);

  const Vehicle& vehicle_;
  std::vector<Sensor> sensors_;
  std::deque<LiveScan> waiting_;
  bool by_identity_;
  std::optional<bool> identities_are_numbers_;  ///< as the first one was
  WordNumbers names_;
};

}  // namespace helixnav::logs

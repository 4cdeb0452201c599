// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/own_log.hpp"
#include "own/weaver.hpp"

namespace helixnav::logs {

/// Why something that can be read cannot be used now.
class StreamRefusal : public core::InputError {
 public:
  StreamRefusal(std::string key, const std::string& why) : core::InputError(why), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// By how much a scan may come after rows of the time at which it was taken, if every line comes when it should; not less than 0.
core::Nanoseconds longest_delay_ns(const Vehicle& vehicle);

/// The odometry of a stream: rows that arrive, motion that is due. Keeps the rows since the last scan, at most those of
/// the last second plus the sensors' delays; older ones become one increment.
class LiveMotion {
 public:
  LiveMotion(const Vehicle& vehicle, double late_s);

  /// Throws StreamRefusal for rows that go back in time, are of another kind or repeat an increment, core::InputError for
  /// noise or geometry that is not given anywhere. Changes nothing.
  void check(const OwnLog& log) const;
  void add(const OwnLog& log);

  /// Whether a row at or after that time has arrived, and the motion up to it is known.
  bool covers(core::Nanoseconds t_ns) const {
    return !rows_.odometry.empty() && rows_.odometry.back().t_ns >= t_ns && !is_begin_unknown();
  }

  bool has_begun() const { return motions_.has_value(); }

  /// Whether, after the last row, the odometry determines where a scan of that time was taken: speeds are held, and increments and
  /// poses continue for a mean interval.
  bool tells(core::Nanoseconds t_ns) const;

  /// Appends the motion up to t_ns, which is covered or at the end, to the events. Times must not go back.
  void weave_to(core::Nanoseconds t_ns, std::vector<core::Event>& events);

  /// Combines motion too old for any scan that may still come; none of these is before `before_ns`.
  void weave_old(core::Nanoseconds before_ns);

  /// No more rows will come: the last one holds until there.
  void end_at(core::Nanoseconds last_ns) { last_ns_ = last_ns; }

  /// Nothing before that may come any more.
  core::Nanoseconds woven_ns() const { return woven_ns_; }

 private:
  bool is_repeated(const OwnOdometry& last, const OwnOdometry& row) const;
  bool is_known(std::size_t row) const;
  bool is_begin_unknown() const { return count_ == 1 && rows_.odometry_kind == OdometryKind::increments; }
  void move_beyond_last(core::Nanoseconds t_ns);
  void drop_woven();

  const Vehicle& vehicle_;
  core::Nanoseconds late_ns_;
  OwnLog rows_;  ///< from the one before next_ on, always with covariances
  std::optional<Motions> motions_;
  std::size_t count_ = 0;           ///< rows that arrived
  bool share_times_ = false;        ///< two of them had the same time
  core::Nanoseconds first_ns_ = 0;  ///< of the first
  std::size_t next_ = 0;            ///< row whose motion is not all woven
  std::optional<core::Nanoseconds> last_ns_;
  core::Nanoseconds woven_ns_ = std::numeric_limits<core::Nanoseconds>::min();
  std::vector<core::Event> woven_;
  Weaver weaver_;
};

}  // namespace helixnav::logs

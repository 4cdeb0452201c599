// SPDX-License-Identifier: BSD-3-Clause
#include "live_motion.hpp"

#include <algorithm>
#include <cstdio>

#include "own/own_overlap.hpp"

namespace helixnav::logs {

core::Nanoseconds longest_delay_ns(const Vehicle& vehicle) {
  double longest_s = 0.0;
  for (const SensorModel& sensor : vehicle.sensors) {
    longest_s = std::max(longest_s, sensor.delay_s + sensor.arrives_late_s);
  }
  return core::nanoseconds_from_seconds(longest_s);
}

LiveMotion::LiveMotion(const Vehicle& vehicle, double late_s)
    : vehicle_(vehicle),
      late_ns_(core::nanoseconds_from_seconds(late_s) + longest_delay_ns(vehicle)),
      weaver_(vehicle.odometry.T_vehicle_odometry, woven_) {}

namespace {

[[noreturn]] void refuse_at(core::Nanoseconds t_ns, const char* does, core::Nanoseconds last_ns, const char* why) {
  char text[160];
  std::snprintf(text, sizeof text, "odometry at %.9g s %s odometry at %.9g s%s", core::seconds(t_ns), does,
                core::seconds(last_ns), why);
  throw StreamRefusal("t", text);
}

}  // namespace

void LiveMotion::check(const OwnLog& log) const {
  if (log.odometry.empty()) return;
  if (!rows_.odometry.empty() && log.odometry_kind != rows_.odometry_kind) {
    throw StreamRefusal("odometry", "odometry as " + std::string(name_of(log.odometry_kind)) + " after " +
                                        std::string(name_of(rows_.odometry_kind)) + "; a stream has one kind");
  }
  const Motions motions(log, vehicle_);
  if (rows_.odometry.empty()) return;
  OwnOdometry last = rows_.odometry.back();
  for (const OwnOdometry& row : log.odometry) {
    const bool answered = row.t_ns == woven_ns_ && !motions.holds();
    if (is_repeated(last, row)) refuse_at(row.t_ns, "repeats", last.t_ns, "");
    if (row.t_ns < last.t_ns || answered) {
      refuse_at(row.t_ns, "comes after", last.t_ns, answered ? " by which a scan was answered" : "");
    }
    last = row;
  }
}

/// An increment that was sent twice would be driven twice. Where several share one time, equal ones may well be two.
bool LiveMotion::is_repeated(const OwnOdometry& last, const OwnOdometry& row) const {
  return rows_.odometry_kind == OdometryKind::increments && !share_times_ && row.t_ns == last.t_ns &&
         row.value == last.value;
}

void LiveMotion::add(const OwnLog& log) {
  if (log.odometry.empty()) return;
  const bool first = rows_.odometry.empty();
  rows_.odometry_kind = log.odometry_kind;
  for (std::size_t i = 0; i < log.odometry.size(); ++i) {
    const OwnOdometry* before = i > 0 ? &log.odometry[i - 1] : first ? nullptr : &rows_.odometry.back();
    share_times_ = share_times_ || (before != nullptr && before->t_ns == log.odometry[i].t_ns);
  }
  rows_.odometry.insert(rows_.odometry.end(), log.odometry.begin(), log.odometry.end());
  rows_.odometry_covariances.insert(rows_.odometry_covariances.end(), log.odometry_covariances.begin(),
                                    log.odometry_covariances.end());
  rows_.odometry_covariances.resize(rows_.odometry.size(), Eigen::Matrix3d::Zero());
  if (first) first_ns_ = rows_.odometry.front().t_ns;
  count_ += log.odometry.size();
  if (first) motions_.emplace(rows_, vehicle_);
}

bool LiveMotion::tells(core::Nanoseconds t_ns) const {
  if (!motions_) return false;
  if (motions_->holds()) return true;
  return t_ns <= told_until_ns(first_ns_, rows_.odometry.back().t_ns, count_);
}

bool LiveMotion::is_known(std::size_t row) const {
  const std::size_t rows = rows_.odometry.size();
  const bool is_until_next = motions_ && motions_->holds();
  return motions_ && row < rows && (row + 1 < rows || last_ns_ || (!is_until_next && !is_begin_unknown()));
}

void LiveMotion::weave_to(core::Nanoseconds t_ns, std::vector<core::Event>& events) {
  for (; is_known(next_); ++next_) {
    const std::optional<Motion> motion = motions_->of_row(next_, last_ns_.value_or(t_ns));
    if (!motion) continue;
    if (t_ns < motion->end_ns) {
      weaver_.move(*motion, t_ns);
      break;
    }
    weaver_.move(*motion, motion->end_ns);
  }
  move_beyond_last(t_ns);
  weaver_.flush();
  events.insert(events.end(), woven_.begin(), woven_.end());
  woven_.clear();
  woven_ns_ = std::max(woven_ns_, t_ns);
  drop_woven();
}

/// At the end, to a scan that odometry has not reached.
void LiveMotion::move_beyond_last(core::Nanoseconds t_ns) {
  if (!last_ns_ || !motions_ || next_ < rows_.odometry.size() || t_ns <= rows_.odometry.back().t_ns) return;
  if (const std::optional<Motion> beyond = motions_->beyond_last()) weaver_.move(*beyond, t_ns);
}

void LiveMotion::weave_old(core::Nanoseconds before_ns) {
  if (rows_.odometry.empty()) return;
  core::Nanoseconds until_ns = rows_.odometry.back().t_ns - late_ns_;
  if (before_ns != std::numeric_limits<core::Nanoseconds>::min()) until_ns = std::min(until_ns, before_ns);
  for (; is_known(next_); ++next_) {
    const std::optional<Motion> motion = motions_->of_row(next_, until_ns);
    if (!motion) continue;
    if (motion->end_ns > until_ns) break;
    weaver_.move(*motion, motion->end_ns);
    woven_ns_ = std::max(woven_ns_, motion->end_ns);
  }
  drop_woven();
}

/// All but the row before the next one, from which poses are measured.
void LiveMotion::drop_woven() {
  constexpr std::size_t many = 256;
  if (next_ < many) return;
  const auto count = static_cast<std::ptrdiff_t>(next_ - 1);
  rows_.odometry.erase(rows_.odometry.begin(), rows_.odometry.begin() + count);
  rows_.odometry_covariances.erase(rows_.odometry_covariances.begin(), rows_.odometry_covariances.begin() + count);
  motions_->forget(next_ - 1);
  next_ = 1;
}

}  // namespace helixnav::logs

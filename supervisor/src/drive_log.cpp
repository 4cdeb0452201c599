// SPDX-License-Identifier: BSD-3-Clause
#include "drive_log.hpp"

#include <utility>

#include "association_report.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {

void DriveLog::predict(const core::Odometry& odometry) {
  motion_ = motion_ ? core::chain(*motion_, odometry) : odometry;
}

void DriveLog::fix(const core::AbsoluteFix& fix, double nis) {
  Stop next;
  next.fix = fix;
  next.cost = nis;
  stop(std::move(next));
}

void DriveLog::observe(const core::Scan& scan, const core::StepReport& report) {
  Stop next;
  next.seen = matches(scan, report.associations);
  for (const core::AssociationReport& association : report.associations) {
    if (association.outcome != core::Outcome::augmented) continue;
    const core::Observation& seen = scan.observations[static_cast<std::size_t>(association.observation)];
    next.seen.push_back({association.landmark, seen, scan.T_robot_sensor});
  }
  next.cost = report.joint_nis;
  ++scans_;
  stop(std::move(next));
}

void DriveLog::stop(Stop&& next) {
  next.motion = std::exchange(motion_, std::nullopt);
  cost_ += next.cost;
  stops_.push_back(std::move(next));
  if (static_cast<int>(stops_.size()) > most_stops_) let_go();
}

void DriveLog::close(const std::vector<core::MergedLandmarks>& merged, double cost) {
  for (const core::MergedLandmarks& one : merged) kept_of_[one.removed] = one.kept;
  cost_ += cost;
}

void DriveLog::back_to(std::int64_t step) {
  motion_.reset();
  while (!stops_.empty() && (scans_ > step + 1 || stops_.back().fix)) {
    if (!stops_.back().fix) --scans_;
    cost_ -= stops_.back().cost;
    stops_.pop_back();
  }
}

void DriveLog::let_go() {
  most_stops_ = 0;
  stops_.clear();
  stops_.shrink_to_fit();
}

core::LandmarkId DriveLog::present(core::LandmarkId id) const {
  for (auto kept = kept_of_.find(id); kept != kept_of_.end(); kept = kept_of_.find(id)) id = kept->second;
  return id;
}

}  // namespace helixnav::supervisor

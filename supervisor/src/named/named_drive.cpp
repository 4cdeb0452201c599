// SPDX-License-Identifier: BSD-3-Clause
#include "named/named_drive.hpp"

#include <utility>

#include "helixnav/core/odometry.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {
namespace {

/// Every landmark that has a name is worth a place in the map, and keeps its name.
PhaseNames all_names() {
  PhaseNames names;
  names.is_worth_it = [](core::LandmarkId) { return true; };
  names.now = [](core::LandmarkId id) { return id; };
  return names;
}

}  // namespace

NamedDrive::NamedDrive(const core::PoseGaussian& start, int most_stops)
    : most_stops_(most_stops), kept_(most_stops > 0), atlas_(softened_start(start)) {}

void NamedDrive::back_to(const Mark& mark) noexcept {
  while (stops_.size() > mark.stops) stops_.pop_back();
  motion_ = mark.motion;
}

void NamedDrive::move(const core::Odometry& motion) {
  if (kept_) motion_ = motion_ ? core::chain(*motion_, motion) : motion;
}

void NamedDrive::stop(Stop stop) {
  if (!kept_) return;
  if (begins_ && static_cast<int>(stops_.size()) >= most_stops_) {
    drop();
    return;
  }
  stop.motion = motion_;
  stops_.push_back(std::move(stop));
  motion_.reset();
}

void NamedDrive::drop() noexcept {
  kept_ = false;
  stops_.clear();
  motion_.reset();
}

/// The stops that close_phase takes, or none while the vehicle is still in that phase.
std::size_t NamedDrive::stops_of_phase(double length_m) const {
  double driven_m = 0.0;
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    if (stops_[i].motion) driven_m += stops_[i].motion->T_before_after.position_m().norm();
    if (driven_m >= length_m || stops_[i].fix) return i + 1;
  }
  return 0;
}

bool NamedDrive::has_phase(double length_m) const { return stops_of_phase(length_m) > 0; }

core::Pose2 NamedDrive::T_entry_exit(double length_m) const {
  const std::size_t whole = stops_of_phase(length_m);
  core::Pose2 T_entry_robot;
  for (std::size_t i = 0; i < (whole > 0 ? whole : stops_.size()); ++i) {
    if (stops_[i].motion) T_entry_robot = core::compose(T_entry_robot, stops_[i].motion->T_before_after);
  }
  if (whole == 0 && motion_) T_entry_robot = core::compose(T_entry_robot, motion_->T_before_after);
  return T_entry_robot;
}

void NamedDrive::close_phase(double length_m, const atlas::PointPrior* known) {
  const auto end = stops_.begin() + static_cast<std::ptrdiff_t>(stops_of_phase(length_m));
  const std::vector<DrivePhase> phases = phases_of({stops_.begin(), end}, std::nullopt, length_m, begins_, all_names());
  atlas::Atlas atlas = atlas_;
  add(phases, known, atlas);
  atlas_ = std::move(atlas);
  stops_.erase(stops_.begin(), end);
  begins_ = false;
  phases_ += static_cast<int>(phases.size());
}

/// From dead reckoning, three Gauss-Newton steps bring a phase to its minimum.
void NamedDrive::add(const std::vector<DrivePhase>& phases, const atlas::PointPrior* known, atlas::Atlas& atlas) const {
  for (const DrivePhase& phase : phases) {
    const atlas::PhaseShape start = atlas::dead_reckon(*phase.log, &phase == &phases.front() ? known : nullptr);
    const int clone = atlas.add(atlas::derive_factor(*phase.log, start), phase.log) + 1;
    if (phase.fix) atlas.fix(clone, *phase.fix);
  }
}

void NamedDrive::settle(double length_m, const atlas::PointPrior* known) {
  const std::vector<DrivePhase> phases =
      phases_of({stops_.begin(), stops_.end()}, motion_, length_m, begins_, all_names());
  add(phases, known, atlas_);
  phases_ += static_cast<int>(phases.size());
  stops_.clear();
  motion_.reset();
  begins_ = false;
  atlas_.condense();
  atlas_.settle();
}

}  // namespace helixnav::supervisor

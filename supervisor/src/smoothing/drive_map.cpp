// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/drive_map.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "helixnav/atlas/phase_factor.hpp"

namespace helixnav::supervisor {
namespace {

std::map<core::LandmarkId, int> sightings(const std::vector<Stop>& stops, const core::MergedIds& ids) {
  std::map<core::LandmarkId, int> count;
  for (const Stop& stop : stops) {
    for (const cekf::Match& match : stop.seen) ++count[ids.now(match.landmark)];
  }
  return count;
}

}  // namespace

DriveMap::DriveMap(const core::PoseGaussian& start, double phase_m, const atlas::Options& options)
    : phase_m_(phase_m), standing_(phase_m), atlas_(softened_start(start), options) {}

void DriveMap::take(const Tape& tape, const cekf::CompressedEkf& filter) {
  std::vector<Stop> stops = stops_of(tape, end_);
  standing_.thin(stops);
  const core::MergedIds ids = merged_ids(tape, end_);
  const std::map<core::LandmarkId, int> seen = sightings(stops, ids);
  PhaseNames names;
  names.now = [&](core::LandmarkId id) { return ids.now(id); };
  names.is_worth_it = [&](core::LandmarkId id) { return seen.at(id) > 1 || filter.contains(id) || has_name(id); };
  for (const DrivePhase& phase : phases_of(stops, motion_after_stops(tape, end_), phase_m_, stops_.empty(), names)) {
    add(phase);
  }
  merge(tape, ids);
  cost_ = drive_cost(tape, end_, cost_);
  end_ = tape.end();
}

/// Over the length of a phase, dead reckoning is a start from which three Gauss-Newton steps reach its minimum.
void DriveMap::add(const DrivePhase& phase) {
  atlas::PhaseFactor factor = atlas::derive_factor(*phase.log, atlas::dead_reckon(*phase.log));
  for (const core::LandmarkId id : factor.shape.ids) {
    const auto at = static_cast<std::size_t>(id);
    if (at >= named_.size()) named_.resize(at + 1, false);
    named_[at] = true;
  }
  stops_.push_back(std::make_shared<const std::vector<StopInPhase>>(phase.stops));
  const int clone = atlas_.add(std::move(factor), phase.log) + 1;
  if (phase.fix) atlas_.fix(clone, *phase.fix);
}

/// Landmarks that had both names before; observations since then already have the present ones.
void DriveMap::merge(const Tape& tape, const core::MergedIds& ids) {
  tape.read_from(end_, [&](const Tape::Entry& entry) {
    const auto* merged = std::get_if<Tape::Merge>(&entry);
    if (merged == nullptr) return;
    for (const core::MergedLandmarks& one : merged->merged) {
      const core::LandmarkId kept = ids.now(one.kept);
      if (!has_name(one.removed) || !has_name(kept) || one.removed == kept) continue;
      atlas_.merge({{one.removed, kept}});
      named_[static_cast<std::size_t>(one.removed)] = false;
    }
  });
}

bool DriveMap::has_name(core::LandmarkId id) const {
  const auto at = static_cast<std::size_t>(id);
  return id >= 0 && at < named_.size() && named_[at];
}

void DriveMap::settle() {
  atlas_.condense();
  atlas_.settle();
}

void DriveMap::remember(const cekf::CompressedEkf& filter) {
  covariances_m2_.resize(std::max(covariances_m2_.size(), static_cast<std::size_t>(filter.next_name())),
                         Eigen::Matrix2d::Zero());
  for (const core::LandmarkId id : filter.landmarks()) {
    covariances_m2_[static_cast<std::size_t>(id)] = filter.landmark(id).covariance_m2;
  }
}

std::vector<core::PointGaussian> DriveMap::remembered(const std::vector<core::LandmarkId>& ids) const {
  std::vector<core::PointGaussian> points;
  for (const atlas::Place& place : atlas_.places_of(ids)) {
    points.push_back({place.point_m, covariances_m2_.at(static_cast<std::size_t>(place.id))});
  }
  return points;
}

std::vector<core::StampedPose> DriveMap::path() const {
  std::vector<core::StampedPose> path;
  const std::vector<core::Pose2> entries = atlas_.clones();
  const std::vector<std::vector<core::Pose2>> poses = atlas_.poses();
  for (std::size_t phase = 0; phase < stops_.size(); ++phase) {
    for (const StopInPhase& stop : *stops_[phase]) {
      const bool at_entry = stop.step < 0;
      path.push_back({stop.t_ns, at_entry ? entries[phase] : poses[phase][static_cast<std::size_t>(stop.step)]});
    }
  }
  return path;
}

}  // namespace helixnav::supervisor

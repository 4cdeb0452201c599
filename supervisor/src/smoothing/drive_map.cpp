// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/drive_map.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/atlas/phase_factor.hpp"
#include "placing/place_by_points.hpp"

namespace helixnav::supervisor {
namespace {

std::map<core::LandmarkId, int> sightings(const std::vector<Stop>& stops, const core::MergedIds& ids) {
  std::map<core::LandmarkId, int> count;
  for (const Stop& stop : stops) {
    for (const cekf::Match& match : stop.seen) ++count[ids.now(match.landmark)];
  }
  return count;
}

/// Over the length of a phase, dead reckoning is a start from which three Gauss-Newton steps reach its minimum.
atlas::PhaseFactor derived_alone(const atlas::PhaseLog& log) {
  return atlas::derive_factor(log, atlas::dead_reckon(log));
}

/// Derives phase after phase about the landmarks where a filter has them.
class DerivedAtFilter {
 public:
  DerivedAtFilter(const cekf::CompressedEkf& filter, const core::Pose2& T_map_start)
      : filter_(filter), T_map_entry_(T_map_start) {}

  atlas::PhaseFactor operator()(const atlas::PhaseLog& log) {
    const atlas::PointPrior known = landmarks_in(log);
    atlas::PhaseFactor factor = atlas::derive_factor(log, atlas::dead_reckon(log, &known), &known);
    T_map_entry_ = core::compose(T_map_entry_, factor.shape.T_entry_robot.back());
    return factor;
  }

 private:
  /// So certain that they stay there.
  atlas::PointPrior landmarks_in(const atlas::PhaseLog& log) const {
    const core::Pose2 T_entry_map = core::inverse(T_map_entry_);
    atlas::PointPrior known;
    for (const core::LandmarkId id : atlas::landmarks_of(log)) {
      if (!filter_.contains(id)) continue;
      known.ids.push_back(id);
      known.points_m.push_back(core::transform(T_entry_map, filter_.landmark(id).mean_m));
    }
    const auto rows = 2 * static_cast<Eigen::Index>(known.ids.size());
    known.covariance = softening().x() * softening().x() * Eigen::MatrixXd::Identity(rows, rows);
    return known;
  }

  const cekf::CompressedEkf& filter_;
  core::Pose2 T_map_entry_;
};

/// A pose relative to landmarks, as a phase from where the drive ended that says nothing else: the error of the pose, less what
/// the errors of the landmarks make of it, is that of the pose given.
atlas::PhaseFactor phase_to(const core::JointMap::Given& given, const atlas::Atlas& atlas) {
  const core::Pose2 T_map_entry = atlas.pose();
  const core::Pose2 T_entry_map = core::inverse(T_map_entry);
  const core::Pose2 T_entry_exit = core::compose(T_entry_map, given.pose.mean);
  atlas::PhaseFactor phase;
  phase.shape.ids = given.around;
  for (const atlas::Place& place : atlas.places_of(given.around)) {
    phase.shape.points_m.push_back(core::transform(T_entry_map, place.point_m));
  }
  phase.shape.T_entry_robot.push_back(T_entry_exit);
  const auto rows = 3 + 2 * static_cast<Eigen::Index>(given.around.size());
  Eigen::MatrixXd error(3, rows);
  error << Eigen::Matrix3d::Identity(), -place_by_points(T_entry_exit, phase.shape.points_m);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = core::rotation(T_entry_map.heading_rad);
  Eigen::Matrix3d covariance = turn * given.pose.covariance * turn.transpose();
  covariance.diagonal() += softening().cwiseAbs2();
  const Eigen::Matrix3d information = covariance.inverse();
  phase.gaussian.information = error.transpose() * information * error;
  phase.gaussian.vector = Eigen::VectorXd::Zero(rows);
  phase.gaussian.mean.resize(rows);
  phase.gaussian.mean.head<3>() = T_entry_exit.vector();
  for (std::size_t i = 0; i < phase.shape.points_m.size(); ++i) {
    phase.gaussian.mean.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = phase.shape.points_m[i];
  }
  return phase;
}

/// Landmarks relative to the pose, where the phase begins and ends: where both are in a frame is left out.
atlas::PhaseFactor phase_of(const core::JointGaussian& joint) {
  constexpr double cancelled =
      1e-11;  // of the variances in the frame, where a vehicle that is lost turns about the origin
  const atlas::PointPrior points = atlas::relative_to_pose(joint);
  const Eigen::Index rows = 3 + points.covariance.rows();
  atlas::PhaseFactor phase;
  phase.shape.ids = points.ids;
  phase.shape.points_m = points.points_m;
  phase.shape.T_entry_robot = {core::Pose2()};
  Eigen::MatrixXd softened = points.covariance;
  softened.diagonal().array() += softening().x() * softening().x() + cancelled * joint.covariance.diagonal().maxCoeff();
  const Eigen::MatrixXd information = softened.llt().solve(Eigen::MatrixXd::Identity(rows - 3, rows - 3));
  Eigen::MatrixXd apart = Eigen::MatrixXd::Zero(rows, rows);
  apart.diagonal().head<3>() = softening().cwiseAbs2().cwiseInverse();
  apart.bottomRightCorner(rows - 3, rows - 3) = 0.5 * (information + information.transpose());
  phase.gaussian.information = apart;
  phase.gaussian.vector = Eigen::VectorXd::Zero(rows);
  phase.gaussian.mean = Eigen::VectorXd::Zero(rows);
  for (std::size_t i = 0; i < points.points_m.size(); ++i) {
    phase.gaussian.mean.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = points.points_m[i];
  }
  return phase;
}

}  // namespace

DriveMap::DriveMap(const core::PoseGaussian& start, double phase_m, const atlas::Options& options)
    : phase_m_(phase_m), standing_(phase_m), atlas_(softened_start(start), options) {}

DriveMap DriveMap::of_end(const core::JointGaussian& joint, double phase_m) {
  DriveMap map(core::PoseGaussian{joint.pose, Eigen::Matrix3d::Zero()}, phase_m);
  map.has_whole_path_ = false;
  map.stops_.push_back(std::make_shared<const std::vector<StopInPhase>>());
  for (const core::LandmarkId id : joint.ids) map.name(id);
  map.atlas_.add(phase_of(joint));
  map.atlas_.settle();
  return map;
}

DriveMap DriveMap::of_earlier(const core::JointMap& earlier, double phase_m) {
  DriveMap map(core::PoseGaussian{}, phase_m);
  map.atlas_ = atlas::Atlas::from_factors(*earlier.factors);
  if (earlier.given) {
    map.atlas_.add(phase_to(*earlier.given, map.atlas_));
    map.atlas_.settle();
  }
  map.stops_.assign(static_cast<std::size_t>(map.atlas_.phase_count()),
                    std::make_shared<const std::vector<StopInPhase>>());
  map.covariances_m2_.resize(static_cast<std::size_t>(earlier.next_name), Eigen::Matrix2d::Zero());
  for (std::size_t i = 0; i < earlier.joint.ids.size(); ++i) {
    map.covariances_m2_[static_cast<std::size_t>(earlier.joint.ids[i])] = earlier.covariance_m2_of(i);
  }
  for (const atlas::Place& place : map.atlas_.landmarks()) {
    map.name(place.id);
    map.extent_m_ = std::max(map.extent_m_, place.point_m.norm());
  }
  map.cost_ = map.atlas_.chi2();
  return map;
}

/// The gap says next to nothing, so that what is known of the place comes from the pairs: it is ten phases wide about a place that is
/// known to a fraction of one. Much wider, and the drive before it is merged would be left with less than rounding leaves of it.
DriveMap DriveMap::followed_by(const DriveMap& drive, const core::Pose2& T_map_drive,
                               const std::vector<core::MergedLandmarks>& merged) const {
  atlas::RelativeGaussian gap;
  const double wide_m = 10.0 * phase_m_;
  const double per_m2 = 1.0 / (wide_m * wide_m);
  gap.information = Eigen::Vector3d(per_m2, per_m2, 0.01).asDiagonal();
  gap.vector = Eigen::Vector3d::Zero();
  const core::Pose2 T_map_first = core::compose(T_map_drive, drive.atlas_.clone(0));
  gap.mean = core::between(atlas_.pose(), T_map_first).vector();
  DriveMap both(*this);
  both.atlas_ = atlas_.followed_by(gap, drive.atlas_);
  both.standing_ = drive.standing_;
  both.has_whole_path_ = drive.has_whole_path_;
  both.stops_.push_back(std::make_shared<const std::vector<StopInPhase>>());  // the gap
  both.stops_.insert(both.stops_.end(), drive.stops_.begin(), drive.stops_.end());
  both.phases_when_placed_ = both.stops_.size();
  both.T_map_part_ = T_map_drive;
  for (const atlas::Place& place : drive.atlas_.landmarks()) both.name(place.id);
  both.covariances_m2_.resize(std::max(covariances_m2_.size(), drive.covariances_m2_.size()), Eigen::Matrix2d::Zero());
  for (std::size_t id = 0; id < drive.covariances_m2_.size(); ++id) {
    if (!drive.covariances_m2_[id].isZero(0.0)) both.covariances_m2_[id] = drive.covariances_m2_[id];
  }
  both.merge(merged);
  both.settle();
  both.cost_ = both.atlas_.chi2();
  return both;
}

void DriveMap::merge(const std::vector<core::MergedLandmarks>& merged) {
  std::vector<atlas::MergePair> pairs;
  for (const core::MergedLandmarks& one : merged) {
    if (!has_name(one.removed) || !has_name(one.kept)) continue;
    pairs.emplace_back(one.removed, one.kept);
  }
  atlas_.merge(pairs);
  for (const auto& [removed, kept] : pairs) named_[static_cast<std::size_t>(removed)] = false;
}

core::MapFactors DriveMap::unsolved(const core::PoseGaussian& start, double phase_m, const Tape& tape,
                                    const cekf::CompressedEkf& filter) {
  DriveMap map(start, phase_m);
  DerivedAtFilter derive(filter, start.mean);
  map.take(tape, filter, std::ref(derive));
  return map.atlas_.unsolved_factors();
}

void DriveMap::take(const Tape& tape, const cekf::CompressedEkf& filter) { take(tape, filter, derived_alone); }

void DriveMap::take(const Tape& tape, const cekf::CompressedEkf& filter, const Derive& derive) {
  std::vector<Stop> stops = stops_of(tape, end_);
  standing_.thin(stops);
  const core::MergedIds ids = merged_ids(tape, end_);
  const std::map<core::LandmarkId, int> seen = sightings(stops, ids);
  const auto first_new = static_cast<core::LandmarkId>(named_.size());
  PhaseNames names;
  names.now = [&](core::LandmarkId id) { return ids.now(id); };
  names.is_worth_it = [&](core::LandmarkId id) { return seen.at(id) > 1 || filter.contains(id) || has_name(id); };
  for (const DrivePhase& phase : phases_of(stops, motion_after_stops(tape, end_), phase_m_, stops_.empty(), names)) {
    add(phase, derive);
  }
  merge(tape, ids);
  forget_passing(tape, first_new);
  cost_ = drive_cost(tape, end_, cost_);
  end_ = tape.end();
}

void DriveMap::add(const DrivePhase& phase, const Derive& derive) {
  atlas::PhaseFactor factor = derive(*phase.log);
  for (const core::LandmarkId id : factor.shape.ids) name(id);
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

/// What was taken for a landmark and removed within the same part of the drive: with a name, it would keep its phase from ever being
/// condensed.
void DriveMap::forget_passing(const Tape& tape, core::LandmarkId first_new) {
  tape.read_from(end_, [&](const Tape::Entry& entry) {
    const auto* scan = std::get_if<Tape::Scan>(&entry);
    if (scan == nullptr) return;
    for (const core::LandmarkId id : scan->died) {
      if (id < first_new || !has_name(id)) continue;
      atlas_.forget(id);
      named_[static_cast<std::size_t>(id)] = false;
    }
  });
}

void DriveMap::name(core::LandmarkId id) {
  const auto at = static_cast<std::size_t>(id);
  if (at >= named_.size()) named_.resize(at + 1, false);
  named_[at] = true;
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
  if (!has_whole_path_) return path;
  const std::vector<core::Pose2> entries = atlas_.clones();
  const std::vector<std::vector<core::Pose2>> poses = atlas_.poses();
  const core::Pose2 T_part_map = core::inverse(T_map_part_);
  for (std::size_t phase = 0; phase < stops_.size(); ++phase) {
    for (const StopInPhase& stop : *stops_[phase]) {
      const bool at_entry = stop.step < 0;
      const core::Pose2& there = at_entry ? entries[phase] : poses[phase][static_cast<std::size_t>(stop.step)];
      const bool is_of_part = phase < phases_when_placed_;
      path.push_back({stop.t_ns, is_of_part ? core::compose(T_part_map, there) : there});
    }
  }
  return path;
}

}  // namespace helixnav::supervisor

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/map_factors.hpp"
#include "helixnav/core/step_report.hpp"
#include "loop/tape.hpp"
#include "smoothing/drive_phases.hpp"
#include "smoothing/standing_looks.hpp"

namespace helixnav::supervisor {

/// The drive up to a position on its tape as an atlas: what was measured up to there is in its phases, and the tape
/// need not keep it. A copy costs O(phases). Errors: core::NumericalError if the mathematics fails; the map then has to
/// be discarded.
/// Test: supervisor/smoothing/drive_map_test.cpp (taken in by pieces), supervisor/smoothing/smooth_drive_test.cpp
/// (least squares over all poses).
class DriveMap {
 public:
  /// `phase_m`: length of a phase. `options`: how close to the solution the atlas gets; tests go all the way.
  DriveMap(const core::PoseGaussian& start, double phase_m, const atlas::Options& options = {});

  /// A drive of which nothing is known but what came of it, as one phase: the joint estimate of the pose and of the
  /// landmarks, in a frame of which nothing is known. Its path is not known.
  static DriveMap of_end(const core::JointGaussian& joint, double phase_m);

  /// The map of an earlier session, which holds factors, to go on in: from where that session ended, or from the pose that
  /// was given.
  static DriveMap of_earlier(const core::JointMap& earlier, double phase_m);

  /// This map with another drive behind it that began somewhere on it. `T_map_drive`: where its frame is; what ties the
  /// two is `merged`, landmarks of both (the kept one's name stays). Solved.
  DriveMap followed_by(const DriveMap& drive, const core::Pose2& T_map_drive,
                       const std::vector<core::MergedLandmarks>& merged) const;

  /// Landmarks that are one; those that the map does not know are passed over.
  void merge(const std::vector<core::MergedLandmarks>& merged);

  /// Takes in what the tape holds from end() on: scans, fixes, motion and merges. Landmarks lost again after a single look,
  /// which `filter` no longer has, are left out; those that the tape begins and removes lose their names.
  void take(const Tape& tape, const cekf::CompressedEkf& filter);

  /// The factors of a drive that a filter holds as a whole, with its phases derived about the filter's landmarks: near enough to be
  /// solved when the map is taken up again. Solving it here would take most of the time and memory of saving a map.
  /// Test: supervisor/smoothing/unsolved_factors_test.cpp (solved, it is what the solved drive is).
  static core::MapFactors unsolved(const core::PoseGaussian& start, double phase_m, const Tape& tape,
                                   const cekf::CompressedEkf& filter);

  /// What was measured up to there on the tape is in the map.
  void begin_at(Tape::Position position) { end_ = position; }

  /// Solves what was taken in since it was last solved.
  void settle();

  /// Keeps the covariances of the landmarks of a filter that leaves some of them out.
  void remember(const cekf::CompressedEkf& filter);
  /// The covariances that another map of the same drive has kept.
  void remember(const DriveMap& other) { covariances_m2_ = other.covariances_m2_; }
  /// Where landmarks were last solved, with the covariances last remembered for them. O(paths to them).
  std::vector<core::PointGaussian> remembered(const std::vector<core::LandmarkId>& ids) const;

  const atlas::Atlas& atlas() const { return atlas_; }
  Tape::Position end() const { return end_; }
  /// What the filter paid for the measurements up to there, see drive_cost.
  double cost() const { return cost_; }

  /// Poses of all stops as they are solved, none if some of them are not known; those before the drive's place on an earlier map was found in the frame that
  /// it had then.
  std::vector<core::StampedPose> path() const;

  /// From the origin to the farthest landmark of an earlier map; 0 without one.
  double extent_m() const { return extent_m_; }

 private:
  using Derive = std::function<atlas::PhaseFactor(const atlas::PhaseLog&)>;

  void take(const Tape& tape, const cekf::CompressedEkf& filter, const Derive& derive);
  void add(const DrivePhase& phase, const Derive& derive);
  void merge(const Tape& tape, const core::MergedIds& ids);
  void forget_passing(const Tape& tape, core::LandmarkId first_new);
  bool has_name(core::LandmarkId id) const;
  void name(core::LandmarkId id);

  double phase_m_;
  StandingLooks standing_;
  atlas::Atlas atlas_;
  std::vector<std::shared_ptr<const std::vector<StopInPhase>>> stops_;  ///< of every phase
  std::vector<bool> named_;                                             ///< by id: known to the atlas
  std::vector<Eigen::Matrix2d> covariances_m2_;                         ///< by id
  Tape::Position end_ = 0;
  double cost_ = 0.0;
  double extent_m_ = 0.0;
  std::size_t phases_when_placed_ = 0;
  core::Pose2 T_map_part_;  ///< of the frame of the path in these phases
  bool has_whole_path_ = true;
};

}  // namespace helixnav::supervisor

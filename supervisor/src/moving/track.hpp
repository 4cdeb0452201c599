// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/time.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// Something seen lately, under two hypotheses: it moves at a constant velocity, or it stands still and what was seen
/// elsewhere is something else. Vehicle frame, which does not drift. Test: supervisor/moving/track_test.cpp.
class Track {
 public:
  /// At its first sighting, which began `landmark`. `sigma_mps`: of its velocity, along each axis.
  Track(core::LandmarkId landmark, const SeenPoint& seen, core::Nanoseconds t_ns, double sigma_mps);

  /// Into the vehicle frame after a motion, with the uncertainty of that motion.
  void change_frame(const core::Odometry& motion);

  /// To the time of a scan.
  void predict(core::Nanoseconds t_ns);

  /// Density of a sighting [1/m²] if it moves, or stands; 0 beyond a gate of one in ten thousand.
  double density_if_moving(const SeenPoint& seen) const;
  double density_if_standing(const SeenPoint& seen) const;

  /// Seen again where the last of its landmarks stands; the moving one as well, if that is within its gate.
  void see_standing(const SeenPoint& seen, double nats);
  /// Seen where it should be if it moves.
  void see_moving(const SeenPoint& seen, double nats);
  void miss() { ++misses_in_a_row_; }

  /// The sighting that see_moving() took last has begun a landmark.
  void begin_landmark(core::LandmarkId landmark) { landmarks_.push_back(landmark); }
  /// All of its landmarks, oldest first; forgets them.
  std::vector<core::LandmarkId> take_landmarks();
  const std::vector<core::LandmarkId>& landmarks() const { return landmarks_; }

  const Eigen::Vector2d& stands_m() const { return stands_m_; }
  double nats() const { return nats_; }                     ///< log-likelihood ratio of "moves" against "stands"
  double speed_mps() const { return x_.tail<2>().norm(); }  ///< if it moves
  int misses_in_a_row() const { return misses_in_a_row_; }
  /// The last of its landmarks was seen more than once: a false alarm is not missed.
  bool was_seen_again() const { return was_seen_again_; }

 private:
  Eigen::Vector4d x_;  ///< position, velocity
  Eigen::Matrix4d P_;
  Eigen::Vector2d stands_m_;
  Eigen::Matrix2d stands_covariance_m2_;
  core::Nanoseconds t_ns_;
  double sigma_mps_;
  double nats_ = 0.0;
  int misses_in_a_row_ = 0;
  bool was_seen_again_ = false;
  std::vector<core::LandmarkId> landmarks_;
};

}  // namespace helixnav::supervisor

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "helixnav/core/appearance.hpp"
#include "helixnav/core/decision.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/numerical_health.hpp"
#include "helixnav/core/particle_cloud.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::core {

/// What became of one observation.
enum class Outcome {
  matched,    ///< used to update the landmark named
  augmented,  ///< began the landmark named
  ambiguous,  ///< explained by more than one landmark, or neither near nor far enough: not used
  rejected,   ///< refused with numbers: joint test, gate, excluded landmark
};

enum class LandmarkState { tentative, mature, dead };

enum class Mode { mapping, searching };

/// One observation's outcome with the number that decided it.
struct AssociationReport {
  int observation = 0;  ///< index in the scan, from 0
  Outcome outcome = Outcome::ambiguous;
  LandmarkId landmark = no_landmark;
  double nis = 0.0;  ///< νᵀS⁻¹ν of the pair chosen; NaN when there was none
  int dof = 0;       ///< rows of ν; 0 when there was none
  double margin_nats =
      0.0;  ///< cost of the best alternative minus cost of the choice; +inf when there was none, NaN when not asked
};

/// Two landmarks that turned out to be one: `removed` is gone, and what was seen of it was `kept`.
struct MergedLandmarks {
  LandmarkId kept = no_landmark;
  LandmarkId removed = no_landmark;
};

/// What became of the observations of an earlier scan when it was reprocessed: this holds, and not what its own report
/// says.
struct RevisedScan {
  std::int64_t step = 0;
  std::vector<AssociationReport> associations;
};

/// Where the robot was.
struct StampedPose {
  Nanoseconds t_ns = 0;
  Pose2 T_world_robot;
};

/// Everything one scan did to the map and the pose. Filled by supervisor::Navigator or fastslam::FastSlam, written by
/// runs::RunWriter.
struct StepReport {
  std::int64_t step = 0;  ///< index of the scan, from 0
  Nanoseconds t_ns = 0;
  Mode mode = Mode::mapping;
  PoseGaussian pose;  ///< T_world_robot after the scan
  std::vector<AssociationReport> associations;
  double joint_nis = 0.0;  ///< of the joint update; 0 with joint_dof 0 when nothing matched
  int joint_dof = 0;
  NumericalHealth numerics;
  int active_landmarks = 0;
  int mapped_landmarks = 0;
  bool switched_region = false;
  std::vector<Decision> decisions;
  std::vector<MergedLandmarks> merged;  ///< by a closure in this step
  std::vector<RevisedScan> revised;     ///< by a rollback
  std::vector<StampedPose> solved;      ///< where the drive was solved as a whole: the path until now as known since
  std::vector<Pose2> cloud;  ///< T_world_robot of particles of a search, thinned out for pictures; empty without
  std::vector<Pose2> drawn;  ///< same, where an attempt starts: as drawn on helices, before the scan weighed them
  std::optional<CloudReport> particles;  ///< where the estimator is a cloud of particles
};

/// One landmark of the map as known now.
struct MapLandmark {
  LandmarkId id = no_landmark;
  PointGaussian point;
  int observations = 0;
  LandmarkState state = LandmarkState::tentative;
  LandmarkAppearance appearance = {};
};

}  // namespace helixnav::core

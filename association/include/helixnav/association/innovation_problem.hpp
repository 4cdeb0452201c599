// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::association {

/// How close an observation must be to a landmark, as probabilities that a correct pair is at most that far apart. The
/// thresholds on νᵀS⁻¹ν are the χ² quantiles for the rows of the observation: 13.8 and 23.0 for two. A size known on
/// both sides adds one row. If a correct pair has its class with probability p only, the threshold is lower by −2 ln p,
/// so that correct pairs of that class fall outside it as rarely as others (exact for two rows).
struct Gates {
  double match_probability = 0.999;  ///< closer: the pair may be matched
  double new_probability = 0.99999;  ///< farther from every landmark: the observation may begin a new one
};

/// What the filter expects a landmark to look like in one kind of observation. Observations with one row are padded to
/// two (zero rows in H, one on the diagonal of S), so that every block of a joint problem is 2×2 and NIS and
/// determinant are unchanged.
struct Prediction {
  int candidate = 0;
  core::ObservationKind kind = core::ObservationKind::range_bearing;
  Eigen::Vector2d z_hat;
  Eigen::Matrix<double, 2, 3> H_pose;
  Eigen::Matrix2d H_landmark;
  Eigen::Matrix<double, 2, 3> C_pose;   ///< cov(h, pose) = H_pose P_vv + H_landmark P_mv
  Eigen::Matrix<double, 3, 2> P_vm_Hm;  ///< P_vm H_landmarkᵀ
  Eigen::Matrix2d P_mm_Hm;              ///< P_mm H_landmarkᵀ
  Eigen::Matrix2d HPHt;                 ///< innovation covariance without the observation noise
};

/// One observation and one landmark that may be its origin. Rows of nu and S beyond `dof` are padding (0 and 1).
struct GatedPair {
  int observation = 0;
  int candidate = 0;   ///< index into InnovationProblem::ids
  int prediction = 0;  ///< index into InnovationProblem::predictions
  int dof = 0;
  Eigen::Vector2d nu;
  Eigen::Matrix2d S;
  double nis = 0.0;             ///< νᵀS⁻¹ν
  double log_likelihood = 0.0;  ///< ln N(ν; 0, S), in the units of the observation
  /// ln of the likelihood ratio of class and size, against any other object; 0 where they carry no information.
  double appearance_nats = 0.0;
};

/// One observation of the scan and where its pairs are in InnovationProblem::pairs: [begin, end).
struct GatedObservation {
  core::ObservationKind kind = core::ObservationKind::range_bearing;
  int dof = 0;
  int begin = 0;
  int end = 0;
  double nearest_nis = std::numeric_limits<double>::infinity();  ///< to any landmark; +inf beyond the gate for new ones
  int nearest_candidate = -1;
};

/// Everything that data association knows about one scan. A value type without a filter: pairs inside the gate with
/// innovation and covariance, and what is needed for covariances between pairs on demand (joint_innovation.hpp).
struct InnovationProblem {
  std::vector<core::LandmarkId> ids;           ///< candidates, in the order of the JointGaussian
  std::vector<GatedObservation> observations;  ///< in the order of the scan
  std::vector<GatedPair> pairs;                ///< by observation, then by NIS, then by candidate
  std::vector<Prediction> predictions;
  /// Joint covariance of pose and candidates, owned by the caller, must outlive the problem; null when the landmarks
  /// are independent of each other and of the pose.
  const Eigen::MatrixXd* covariance = nullptr;
};

/// Innovations of every observation × candidate pair. Each candidate is predicted once for each kind of observation in
/// the scan. A landmark at the position of the sensor itself has no bearing and is left out.
/// Cost O(candidates + observations × candidates), about 30 ns per pair. `joint.covariance` is kept by reference.
/// Throws PreconditionError for an observation that is not finite or whose R is not positive definite, for gates
/// outside (0, 1) or in the wrong order, and for a covariance of the wrong shape; NumericalError, naming observation
/// and landmark, when an innovation covariance is not positive definite. `appearance`: what the landmarks look like;
/// null if nothing is known.
/// Test: association/innovation_problem_test.cpp (dense H P Hᵀ + R; bearings across ±π; mixed kinds).
InnovationProblem make_innovation_problem(const core::JointGaussian& joint, const core::Scan& scan,
                                          const Gates& gates = {}, const core::MapAppearance* appearance = nullptr);
InnovationProblem make_innovation_problem(core::JointGaussian&& joint, const core::Scan& scan, const Gates& gates = {},
                                          const core::MapAppearance* appearance = nullptr) = delete;

/// The same for a known pose and landmarks that are independent given that pose: the map of one FastSLAM particle.
InnovationProblem make_innovation_problem(const core::Pose2& T_world_robot, const std::vector<core::LandmarkId>& ids,
                                          const std::vector<core::PointGaussian>& landmarks, const core::Scan& scan,
                                          const Gates& gates = {});

}  // namespace helixnav::association

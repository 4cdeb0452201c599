// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/pf_relocalize/bases.hpp"

namespace helixnav::pf_relocalize {

/// How the errors that landmarks share are treated before a filter that assumes independent landmarks sees them. Share
/// of 60 searches at the right pose / at a wrong one / still open after 20 scans, on a dense and on a sparse road
/// (bench/decorrelation_study.cpp): marginals 98/2/0 and 98/2/0 %, constellations 97/2/2 and 97/2/2, whitened 90/0/10
/// and 78/0/22, trace 87/2/12 and 77/0/23, scalar 83/3/13 and 77/0/23, latent modes 88/3/8 and 75/0/25.
enum class Decorrelation {
  relative_marginals,  ///< dropped after the change of frame (no bound; no false closing in the prototype's worlds)
  scalar_bound,        ///< eq (11) of the paper
  trace_bound,         ///< block bound of least trace
  whitened_bound,      ///< block bound of least Σ log det
  constellations,      ///< whitened bound inside groups of at most 8
  latent_modes,        ///< strongest modes kept exactly, one ξ a particle; whitened bound on the rest
};

/// The word used in files and options; the inverse throws an InputError that lists the words.
std::string_view name_of(Decorrelation decorrelation);
Decorrelation decorrelation_from(std::string_view name);

struct ReferenceMapOptions {
  Decorrelation decorrelation = Decorrelation::relative_marginals;
  int latent_modes = 6;  ///< columns kept exactly; THEORY §2: trace × 1.5 at 24 landmarks
  int constellation_size = 8;
  int sweeps = 5;
};

/// What the particle filter knows about the old map: landmarks with independent errors in the frame of two of them, and
/// the vehicle's prior in that frame, transformed jointly (it is correlated with the bases).
struct ReferenceMap {
  core::Pose2 T_world_base;
  Bases bases;
  std::vector<core::LandmarkId> ids;
  std::vector<core::PointGaussian> landmarks;  ///< in the base frame
  core::PoseGaussian prior;                    ///< T_base_robot
  Eigen::MatrixXd latent;                      ///< V, 2n×q [m]; q = 0 unless latent_modes
  Eigen::MatrixXd prior_by_latent;             ///< Cov(pose, ξ), 3×q

  int latent_modes() const { return static_cast<int>(latent.cols()); }
};

/// A reference map, or why there is none.
struct ReferenceMapResult {
  std::optional<ReferenceMap> map;
  std::string reason;             ///< empty where there is a map; else a clause with its numbers
  double least_eigenvalue = 0.0;  ///< of the covariance in the base frame, below zero only where some were raised to 0
};

/// Builds the map from a joint estimate (pose and n ≥ 3 landmarks). The covariance is judged in the base frame, where the
/// drift that all share is gone: eigenvalues down to minus the rounding of the input (1e-9 of its largest element, as
/// in core::is_symmetric_positive_semidefinite, times the square of the change of frame) are raised to zero; what is
/// not finite, not symmetric or further below zero gives a reason and no map. Relative marginals are judged one by one,
/// and all together only where one is not a covariance. Throws nothing of its own. Cost: relative marginals O(n) after
/// the choice of bases, bound O(n²), latent modes, and raising eigenvalues, O(n³).
/// Test: pf_relocalize/reference_map_test.cpp.
ReferenceMapResult try_reference_map(const core::JointGaussian& joint, const ReferenceMapOptions& options = {});

/// The same for callers whose input is a covariance by construction: PreconditionError with the reason where
/// try_reference_map returns no map. Bases are chosen by choose_bases, or given. Cost: bound O(n²), latent modes O(n³).
/// Source: hybrid_masson2003 §3.1 eq (10)-(11), THEORY §2. Test: pf_relocalize/reference_map_test.cpp.
ReferenceMap build_reference_map(const core::JointGaussian& joint, const ReferenceMapOptions& options = {});
ReferenceMap build_reference_map(const core::JointGaussian& joint, const Bases& bases,
                                 const ReferenceMapOptions& options = {});

}  // namespace helixnav::pf_relocalize

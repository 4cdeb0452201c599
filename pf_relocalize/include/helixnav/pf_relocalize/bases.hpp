// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"

namespace helixnav::pf_relocalize {

/// Two landmarks that define a frame: origin at A, x axis through B. Indices into JointGaussian::points_m.
struct Bases {
  int a = 0;
  int b = 1;
};

/// The pair whose frame leaves the least mean variance of all landmarks, tr Cov(y_i)/n. The three rules of thumb (far
/// apart, well observed, correlated with the rest) are what makes this number small: closeness of A and B comes back as
/// lever × heading error, their own noise is added to every landmark, and only what they share with it cancels.
/// The 16 origins that are best without rotation are tried with every second base: O(n²) + O(16 n²), n = 100 in a few
/// milliseconds. PreconditionError with fewer than two landmarks.
/// Test: pf_relocalize/reference_map_test.cpp (against all pairs; against nearest-and-most-observed as in the prototype).
Bases choose_bases(const core::JointGaussian& joint);

/// tr Cov(y_i) averaged over all landmarks, in the frame of `bases` [m²].
double mean_relative_variance_m2(const core::JointGaussian& joint, const Bases& bases);

/// T_world_base at the estimate.
core::Pose2 base_frame(const core::JointGaussian& joint, const Bases& bases);

/// The same joint estimate in the frame of the bases: pose and points transformed, covariance J P Jᵀ with the analytic J
/// (errors of the bases move everything). The blocks of A, and B across the axis, become zero. Cost O(n²).
/// Test: pf_relocalize/reference_map_test.cpp (J against central differences).
core::JointGaussian in_base_frame(const core::JointGaussian& joint, const Bases& bases);

/// Pose and landmarks in the frame of the bases, each on its own.
struct MarginalsInBaseFrame {
  core::PoseGaussian pose;
  std::vector<core::PointGaussian> points;
};

/// The blocks on the diagonal of in_base_frame, O(n). Test: pf_relocalize/reference_map_test.cpp (the same to rounding).
MarginalsInBaseFrame marginals_in_base_frame(const core::JointGaussian& joint, const Bases& bases);

}  // namespace helixnav::pf_relocalize

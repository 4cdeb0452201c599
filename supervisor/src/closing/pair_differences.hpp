// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "closing/branch_pairs.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {

/// Differences of pairs, removed − kept, of which the removed ones are first moved by T; Gaussian.
struct PairDifferences {
  Eigen::VectorXd nu_m;  ///< x and y of each pair
  Eigen::MatrixXd S_m2;  ///< their covariance; sigma_m is added to every coordinate
};

/// O(landmarks · pairs) after the joint covariance of the landmarks; T without covariance.
/// Tests: supervisor/closing/contradicting_pairs_test.cpp, shape_evidence_test.cpp.
PairDifferences pair_differences(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, const core::Pose2& T,
                                 double sigma_m);

}  // namespace helixnav::supervisor

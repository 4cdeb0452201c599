// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/constants.hpp"

namespace helixnav::apps {

// Test: apps/calibrate/constants_fit_test.cpp

/// Constants are counted with std::size_t in vectors, with Eigen::Index in matrices.
inline Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// Which constants a log says more of than is known beforehand (`usual`: its standard deviations): with the worst left out
/// one by one, those whose standard deviation is less than half of it.
std::vector<bool> observable(const Eigen::MatrixXd& information, const Eigen::VectorXd& usual);

/// The change of least χ²: constants that are not free go to `pinned`, the free ones where they are best then.
Eigen::VectorXd best_change(const smoothing::ConstantsEvidence& evidence, const std::vector<bool>& free,
                            const Eigen::VectorXd& pinned);

/// Standard deviations; what is not free is as uncertain as known beforehand, and makes the others so.
Eigen::VectorXd sigmas_of(const Eigen::MatrixXd& information, const std::vector<bool>& free,
                          const Eigen::VectorXd& usual);

/// What χ² changes by.
double chi2_change(const smoothing::ConstantsEvidence& evidence, const Eigen::VectorXd& change);

/// A part of a log, and the rest that constants are fitted to when it judges them.
struct Fold {
  smoothing::ConstantsEvidence rest, held_out;
};

/// χ² of all held-out parts, against unchanged constants, where each is judged with what is fitted to its rest.
double held_out_chi2(const std::vector<Fold>& folds, const std::vector<bool>& free, const Eigen::VectorXd& pinned);

/// Of the free constants those that, fitted to the rest, explain the held-out parts better than as told (`pinned`): as long as
/// one does not, the worst is left out and the others fitted again.
std::vector<bool> confirmed(const std::vector<Fold>& folds, std::vector<bool> free, const Eigen::VectorXd& pinned);

}  // namespace helixnav::apps

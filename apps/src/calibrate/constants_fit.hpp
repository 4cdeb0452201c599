// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/constants.hpp"

namespace helixnav::apps {

// Test: apps/calibrate/constants_fit_test.cpp

/// Constants are indexed with std::size_t in vectors, with Eigen::Index in matrices.
inline Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// The constants about which a log says more than is known beforehand (`usual`: its standard deviations): after removing
/// the worst one by one, those whose standard deviation is less than half of it.
std::vector<bool> observable(const Eigen::MatrixXd& information, const Eigen::VectorXd& usual);

/// The change of least χ²: constants that are not free are set to `pinned`, the free ones to their optimum given these.
Eigen::VectorXd best_change(const smoothing::ConstantsEvidence& evidence, const std::vector<bool>& free,
                            const Eigen::VectorXd& pinned);

/// Standard deviations; those not free are as uncertain as known beforehand, and make the others so.
Eigen::VectorXd sigmas_of(const Eigen::MatrixXd& information, const std::vector<bool>& free,
                          const Eigen::VectorXd& usual);

/// The change in χ².
double chi2_change(const smoothing::ConstantsEvidence& evidence, const Eigen::VectorXd& change);

/// A part of a log, and the rest, to which the constants that it judges are fitted.
struct Fold {
  smoothing::ConstantsEvidence rest, held_out;
};

/// χ² of all held-out parts, relative to unchanged constants, each judged with the constants fitted to its rest.
double held_out_chi2(const std::vector<Fold>& folds, const std::vector<bool>& free, const Eigen::VectorXd& pinned);

/// The free constants that, fitted to the rest, explain the held-out parts better than the file values (`pinned`) do: as long
/// as one does not, the worst is removed and the others are fitted again.
std::vector<bool> confirmed(const std::vector<Fold>& folds, std::vector<bool> free, const Eigen::VectorXd& pinned);

}  // namespace helixnav::apps

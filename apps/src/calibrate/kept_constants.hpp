// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "constants_fit.hpp"

namespace helixnav::apps {

// Test: apps/calibrate/kept_constants_test.cpp

/// The outcome for an estimated constant.
enum class Verdict {
  not_observable,     ///< the log says too little about it
  unsettled,          ///< swings between the rounds by more than its interval
  indistinguishable,  ///< its 95 % interval contains the file value
  not_confirmed,      ///< does not explain the held-out parts better than the file value
  kept
};

/// Standard deviations of the kept ones: those not observable are as uncertain as usual, the others are at their file
/// values.
Eigen::VectorXd kept_sigmas(const Eigen::MatrixXd& information, const std::vector<Verdict>& verdicts,
                            const Eigen::VectorXd& usual);

/// Of the kept constants the one nearest to its file value (`pinned`: the change back to it), in standard deviations, if its
/// 95 % interval contains that value: all others fitted again with those not kept at their file values.
std::optional<std::size_t> least_significant(const smoothing::ConstantsEvidence& all,
                                             const std::vector<Verdict>& verdicts, const Eigen::VectorXd& usual,
                                             const Eigen::VectorXd& pinned);

/// Whether the log, read with a constant and solved, gains at least half of the χ² that its derivative promises: the square of its
/// distance from the file value, in standard deviations.
bool gains_as_promised(double gained_chi2, double sigmas);

std::vector<bool> kept_of(const std::vector<Verdict>& verdicts);
bool is_any_kept(const std::vector<Verdict>& verdicts);

/// Keeps only those that differ from the file values and that the held-out parts confirm, one by one: whenever one goes back to
/// its file value, the others are fitted again.
std::vector<Verdict> judge_kept(const smoothing::ConstantsEvidence& all, const std::vector<Fold>& folds,
                                std::vector<Verdict> verdicts, const Eigen::VectorXd& usual,
                                const Eigen::VectorXd& pinned);

}  // namespace helixnav::apps

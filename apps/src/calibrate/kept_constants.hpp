// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "constants_fit.hpp"

namespace helixnav::apps {

// Test: apps/calibrate/kept_constants_test.cpp

/// What becomes of a constant that was estimated.
enum class Verdict {
  not_observable,     ///< the log says too little of it
  unsettled,          ///< goes to and fro between the rounds by more than its interval
  indistinguishable,  ///< its interval of 95 % holds what was told
  not_confirmed,      ///< does not explain what was held out better than what was told
  kept
};

/// Standard deviations of the kept ones: what is not observable is as uncertain as usual, the others as told.
Eigen::VectorXd kept_sigmas(const Eigen::MatrixXd& information, const std::vector<Verdict>& verdicts,
                            const Eigen::VectorXd& usual);

/// Of the kept constants the one nearest to what is told (`pinned`: the change back to it), in standard deviations, when its
/// interval of 95 % holds that: all others fitted again with those that are not kept as told.
std::optional<std::size_t> least_significant(const smoothing::ConstantsEvidence& all,
                                             const std::vector<Verdict>& verdicts, const Eigen::VectorXd& usual,
                                             const Eigen::VectorXd& pinned);

std::vector<bool> kept_of(const std::vector<Verdict>& verdicts);
bool is_any_kept(const std::vector<Verdict>& verdicts);

/// Leaves those kept that differ from what is told and that the held-out parts confirm, one by one: each that goes back to what
/// is told has the others fitted again.
std::vector<Verdict> judge_kept(const smoothing::ConstantsEvidence& all, const std::vector<Fold>& folds,
                                std::vector<Verdict> verdicts, const Eigen::VectorXd& usual,
                                const Eigen::VectorXd& pinned);

}  // namespace helixnav::apps

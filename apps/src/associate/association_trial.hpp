// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/evaluation/association_score.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// One association method on one or more labelled recordings.
struct AssociationTrial {
  evaluation::AssociationScore score;
  std::size_t runs = 0;
  std::size_t runs_without_wrong = 0;  ///< not one observation matched to a landmark of another label
  std::size_t runs_with_truth = 0;     ///< of poses
  std::size_t runs_consistent = 0;     ///< NEES of the last pose within the 99.9 % quantile of χ²₃
  std::vector<double> step_us;         ///< wall clock of each scan's whole step
};

/// Navigates along the recording, association unknown, and adds what became of it. Returns early when interrupted.
void try_association(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                     AssociationTrial& trial);

/// One line per method, with 95 % intervals (Wilson) of the run successes.
std::string association_table(const std::vector<std::string>& methods, const std::vector<AssociationTrial>& trials);

/// The matching matrix x_nm of a scan, as ihgr_zhang2005 Tables I and II: a row for each observation and one for the
/// dummy, a column for each landmark that existed before the scan and one for the dummy, called 0.
std::string matching_matrix(const core::StepReport& report, const std::vector<core::LandmarkId>& landmarks_before);

}  // namespace helixnav::apps

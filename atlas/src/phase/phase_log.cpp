// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/atlas/phase_log.hpp"

#include <algorithm>
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::atlas {
namespace {

void check_seen(const std::vector<SeenLandmark>& seen, std::size_t step) {
  for (const SeenLandmark& one : seen) {
    if (one.id < 0)
      throw core::PreconditionError("phase log: step " + std::to_string(step) + " sees a nameless landmark");
    core::check_observation(one.observation);
  }
}

}  // namespace

std::vector<core::LandmarkId> landmarks_of(const PhaseLog& log) {
  std::vector<core::LandmarkId> ids;
  for (const SeenLandmark& one : log.seen_at_entry) ids.push_back(one.id);
  for (const LoggedStep& step : log.steps) {
    for (const SeenLandmark& one : step.seen) ids.push_back(one.id);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

void check_log(const PhaseLog& log) {
  if (log.steps.empty()) throw core::PreconditionError("phase log: no step");
  check_seen(log.seen_at_entry, 0);
  for (std::size_t k = 0; k < log.steps.size(); ++k) {
    const LoggedStep& step = log.steps[k];
    if (!step.T_before_after.vector().allFinite() || !core::is_symmetric_positive_definite(step.covariance)) {
      throw core::PreconditionError("phase log: step " + std::to_string(k + 1) +
                                    ": motion not finite, or its covariance not symmetric positive definite");
    }
    check_seen(step.seen, k + 1);
  }
}

}  // namespace helixnav::atlas

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "helixnav/core/numerical_health.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// Of all steps of a run.
core::NumericalHealth numerics_of(const runs::Run& run);

/// How often budgets skipped or deferred work.
struct PostponedWork {
  std::int64_t scans_thinned = 0;
  std::int64_t scans_left_out = 0;  ///< their names
  std::int64_t associations = 0;
  std::int64_t windows = 0;
  std::int64_t drives = 0;

  bool any() const { return scans_thinned + scans_left_out + associations + windows + drives > 0; }
};
PostponedWork postponed_in(const runs::Run& run);

/// A sentence without a full stop; empty if nothing was repaired, refused or near its limit.
std::string numerics_text(const core::NumericalHealth& numerics);
/// A sentence without a full stop; empty if nothing was skipped or deferred.
std::string postponed_text(const PostponedWork& postponed);

}  // namespace helixnav::reports

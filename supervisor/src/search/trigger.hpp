// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "association/gated_scan.hpp"
#include "helixnav/core/decision.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Decides whether a search begins: the decision if a revisited landmark has more than
/// SearchOptions::expected_confusers and the old landmarks of the scan together do not fix the pose, else nothing.
/// Tests: supervisor/association/revisit_ambiguity_test.cpp, supervisor/association/place_evidence_test.cpp.
std::optional<core::TriggerDecision> find_trigger(const GatedScan& scan, const core::PoseGaussian& pose,
                                                  const SearchOptions& options);

}  // namespace helixnav::supervisor

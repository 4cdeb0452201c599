// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "association/confirmation.hpp"
#include "association/gating.hpp"
#include "association/revisit_ambiguity.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

/// What the map expects a scan to look like, and which old landmarks it may have returned to.
struct GatedScan {
  std::unique_ptr<Gating> gating;
  std::vector<RevisitAmbiguity> returns;
};

/// The scan that is too ambiguous to be associated, as a decision; nothing when it is not.
std::optional<core::TriggerDecision> find_trigger(const GatedScan& scan, const core::PoseGaussian& pose,
                                                  const SearchOptions& options);

/// The fate of every observation. Two old landmarks that fit together confirm each other; one alone, with room for others
/// in its gate, is deferred, and so is one that would tell the vehicle much about where it is, until it is met again.
/// Test: supervisor/revisit_ambiguity_test.cpp.
std::vector<core::AssociationReport> associate_scan(const core::Scan& scan, const GatedScan& gated,
                                                    const NavigatorOptions& options, double path_m,
                                                    Confirmation& confirmation);

}  // namespace helixnav::supervisor

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// [matched landmark, in the order of landmarks_with(matched)] what the class and size given add to the evidence of a hit,
/// before they are taken in. Empty if none are given.
std::vector<double> appearance_nats(const core::MapAppearance& appearance, const core::Scan& scan,
                                    const std::vector<core::AssociationReport>& associations);

/// Takes in the class and size of every observation: for the landmark it is matched to or begins, otherwise for the
/// population.
void look_at(const core::Scan& scan, const std::vector<core::AssociationReport>& associations,
             association::LandmarkLife& existence);

}  // namespace helixnav::supervisor

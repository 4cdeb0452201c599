// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// Landmarks in view of a scan, whether it saw them or not.
struct InView {
  std::vector<core::LandmarkId>
      surely;  ///< at least a margin inside the range within which landmarks are reliably seen
  std::vector<core::LandmarkId> perhaps;  ///< the others within the sensor's reach: seen less often, but seen
};

/// Those of `ids` that are in view, without those next to an unused observation, which may have been theirs. O(|ids|).
/// Test: supervisor/slip/should_be_seen_test.cpp.
InView should_be_seen(const cekf::CompressedEkf& filter, const core::Scan& scan, double margin_m,
                      const std::vector<core::LandmarkId>& ids, const std::vector<core::AssociationReport>& fate);

/// Probability that one of these landmarks is matched by chance if the scan is of another place: that one of as many
/// observations, anywhere in view, falls into its gate (mean over the landmarks). 0 without an observation or a landmark.
/// O(|ids| · observations), and the joint estimate of the landmarks. Test: supervisor/slip/should_be_seen_test.cpp.
double chance_of_match(const cekf::CompressedEkf& filter, const core::Scan& scan,
                       const std::vector<core::LandmarkId>& ids, double gate_probability);

}  // namespace helixnav::supervisor

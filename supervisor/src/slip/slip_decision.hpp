// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/supervisor/find_slip.hpp"
#include "slip/slip_places.hpp"

namespace helixnav::supervisor {

/// What a slip is weighed against: the landmarks that may be evidence for it, whether they were seen more than once, and the
/// pairs among them that were associated without a slip.
struct SlipQuestion {
  const RelativeGeometry& geometry;
  const std::vector<SeenPoint>& seen;
  std::vector<double>
      new_per_m2;  ///< [seen] density of landmarks not mapped yet where it stands as measured: density_of_new
  std::vector<PointPair> associated;
  double nats_a_pair = 0.0;
  double extraneous_per_m2 = 0.0;  ///< density of what is in no map, as in pair_nats
  bool tentative = false;
  SlipReach reach = SlipReach::next_neighbour;
};

/// The slip that explains a scan, if it does so better than no slip with new landmarks where the pattern of the map has
/// them or where nobody has looked yet, and better than a slip to anywhere else.
/// Test: supervisor/slip/slip_decision_test.cpp.
std::optional<Slip> decide_slip(const SlipQuestion& question, const SlipOptions& options);

}  // namespace helixnav::supervisor

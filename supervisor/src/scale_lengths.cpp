// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/scale_lengths.hpp"

namespace helixnav::supervisor {

SearchOptions scale_lengths(SearchOptions search, double scale) {
  for (double* length_m :
       {&search.look_distance_m, &search.reach_m, &search.rest_m, &search.branch_seen_within_m, &search.ask_again_m,
        &search.confirm_m, &search.probation_m, &search.relocalizer.mode_radius.position_m, &search.relocalizer.bin_m,
        &search.gate.sigma_position_m, &search.rivals.apart_m, &search.rivals.distinct_m, &search.rivals.branch_sigma_m,
        &search.constellation.branch_sigma_m, &search.constellation.most_tolerance_m}) {
    *length_m *= scale;
  }
  search.rivals.extraneous_per_m2 /= scale * scale;
  return search;
}

}  // namespace helixnav::supervisor

// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/smooth_drive.hpp"

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

/// χ² of three more degrees of freedom, exceeded once in a million times: by less the two costs differ that would be one
/// if everything were linear. Measured: −12 to 17 (docs/adr/0010-solving-the-drive.md).
double slack() { return core::chi2_quantile(0.999999, 3); }

}  // namespace

Smoothing smooth_drive(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map) {
  Smoothing smoothing;
  map.take(tape, filter);
  const int before = map.atlas().nodes_redone();
  map.settle();
  smoothing.limit = map.cost() + slack();
  smoothing.chi2 = map.atlas().chi2();
  smoothing.poses = map.atlas().phase_count() + 1;
  smoothing.iterations = map.atlas().nodes_redone() - before;
  smoothing.accepted = smoothing.chi2 <= smoothing.limit;
  if (smoothing.accepted) smoothing.path = map.path();
  return smoothing;
}

cekf::CompressedEkf filter_at_solution(const DriveMap& map, const cekf::CompressedEkf& filter) {
  return {map.atlas().joint(filter.landmarks()), filter.next_name(), filter.options()};
}

}  // namespace helixnav::supervisor

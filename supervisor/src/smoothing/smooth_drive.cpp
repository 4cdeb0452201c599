// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/smooth_drive.hpp"

#include <algorithm>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

/// χ² of three more degrees of freedom, exceeded once in a million times: two costs that would be equal if everything
/// were linear differ by less. Measured: −12 to 17 (docs/adr/0010-solving-the-drive.md).
double slack() { return core::chi2_quantile(0.999999, 3); }

/// What the drive may cost, given what it costs without the closing just made. Noise assumed at half its size, and
/// persistent errors, make right closings cost several times what they should; another minimum costs more than that.
double limit_by_closing(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap without) {
  without.take(tape.without_last_merges(), filter);
  without.settle();
  constexpr double of_half_noise = 4.0;
  return without.atlas().chi2() + of_half_noise * tape.cost_of_last_merges() + slack();
}

}  // namespace

Smoothing smooth_drive(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map) {
  Smoothing smoothing;
  const DriveMap before_closing = map;
  map.take(tape, filter);
  const int redone = map.atlas().nodes_redone();
  map.settle();
  smoothing.limit = map.cost() + slack();
  smoothing.chi2 = map.atlas().chi2();
  smoothing.poses = map.atlas().phase_count() + 1;
  smoothing.iterations = map.atlas().nodes_redone() - redone;
  if (smoothing.chi2 > smoothing.limit && tape.cost_of_last_merges() > 0.0) {
    smoothing.limit = std::max(smoothing.limit, limit_by_closing(filter, tape, before_closing));
  }
  smoothing.accepted = smoothing.chi2 <= smoothing.limit;
  if (smoothing.accepted) smoothing.path = map.path();
  return smoothing;
}

cekf::CompressedEkf filter_at_solution(const DriveMap& map, const cekf::CompressedEkf& filter) {
  return {map.atlas().joint(filter.landmarks()), filter.next_name(), filter.options()};
}

}  // namespace helixnav::supervisor
